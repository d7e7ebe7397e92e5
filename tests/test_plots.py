# SPDX-License-Identifier: BSD-3-Clause
"""Drawings: what is drawn equals the results, is labelled with its unit, and says what is missing."""

from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
import pytest

import railsym as rs
from railsym import plots
from railsym.critical_speed import CriticalSpeeds
from railsym.plots.mode_shape import displacement
from railsym.plots.outlines import Outline, box_of, outlines
from railsym.plots.stability_curves import always_stable
from railsym.plots.style import line_styles, spread
from railsym.stability_map import StabilityMap

CONICITY = np.array([0.1, 0.2, 0.4])


@pytest.fixture(autouse=True)
def closed_figures():
    yield
    plt.close("all")


@pytest.fixture(scope="module")
def found():
    return rs.stability_map(rs.load_vehicle("bogie"), conicity=CONICITY, criteria=["real_part", 0.05])


@pytest.fixture(scope="module")
def model():
    return rs.linear_model(rs.load_vehicle("bogie"), rs.LinearContact(conicity=0.2))


@pytest.fixture(scope="module")
def tracked(model):
    return rs.track_modes(model, np.linspace(20.0, 90.0, 8))


def lines(axes):
    """Labelled line -> its data."""
    return {line.get_label(): line.get_xydata() for line in axes.get_lines() if not line.get_label().startswith("_")}


def text_of(figure):
    """Everything written in the figure's legends."""
    parts = [legend for legend in figure.legends]
    return " ".join(t.get_text() for legend in parts for t in [*legend.get_texts(), legend.get_title()])


def test_critical_speed_by_criterion(found):
    axes = found.plot()
    assert len(axes) == 2
    assert [a.get_title(loc="left") for a in axes] == ["real part = 0", "damping ratio = 5 %"]
    for column, panel in enumerate(axes):
        assert panel.get_xlabel() == "equivalent conicity" and panel.get_ylim()[0] == 0.0
        drawn = lines(panel)
        assert tuple(drawn) == found.configurations
        for name, row in zip(found.configurations, found.results):
            np.testing.assert_allclose(drawn[name], np.column_stack([CONICITY, 3.6 * row[column].speed]), rtol=1e-12)
    assert axes[0].get_ylabel() == "critical speed, km/h"
    assert all(name in text_of(axes[0].figure) for name in found.configurations)


def test_every_line_lies_within_shared_limits(found):
    for panel in found.plot():
        top = panel.get_ylim()[1]
        assert all(np.nanmax(data[:, 1]) <= top for data in lines(panel).values())


def test_frequency_against_conicity_and_speed(found):
    axes = plots.plot_frequency(found)
    assert axes.shape == (2, 2) and axes[0, 0].get_ylabel() == "frequency of unstable mode, Hz"
    assert axes[1, 0].get_xlabel() == "critical speed, km/h"
    name, result = found.configurations[0], found.results[0][0]
    np.testing.assert_allclose(lines(axes[0, 0])[name], np.column_stack([CONICITY, result.frequency_hz]), rtol=1e-12)
    np.testing.assert_allclose(lines(axes[1, 0])[name], np.column_stack([3.6 * result.speed, result.frequency_hz]), rtol=1e-12)


def test_change_against_the_first_configuration(found):
    axes = plots.plot_change(found)
    first, second = found.configurations
    drawn = lines(axes[0])
    speed = found.speed
    np.testing.assert_allclose(drawn[first][:, 1], 0.0, atol=1e-12)
    np.testing.assert_allclose(drawn[second][:, 1], 100 * (speed[1, 0] / speed[0, 0] - 1), rtol=1e-12)
    assert drawn[second][0, 1] < -10, "the bogie is slower without anti-yaw dampers"
    assert axes[0].get_ylabel() == f"change against {first}, %"


def test_report_holds_all_of_it(found):
    axes = plots.plot_stability_report(found)
    assert axes.shape == (4, 2)
    single = rs.stability_map(rs.load_vehicle("bogie"), ["with_anti_yaw_dampers"], [0.2], ["real_part"])
    assert plots.plot_stability_report(single).shape == (3, 1)


def case(speed, message, crossings=()):
    """CriticalSpeeds of made-up numbers; None is masked."""
    missing = [s is None for s in speed]
    values = np.ma.masked_array([s or 0.0 for s in speed], missing)
    return CriticalSpeeds(CONICITY, values, values / 10.0, np.array([""] * 3), tuple(crossings) or ((),) * 3, tuple(message), 0.0,
                          (5.0, 250.0), SimpleNamespace(configuration="made_up"))


def crossing(speed, direction):
    return SimpleNamespace(speed=speed, direction=direction)


def test_a_missing_critical_speed_is_marked_at_the_edge():
    result = case([None, 80.0, None], ["no mode becomes unstable between 5 and 250 m/s", "", "already unstable at the lowest speed"])
    made = StabilityMap(("made_up",), (0.0,), CONICITY, ((result,),), 0)
    panel = made.plot()[0]
    marks = {line.get_marker(): line.get_xydata()[0] for line in panel.get_lines() if line.get_linestyle() == "None"}
    np.testing.assert_allclose(marks["^"], [0.1, 1.0])          # axes fraction: upper edge
    np.testing.assert_allclose(marks["v"], [0.4, 0.0])
    written = text_of(panel.figure)
    assert "no critical speed up to 900 km/h" in written and "already at 18 km/h" in written


def test_messages_of_the_library_tell_stable_from_unstable():
    """The marks rest on what the messages say."""
    vehicle = rs.load_vehicle("bogie")
    assert always_stable(rs.critical_speed(vehicle, [0.1], speed_range=(5.0, 10.0)).message[0])
    assert always_stable(rs.critical_speed(vehicle, [0.1], damping_ratio=0.01, speed_range=(5.0, 10.0)).message[0])
    assert not always_stable(rs.critical_speed(vehicle, [0.4], speed_range=(200.0, 250.0)).message[0])


def test_a_range_that_ends_again_is_a_bar():
    twice = (crossing(40.0, 1), crossing(60.0, -1), crossing(100.0, 1))
    made = StabilityMap(("made_up",), (0.0,), CONICITY, ((case([40.0] * 3, [""] * 3, (twice, twice[:1], twice[:1])),),), 0)
    panel = made.plot()[0]
    bars = [line.get_xydata() for line in panel.get_lines() if line.get_linewidth() == 5.0]
    assert len(bars) == 1
    np.testing.assert_allclose(bars[0], [[0.1, 144.0], [0.1, 216.0]])
    again = [line.get_xydata().tolist() for line in panel.get_lines() if line.get_markerfacecolor() == "white"]
    np.testing.assert_allclose(again, [[[0.1, 360.0]]])
    assert "again from the open mark" in text_of(panel.figure)


def test_a_jump_of_frequency_is_a_gap():
    result = case([100.0, 90.0, 80.0], [""] * 3)
    result = CriticalSpeeds(**{**vars(result), "frequency_hz": np.ma.array([4.0, 8.0, 8.5])})
    panel = plots.plot_frequency(StabilityMap(("made_up",), (0.0,), CONICITY, ((result,),), 0))[0, 0]
    drawn = lines(panel)["made_up"]
    assert np.isnan(drawn[1]).all() and len(drawn) == 4


def test_one_vehicle_alone(found):
    axes = found.results[0][0].plot()
    assert list(lines(axes)) == ["with_anti_yaw_dampers"]


def test_given_axes_are_used_and_a_wrong_number_refused(found):
    _, axes = plt.subplots(1, 2)
    assert found.plot(axes=axes)[1] is axes[1]
    with pytest.raises(ValueError, match="2 axes are needed, 1 were given"):
        found.plot(axes=axes[0])


def test_root_locus_is_coloured_by_speed(tracked):
    axes = tracked.plot()
    shown = axes.collections
    drawn = np.concatenate([c.get_offsets() for c in shown if len(c.get_offsets()) == len(tracked.speed)])
    expected = np.column_stack([tracked.eigenvalue.real.ravel(), tracked.eigenvalue.imag.ravel() / (2 * np.pi)])
    for point in drawn:
        assert np.abs(expected - point).sum(axis=1).min() < 1e-12
    np.testing.assert_allclose(shown[0].get_array(), 3.6 * tracked.speed)
    assert axes.get_xlabel() == "real part, 1/s" and axes.get_ylabel() == "frequency, Hz"
    assert "5 %" in [t.get_text() for t in axes.texts] and "bogie hunting" in [t.get_text() for t in axes.texts]


def test_damping_lines_have_their_damping_ratio(tracked):
    axes = tracked.plot()
    rays = [line.get_xydata() for line in axes.get_lines() if line.get_linestyle() == ":"]
    ratios = []
    for ray in rays:
        x, y = ray[1]
        ratios.append(-x / np.hypot(x, 2 * np.pi * y))
    np.testing.assert_allclose(ratios, [0.05, 0.1, 0.2, 0.3], rtol=1e-12)


def test_eigenvalues_at_one_speed(model):
    modes = rs.linearise(model.vehicle, 83.0, rs.LinearContact(conicity=0.2)).modes()
    axes = modes.plot()
    offsets = axes.collections[0].get_offsets()
    assert offsets[:, 0].max() == pytest.approx(max(m.eigenvalue.real for m in modes if m.frequency_hz > 0), rel=1e-12)
    assert "299 km/h" in axes.get_title(loc="left") or "298.8 km/h" in axes.get_title(loc="left")


def test_damping_and_frequency_over_speed(tracked):
    damping, frequency = plots.plot_damping(tracked)
    assert damping.get_ylabel() == "damping ratio, %" and frequency.get_ylabel() == "frequency, Hz"
    curves = [line.get_ydata() for line in damping.get_lines() if len(line.get_xdata()) == len(tracked.speed)]
    assert curves
    for curve in curves:
        assert np.abs(100 * tracked.damping_ratio - curve[:, None]).max(axis=0).min() < 1e-10


def test_mode_shape_displaces_each_body_by_its_shape():
    vehicle = rs.load_vehicle("bogie")
    mode = SimpleNamespace(shape={"frame.yaw": 1.0}, label="yaw", frequency_hz=1.0, damping_ratio=0.1)
    axes = plots.plot_mode_shape(mode, vehicle)
    rest, moved = (next(line.get_xydata() for line in axes.get_lines() if line.get_color() == colour and len(line.get_xdata()) == 13)
                   for colour in ("#b5b5b5", "#0072B2"))
    # yaw about z takes forward (x) to the right (y): the front of the frame moves to larger y, or all of it the other way round
    front, rear = rest[:, 0] > 1.0, rest[:, 0] < -1.0
    shift = (moved - rest)[:, 1]
    assert np.sign(shift[front]).tolist() == [np.sign(shift[front][0])] * front.sum()
    np.testing.assert_allclose(shift[rear].mean(), -shift[front].mean(), rtol=1e-9)
    np.testing.assert_allclose(shift / shift[front].max() if shift[front].max() > 0 else shift / shift[front].min(),
                               rest[:, 0] / rest[front, 0].max(), atol=1e-9)


@pytest.mark.parametrize("angle, arm, move", [
    ("yaw", (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),          # the nose goes to the right
    ("roll", (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),         # the right side goes down
    ("pitch", (1.0, 0.0, 0.0), (0.0, 0.0, -1.0)),       # the nose goes up
])
def test_a_rotation_moves_points_as_the_conventions_say(angle, arm, move):
    vehicle = rs.load_vehicle("bogie")
    outline = Outline(vehicle.body("frame").position + np.array([arm]), ("frame",), "frame")
    np.testing.assert_allclose(displacement({f"frame.{angle}": 1.0}, vehicle, outline), [move], atol=1e-15)


def test_mode_shape_draws_a_quarter_of_a_period_later():
    """y(t) = Re(exp(i omega t)): the frame is at its largest displacement, a quarter of a period later in the middle."""
    vehicle = rs.load_vehicle("bogie")
    mode = SimpleNamespace(shape={"frame.y": 1.0, "wheelset1.y": -0.5j}, label="", frequency_hz=2.0, damping_ratio=0.0)
    axes = plots.plot_mode_shape(mode, vehicle)
    by_colour = {c: [line.get_xydata() for line in axes.get_lines() if line.get_color() == c] for c in ("#b5b5b5", "#0072B2", "#E69F00")}
    axle = [data for data in by_colour["#b5b5b5"] if len(data) == 2 and data[0, 0] == data[1, 0] == 1.35][0]
    later = [data for data in by_colour["#E69F00"] if len(data) == 2 and abs(data[0, 0] - 1.35) < 1e-9][0]
    frame = [data for data in by_colour["#0072B2"] if len(data) == 13][0] - [d for d in by_colour["#b5b5b5"] if len(d) == 13][0]
    # y(T/4) = Re(i * (-0.5i)) = +0.5 of the frame's displacement
    np.testing.assert_allclose((later - axle)[:, 1], 0.5 * frame[0, 1], rtol=1e-9)


def test_mode_shape_of_the_whole_train_shows_each_bogie_enlarged():
    vehicle = rs.load_vehicle("pendolino").configured("AS_K")
    mode = rs.linearise(vehicle, 80.0).modes()[3]
    axes = plots.plot_mode_shape(mode, vehicle, speed=80.0)
    assert len(axes.figure.axes) == 3 and "288 km/h" in axes.get_title(loc="left")
    assert axes.yaxis_inverted(), "right, or down, is at the bottom"


def test_vertical_motion_is_seen_from_the_side():
    vehicle = rs.load_vehicle("bogie")
    bounce = SimpleNamespace(shape={"car.z": 1.0}, label="bounce", frequency_hz=1.0, damping_ratio=0.1)
    assert plots.plot_mode_shape(bounce, vehicle).get_ylabel().startswith("z, m")


def test_outline_box_has_the_inertia_of_the_body():
    body = SimpleNamespace(mass=12.0, inertia=np.diag([2.0**2 + 1.0**2, 3.0**2 + 1.0**2, 3.0**2 + 2.0**2]))
    np.testing.assert_allclose(box_of(body), [3.0, 2.0, 1.0])         # m (b^2 + c^2)/12 and so on with m = 12


def test_outlines_of_every_shipped_vehicle():
    for name in rs.vehicles():
        vehicle = rs.load_vehicle(name)
        for view in ("above", "side"):
            drawn = outlines(vehicle, view)
            wheels = [o for o in drawn if o.kind == "wheel"]
            count = sum(b.kind == "wheelset" for b in vehicle.bodies)
            assert len(wheels) == count * (2 if view == "above" else 1)
            assert all(np.isfinite(o.points).all() and len(o.bodies) == len(o.points) for o in drawn)


def test_sensitivities_are_bars_in_order():
    result = rs.sensitivity(rs.load_vehicle("bogie"), 0.2, parameters=["conicity", "frame.mass", "car.mass", "anti_yaw_damper.damping"])
    axes = result.plot(count=3)
    np.testing.assert_allclose([bar.get_width() for bar in axes.patches], result.speed_elasticity[:3])
    assert [t.get_text().split()[0] for t in axes.get_yticklabels()] == list(result.names[:3])
    assert axes.get_ylim()[0] > axes.get_ylim()[1], "the strongest is on top"
    assert "%" in axes.get_xlabel()


def test_parameter_maps():
    vehicle = rs.load_vehicle("bogie")
    one = rs.parameter_map(vehicle, {"anti_yaw_damper.damping": [2e5, 8e5, 3e6, 9e6]}, conicity=0.2)
    axes = one.plot()
    np.testing.assert_allclose(axes.get_lines()[0].get_ydata(), 3.6 * one.speed)
    assert axes.get_xlabel() == "anti_yaw_damper.damping, N*s/m" and axes.get_xscale() == "log"
    two = rs.parameter_map(vehicle, {"conicity": [0.1, 0.2, 0.3], "car.mass": [15e3, 20e3, 25e3]})
    axes = two.plot()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("conicity", "car.mass, kg")


def test_line_styles_differ():
    styles = line_styles([str(k) for k in range(16)])
    assert len({(s["color"], s["marker"], str(s["linestyle"])) for s in styles.values()}) == len(styles)
    assert len({s["color"] for s in list(styles.values())[:8]}) == 8


def test_labels_are_spread_to_their_distance_and_no_further():
    placed = spread(np.array([0.0, 0.1, 5.0]), 1.0)
    np.testing.assert_allclose(placed, [-0.45, 0.55, 5.0])
    np.testing.assert_allclose(spread(np.array([0.0, 0.1, 5.0]), 1.0, low=0.0), [0.5, 1.5, 5.0])
