# SPDX-License-Identifier: BSD-3-Clause
"""The verdict on fits whose errors are given, and the drawings of dampers whose parameters are given."""

from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
import pytest

from railsym.dampers import DamperModel, Record, RecordError, clean
from railsym.dampers.verdict import verdict
from railsym.plots.dampers import damper_force, nearest_test, plot_force_speed, plot_stiffness_speed, series_stiffness

TESTS = ((1.0, 0.5e-3), (1.0, 1e-3), (3.0, 1.5e-3))


def records():
    found = []
    for frequency, amplitude in TESTS:
        time = np.arange(0.0, 5.0 / frequency, 1e-3)
        wave = 2 * np.pi * frequency * time
        found.append(clean(Record(time, amplitude * np.sin(wave), 3e6 * amplitude * np.sin(wave + 0.8), name=f"{frequency:g}Hz")))
    return found


def fit(errors, seconds=0.01):
    return SimpleNamespace(tests=[SimpleNamespace(loop_error=error, energy_error=0.1 * error, peak_error=-error, computing_time=seconds)
                                  for error in errors])


def test_the_simplest_model_that_none_beats_is_enough():
    found = verdict({"viscous": fit((0.02, 0.5, 0.6)), "maxwell": fit((0.019, 0.02, 0.12)), "maxwell_nonlinear": fit((0.019, 0.019, 0.02), 0.03)},
                    records())
    assert found.enough == ("viscous", "maxwell", "maxwell_nonlinear")
    text = str(found)
    assert "The viscous damper is enough for 1 Hz 0.5 mm." in text
    assert "stiffness over speed is enough for 3 Hz 1.5 mm." in text
    assert "from 1.9 to 1.9 % in the third of the tests with the smallest speed, and from 12.0 to 2.0 %" in text
    assert "3.0 times the computing time" in text
    assert found.loop_error.shape == (3, 3) and found.peak_error[0, 1] == -0.5


def test_a_damper_that_no_model_fits_is_named():
    found = verdict({"maxwell": fit((0.02, 0.3, 0.02)), "viscous": fit((0.5, 0.5, 0.6))}, records())
    assert found.models == ("viscous", "maxwell")
    assert "No model fits test '1Hz': the loop error stays above 10 %" in str(found)
    assert "The viscous damper is not enough for any test." in str(found)


def test_noise_is_not_held_against_a_model():
    one = records()[1]
    noisy = SimpleNamespace(**{key: getattr(one, key) for key in ("force", "name", "frequency", "amplitude", "label")}, noise=0.2 * np.std(one.force))
    # 0.2 of noise and 0.06 of its own: 0.2088
    found = verdict({"maxwell": fit((0.2088,)), "maxwell_nonlinear": fit((0.2,))}, [noisy])
    assert found.enough == ("maxwell_nonlinear",)
    found = verdict({"maxwell": fit((0.2058,)), "maxwell_nonlinear": fit((0.2,))}, [noisy])
    assert found.enough == ("maxwell",) and "No model" not in str(found)
    assert verdict({"maxwell": fit((0.2058,)), "maxwell_nonlinear": fit((0.2,))}, [noisy], tolerance=0.01).enough == ("maxwell_nonlinear",)


def test_fits_that_cannot_be_compared():
    with pytest.raises(RecordError, match="'kelvin'"):
        verdict({"kelvin": fit((1, 1, 1))}, records())
    with pytest.raises(RecordError, match="has 2 tests, but 3"):
        verdict({"maxwell": fit((1, 1))}, records())


def test_drawn_curves_are_those_of_the_vehicle():
    from railsym.dampers.models import curve_value

    model = DamperModel("maxwell", damping_curve=((0, 0.01, 0.03), (0, 7e3, 1e4)), series_stiffness_curve=((0, 0.01, 0.03), (6e6, 5e6, 4.5e6)))
    speed = np.linspace(-0.05, 0.05, 41)
    record = model.force_law_record()
    # both are SciPy's monotone cubic; only rounding differs
    assert damper_force(model, speed) == pytest.approx(curve_value(record["damping_curve"], speed), rel=1e-12, abs=1e-8)
    assert series_stiffness(model, speed) == pytest.approx(curve_value(record["stiffness_curve"], np.abs(speed)), rel=1e-12)


def test_drawings_show_each_model():
    given = {"viscous": SimpleNamespace(model=DamperModel("viscous", damping=4e5)),
             "maxwell": SimpleNamespace(model=DamperModel("maxwell", damping=5e5, series_stiffness=5e6))}
    axes = plot_force_speed(given, records())
    lines = {line.get_label(): line for line in axes.get_lines()}
    speed, force = lines["viscous"].get_data()
    shown = np.isfinite(force)                                           # up to the peak force of the tests
    assert shown.any() and force[shown] == pytest.approx(1e-3 * 4e5 * 1e-3 * speed[shown])   # kN over mm/s
    stiffness = plot_stiffness_speed(given, records()).get_lines()
    assert len(stiffness) == 1 and stiffness[0].get_ydata() == pytest.approx(np.full(301, 5.0))
    assert nearest_test(records(), 2.5, 1.4e-3).frequency == pytest.approx(3.0)
    plt.close("all")
