# SPDX-License-Identifier: BSD-3-Clause
"""Scalar force laws: from an element's parameters to the force that C computes.

Every law is evaluated in C through an axis element between two bodies that only move along y,
so elongation and rate are one coordinate, and compared with its formula or with SciPy.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from railsym import _core
from railsym.errors import ModelError
from railsym.force_laws import cubic_table, curve_slope, half_table, law_record, slope_at_rest
from railsym.vehicle_parts import Curve

ROUNDOFF = 1e-13
HARD = ([0.0, 0.01, 0.02, 0.03, 0.05], [0.0, 80.0, 300.0, 310.0, 2000.0])  # a half: mirrored
BOTH = ([-0.04, -0.01, 0.0, 0.03], [-500.0, -20.0, 0.0, 90.0])  # both sides, not alike
LINEAR = ([0.0, 1.0], [0.0, 2500.0])


def curve(points, units=("m", "N")):
    return Curve("hard", np.array(points[0]), np.array(points[1]), *units, "test")


def element(kind, **parameters):
    return SimpleNamespace(name="group.one", type=kind, axis=1, parameters=parameters)


def law(record, e=0.0, v=0.0, s=0.0, w=0.0):
    """Force and state residual of a law in C."""
    kernel = _core.kernels()["axis"]
    values = {"ax1": 1.0, "q2_1": e, "u2_y": v, "s": s, "ds": w}
    values |= dict.fromkeys([n for n in kernel.inputs if n.startswith(("c1_", "c2_")) or n in ("C00", "C11", "C22")], 1.0)
    inputs = [values.get(n, 0.0) for n in kernel.inputs]
    r = _core.kernel_real("axis", inputs, (0, 0, 0), record)[0]
    return r[7], r[12]


def force(record, **state):
    return law(record, **state)[0]


def mirrored(points):
    x, y = map(np.array, points)
    return PchipInterpolator(np.concatenate([-x[:0:-1], x]), np.concatenate([-y[:0:-1], y]))


def test_spring_and_traction_rod():
    assert force(law_record(element("spring", stiffness=3e5)), e=-0.02, v=7.0) == pytest.approx(-6e3, rel=ROUNDOFF)
    rod = law_record(element("traction_rod", stiffness=3e5, damping=4e3))
    assert force(rod, e=0.01, v=-0.5) == pytest.approx(3e3 - 2e3, rel=ROUNDOFF)
    assert force(law_record(element("traction_rod", stiffness=3e5)), e=0.01, v=-0.5) == pytest.approx(3e3, rel=ROUNDOFF)


def test_preload_is_added_to_elastic_laws():
    for kind, parameters in (("spring", {"stiffness": 2.0}), ("bump_stop", {"clearance": 1.0, "stiffness": 2.0}),
                             ("maxwell", {"damping": 1.0, "series_stiffness": 2.0})):
        assert force(law_record(element(kind, **parameters)) | {"preload": 5.0}) == pytest.approx(5.0, rel=ROUNDOFF)


def test_damper():
    assert force(law_record(element("damper", damping=6e3)), e=3.0, v=0.2) == pytest.approx(1.2e3, rel=ROUNDOFF)


def test_maxwell_element():
    """f = k (e - s) and 0 = c ds/dt - k (e - s): the damper carries the spring's force."""
    record = law_record(element("maxwell", damping=6e3, series_stiffness=2e6))
    f, g = law(record, e=0.003, v=9.0, s=0.001, w=0.1)
    assert f == pytest.approx(4e3, rel=ROUNDOFF)
    assert g == pytest.approx(6e2 - 4e3, rel=ROUNDOFF)


def test_bump_stop_works_beyond_its_clearance_on_both_sides():
    record = law_record(element("bump_stop", clearance=0.02, stiffness=1e6))
    assert [force(record, e=e) for e in (-0.02, -0.01, 0.0, 0.02)] == [0.0] * 4
    assert force(record, e=0.023) == pytest.approx(3e3, rel=1e-11)  # a difference of two digits alike
    assert force(record, e=-0.023) == pytest.approx(-3e3, rel=1e-11)


def test_actuators():
    """A positive force command pushes the ends apart; a length command is a free length."""
    thrust = law_record(element("actuator", mode="force", damping=100.0)) | {"command": 700.0}
    assert force(thrust, e=0.3, v=2.0) == pytest.approx(200.0 - 700.0, rel=ROUNDOFF)
    length = law_record(element("actuator", mode="length", stiffness=1e6, damping=100.0)) | {"command": 0.01}
    assert force(length, e=0.012, v=2.0) == pytest.approx(2e3 + 200.0, rel=1e-11)


def saturated(x, limit):
    """The smooth limit that laws.h states."""
    rest = max(abs(x) / limit - 0.8, 0.0)
    return np.sign(x) * limit * (min(abs(x) / limit, 0.8) + 0.2 * np.tanh(rest / 0.2))


@pytest.mark.parametrize("stretch", [-0.2, -0.0205, -0.017, -0.005, 0.0, 0.003, 0.016, 0.0195, 0.5])
def test_force_of_an_actuator_stays_within_its_limit(stretch):
    record = law_record(element("actuator", mode="length", stiffness=1e6, damping=100.0, force_limit=2e4)) | {"command": 0.01}
    found = force(record, e=0.01 + stretch)
    assert abs(found) <= 2e4
    assert found == pytest.approx(saturated(1e6 * stretch, 2e4), rel=1e-10, abs=1e-9)  # 0.01 + x - 0.01 loses a digit or two
    if abs(stretch) <= 0.016:
        assert found == pytest.approx(1e6 * stretch, rel=1e-10, abs=1e-9)


@pytest.mark.parametrize(("mode", "size"), [("length", 1e6), ("force", 1.0)])
def test_an_actuator_follows_its_command_with_its_lag_and_no_faster_than_its_rate(mode, size):
    """g = z T (w - R sat((command - s)/(T R))): at the root w is the lag's rate, or the limit."""
    record = law_record(element("actuator", mode=mode, stiffness=1e6, damping=100.0, lag=0.05, rate_limit=0.2)) | {"command": 0.03}
    for s in (0.03, 0.025, 0.022, 0.0, -4.0, 0.038, 0.3):
        rate = saturated((0.03 - s) / 0.05, 0.2)
        assert abs(rate) <= 0.2
        assert law(record, s=s, w=rate)[1] == pytest.approx(0.0, abs=1e-11 * size)
        assert law(record, s=s, w=rate + 1.0)[1] == pytest.approx(0.05 * size, rel=1e-10)
    expected = 1e6 * (0.01 - 0.022) + 200.0 if mode == "length" else 200.0 - 0.022
    assert force(record, e=0.01, v=2.0, s=0.022) == pytest.approx(expected, rel=1e-11)


def test_actuators_that_have_failed():
    numbers = {"stiffness": 1e6, "damping": 100.0, "lag": 0.05, "rate_limit": 0.2, "force_limit": 2e4, "bypass_damping": 3e3}
    record = law_record(element("actuator", mode="length", **numbers)) | {"command": 0.5, "preload": 70.0}
    stuck = record | {"fault": "stuck"}
    assert law(stuck, e=0.01, v=0.1, s=0.004)[0] == pytest.approx(6e3 + 80.0, rel=1e-11)
    assert law(stuck, s=0.004, w=0.0)[1] == 0.0  # it stays, whatever the command
    assert force(record | {"fault": "free"}, e=0.01, v=2.0, s=0.2) == 0.0
    assert force(record | {"fault": "damped"}, e=0.01, v=2.0, s=0.2) == pytest.approx(6e3, rel=ROUNDOFF)
    assert force(record | {"fault": "damped"}, e=0.01, v=50.0, s=0.2) == pytest.approx(2e4, rel=1e-6)
    assert force(record | {"fault": "damped"}, e=0.01, v=50.0, s=0.2) <= 2e4


@pytest.mark.parametrize(("kind", "key", "slot"), [("spring", "curve", "e"), ("damper", "curve", "v"),
                                                   ("damper", "damping_curve", "v")])
@pytest.mark.parametrize(("points", "reference"), [(HARD, mirrored(HARD)), (BOTH, PchipInterpolator(*BOTH))])
def test_curve_is_scipys_monotone_cubic_and_goes_on_straight(kind, key, slot, points, reference):
    record = law_record(element(kind, **{key: curve(points)}))
    low, high = reference.x[0], reference.x[-1]
    for x in np.concatenate([np.linspace(low, high, 41), points[0]]):
        assert force(record, **{slot: x}) == pytest.approx(reference(x), rel=ROUNDOFF, abs=1e-10)
    for end, x in ((low, low - 0.02), (high, high + 0.02)):
        expected = reference(end) + (x - end) * reference(end, 1)
        assert force(record, **{slot: x}) == pytest.approx(expected, rel=1e-12)


def test_half_curve_is_odd_and_passes_its_points():
    record = law_record(element("spring", curve=curve(HARD)))
    for x, y in zip(*HARD, strict=True):
        assert force(record, e=x) == pytest.approx(y, abs=1e-10)
        assert force(record, e=-x) == pytest.approx(-y, abs=1e-10)


def test_curve_never_falls():
    """Fritsch and Butland keep a rising table rising; a plain cubic spline would not, here."""
    record = law_record(element("spring", curve=curve(HARD)))
    values = [force(record, e=x) for x in np.linspace(-0.06, 0.06, 400)]
    assert np.diff(values).min() >= 0.0


def test_bump_stop_curve_holds_the_clearance_itself():
    free = ([0.0, 0.02, 0.03, 0.04], [0.0, 0.0, 600.0, 2000.0])
    record, reference = law_record(element("bump_stop", curve=curve(free))), PchipInterpolator(*free)
    assert force(record, e=0.015) == force(record, e=-0.015) == 0.0
    for e in (0.025, 0.035):
        assert force(record, e=e) == pytest.approx(reference(e), rel=1e-12)
        assert force(record, e=-e) == pytest.approx(-reference(e), rel=1e-12)


def test_maxwell_curves():
    """Damping over ds/dt is odd; the series stiffness depends on the magnitude of the rate."""
    damping, stiffness = ([0.0, 0.1, 0.3], [0.0, 3e3, 5e3]), ([0.0, 0.1, 0.3], [4e6, 5e6, 7e6])
    record = law_record(element("maxwell", damping_curve=curve(damping, ("m/s", "N")),
                                series_stiffness_curve=curve(stiffness, ("m/s", "N/m"))))
    k = PchipInterpolator(*stiffness)
    for v in (-0.2, -0.05, 0.0, 0.25):
        for w in (-0.2, 0.15):
            f, g = law(record, e=0.003, v=v, s=0.001, w=w)
            assert f == pytest.approx(0.002 * k(abs(v)), rel=1e-12)
            assert g == pytest.approx(mirrored(damping)(w) - f, rel=1e-12)


def test_a_straight_curve_is_the_linear_law():
    by_curve = law_record(element("spring", curve=curve(LINEAR)))
    by_number = law_record(element("spring", stiffness=2500.0))
    for e in (-3.0, -0.5, 0.2, 4.0):
        assert force(by_curve, e=e) == pytest.approx(force(by_number, e=e), rel=ROUNDOFF)


def test_slopes_at_rest():
    """Only what bears a static load has a stiffness there."""
    assert slope_at_rest(element("spring", stiffness=3e5)) == 3e5
    assert slope_at_rest(element("traction_rod", stiffness=3e5)) == 3e5
    assert slope_at_rest(element("actuator", mode="length", stiffness=1e6, damping=1.0)) == 1e6
    assert slope_at_rest(element("spring", curve=curve(HARD))) == pytest.approx(float(mirrored(HARD)(0.0, 1)), rel=1e-12)
    for still in (element("damper", damping=1.0), element("maxwell", damping=1.0, series_stiffness=2.0),
                  element("bump_stop", clearance=0.1, stiffness=5.0), element("actuator", mode="force")):
        assert slope_at_rest(still) == 0.0


@pytest.mark.parametrize("points", [HARD, BOTH])
def test_slope_of_a_table(points):
    table, reference = cubic_table(curve(points), element("spring")), mirrored(HARD) if points is HARD else PchipInterpolator(*BOTH)
    for x in (*np.linspace(reference.x[0], reference.x[-1], 17), 0.0):
        assert curve_slope(table, x) == pytest.approx(float(reference(x, 1)), rel=1e-11, abs=1e-8)


def test_tables_are_shared():
    """The same curve gives the same arrays, so studies do not fit it again."""
    first, second = half_table(curve(HARD)), half_table(curve(HARD))
    assert first[0] is second[0] and first[1] is second[1]


@pytest.mark.parametrize("points", [([0.01, 0.02], [0.0, 5.0]), ([0.0, 0.02], [3.0, 5.0])])
def test_a_curve_whose_other_half_is_unknown(points):
    with pytest.raises(ModelError, match=r"group.one: curve 'hard' begins at .* begin at \(0, 0\)"):
        law_record(element("spring", curve=curve(points)))


def test_a_stiffness_over_speed_is_held_beyond_its_end():
    """Straight on, a falling stiffness would become negative: -2e6 N/m at 0.5 m/s here."""
    falling = curve(([0.0, 0.1, 0.2], [3e6, 2e6, 1e6]), ("m/s", "N/m"))
    record = law_record(element("maxwell", damping=1.0, series_stiffness_curve=falling))
    for speed in (0.2, 0.3, -0.5, 50.0):
        assert force(record, e=1e-3, v=speed) == pytest.approx(1e3, rel=ROUNDOFF)
    assert force(record, e=1e-3, v=0.1) == pytest.approx(2e3, rel=ROUNDOFF)


def test_a_bump_stop_with_both_sides_given_is_not_mirrored():
    points = ([-0.01, 0.0, 0.02, 0.03], [-5.0, 0.0, 100.0, 300.0])
    record = law_record(element("bump_stop", curve=curve(points)))
    for e in (-0.008, 0.005, 0.02, 0.027):
        assert force(record, e=e) == pytest.approx(float(PchipInterpolator(*points)(e)), rel=1e-12)
