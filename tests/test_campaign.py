# SPDX-License-Identifier: BSD-3-Clause
"""Study files with uncertainty and optimisation, their report, and the command."""

import base64
import json
import re
from html.parser import HTMLParser

import numpy as np
import pytest

import railsym as rs
from railsym.campaign import CampaignError, example, load
from railsym.cli import main

SMALL = """
title = "A <small> study & its report"
[study]
vehicle = "bogie"
seed = 3
[analysis]
kind = "critical_speed"
[factors]
"contact.conicity" = { normal = [[0.2, 0.02], "-"], low = 0.1, high = 0.35 }
"primary.stiffness.0" = { normal = [[100, 8], "%"], low = 75, high = 125 }
"secondary_lateral_damper.damping" = { uniform = [[80, 120], "%"] }
[plan]
kind = "latin_hypercube"
cases = 24
"""
UNCERTAINTY = """
[uncertainty]
limit = [260, "km/h"]
sobol = 4
"""
DAMPER = """
[optimise.damper]
maximise = "speed"
recheck = true
[optimise.damper.variables]
"anti_yaw_damper.damping" = { between = [[200, 2000], "kN*s/m"], scale = "log" }
"primary.stiffness.0" = { between = [[2, 6], "MN/m"] }
"""
TRADE = """
[optimise.trade]
maximise = ["worn.speed", "new.speed"]
population = 4
generations = 2
[optimise.trade.variables]
"anti_yaw_damper.damping" = { between = [[200, 2000], "kN*s/m"], scale = "log" }
[optimise.trade.analyses]
worn = { kind = "critical_speed", conicity = 0.4 }
new = { kind = "critical_speed", conicity = 0.1 }
"""
WHOLE = SMALL + UNCERTAINTY + DAMPER + TRADE


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The whole small campaign with its report."""
    folder = tmp_path_factory.mktemp("campaign")
    (folder / "small.toml").write_text(WHOLE, encoding="utf-8")
    found = load(folder / "small.toml").run(folder / "small.nc")
    found.report(folder / "small.html")
    return folder, found


class Page(HTMLParser):
    """Ids, links, images and text of a page."""

    def __init__(self, text):
        super().__init__()
        self.ids, self.links, self.images, self.text, self._open = [], [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.ids += [given["id"]] if "id" in given else []
        self.links += [given[key] for key in ("href", "src") if key in given]
        self.images += [given] if tag == "img" else []
        if tag not in ("img", "meta", "link"):
            self._open.append(tag)

    def handle_endtag(self, tag):
        assert self._open.pop() == tag, f"</{tag}> closes something else"

    def handle_data(self, data):
        self.text.append(data)


def test_the_study_is_the_engines(run):
    folder, found = run
    again = rs.sweep.load(folder / "small.nc")
    assert np.array_equal(again["speed"], found.results["speed"]) and len(again) == 24 and found.results.complete


def test_the_file_is_the_studys_too(run):
    """`Study.load` takes the file and leaves what is made of the results aside."""
    assert rs.Study.load(run[0] / "small.toml").hash == run[1].results.study.hash


def test_uncertainty_agrees_with_itself(run):
    """Count, first-order estimate and deviation of one study tell of the same spread."""
    u = run[1].uncertainty
    assert u.notes == ()
    speed = run[1].results["speed"]
    assert u.probability.below == (speed < 260 / 3.6).sum() and u.probability.cases == 24
    assert u.probability.exact[0] < u.form.probability < u.probability.exact[1]
    # 24 cases of a hypercube: the deviation to some 15 %; first order leaves the curvature out
    assert u.tornado.deviation == pytest.approx(speed.std(ddof=1), rel=0.3)
    assert u.tornado.names[0] == "contact.conicity" and u.sobol.cases == 4 * 5


def test_stable_vehicles_lie_above_limits_within_the_range_only(tmp_path):
    """A range that ends at 40 m/s, where the bogie is stable: a limit below 40 m/s is kept, of one above nothing is known."""
    text = SMALL.replace('kind = "critical_speed"', 'kind = "critical_speed"\nspeed_range = [[5, 40], "m/s"]').replace("cases = 24", "cases = 4")
    for limit, known in ((30, 4), (60, 0)):
        path = tmp_path / f"s{limit}.toml"
        path.write_text(text + f'[uncertainty]\nlimit = [{limit}, "m/s"]\ntornado = false\nform = false\n', encoding="utf-8")
        found = load(path).run(tmp_path / "s.nc", resume=True).uncertainty
        assert (found.probability is None and "none of the 4 cases" in found.notes[0]) if not known else found.probability.value == 0.0


def test_the_optimum_beats_the_vehicle_and_is_checked_anew(run):
    damper, trade = run[1].optimised
    vehicle = run[1].campaign.study.base()
    own = float(rs.critical_speed(vehicle, 0.2).speed)
    best = float(rs.critical_speed(vehicle.replace(damper.found.values), 0.2).speed)
    assert best > 1.05 * own and best == pytest.approx(damper.found.outputs["speed"], rel=1e-9)
    # tolerances in % stand about the optimum
    middle = np.median(damper.recheck["primary.stiffness.0"])
    assert middle == pytest.approx(damper.found.values["primary.stiffness.0"], rel=0.03)
    assert damper.recheck["speed"].mean() > run[1].results["speed"].mean() and damper.probability.below <= run[1].uncertainty.probability.below
    assert len(trade.found) >= 1 and trade.found.evaluations == 9


def test_an_analysis_is_a_case_of_the_optimisation(run):
    """Every number of a front belongs to the case that is named."""
    trade = run[1].optimised[1].found
    by_number = {case.number: case for case in trade.cases}
    for number, values, objectives in zip(trade.numbers, trade.values, trade.objectives):
        assert by_number[number].values == tuple(values)
        assert [by_number[number].outputs[n] for n in ("worn.speed", "new.speed")] == list(objectives)


def test_everything_is_there_once_it_was_computed(run):
    folder, found = run
    with pytest.raises(CampaignError, match="exists"):
        load(folder / "small.toml").run(folder / "small.nc")
    before = {path: path.read_bytes() for path in found.files.values()}
    again = load(folder / "small.toml").run(folder / "small.nc", resume=True)
    assert {path: path.read_bytes() for path in again.files.values()} == before
    assert [one.found.computed for one in again.optimised] == [0, 0]
    assert again.as_data()["summary"] == found.as_data()["summary"]


def test_the_report_holds_all_it_shows(run):
    text = (run[0] / "small.html").read_text(encoding="utf-8")
    page = Page(text)
    assert not page._open and len(set(page.ids)) == len(page.ids)
    for link in page.links:
        assert link.startswith("data:") or link[1:] in page.ids, f"{link[:60]} leads out of the page, or nowhere"
    assert len(page.images) == len(run[1].figures())
    for image in page.images:
        assert base64.b64decode(image["src"].partition(",")[2])[:8] == b"\x89PNG\r\n\x1a\n" and len(image["alt"]) > 20
    assert not re.search(r"url\(|@import|https?://|<script [^>]*src|<link [^>]*href=\"(?!data:)", text)
    assert "A &lt;small&gt; study &amp; its report" in text


def test_the_report_says_where_numbers_come_from(run):
    folder, found = run
    text = "".join(Page((folder / "small.html").read_text(encoding="utf-8")).text)
    from railsym.campaign.provenance import file_hash

    for path in (*found.files.values(), found.campaign.study.path):
        assert file_hash(path) in text and path.name in text
    assert found.results.study.hash in text and "seed3" in text.replace("\n", "") and rs.__version__ in text
    origin = found.campaign.study.base().parameters["primary.stiffness"].origin
    assert origin[:40] in text and origin[-40:] in text and "assumed" in text
    mean = found.results["speed"].mean() * 3.6
    assert f"{mean:.4g}" in text and f"{found.optimised[0].found.objective * 3.6:.4g}" in text
    assert f"case {int(found.results['speed'].argmin())}" in text
    raw = (folder / "small.html").read_text(encoding="utf-8")
    captions = re.findall(r"<figcaption>.*?</figcaption>", raw, re.S)
    assert len(captions) == len(found.figures()) and all(re.search(r'href="#S\d+"', caption) for caption in captions)
    cards = re.findall(r'<div class="card">.*?</div>', raw, re.S)
    assert len(cards) >= 6 and all(re.search(r'href="#S\d+"', card) for card in cards)


def test_failing_cases_are_in_the_report(tmp_path):
    """A friction of -0.1 is refused: those cases fail, the others count."""
    (tmp_path / "s.toml").write_text(SMALL.replace('"contact.conicity" = { normal = [[0.2, 0.02], "-"], low = 0.1, high = 0.35 }',
                                                   '"contact.friction" = { values = [[-0.1, 0.2, 0.3], "-"] }')
                                     .replace("cases = 24", "cases = 6") + '[uncertainty]\nlimit = [260, "km/h"]\n', encoding="utf-8")
    found = load(tmp_path / "s.toml").run(tmp_path / "s.nc")
    assert len(found.results.errors) == 2 and found.uncertainty.probability.unknown == 2
    found.report(tmp_path / "s.html")
    text = (tmp_path / "s.html").read_text(encoding="utf-8")
    assert "2 cases failed" in text and "Failed cases" in text and "friction" in next(iter(found.results.errors.values()))


def test_a_study_that_fails_throughout_is_reported(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(SMALL.replace('"contact.conicity" = { normal = [[0.2, 0.02], "-"], low = 0.1, high = 0.35 }',
                                                   '"contact.friction" = { uniform = [[-0.2, -0.1], "-"] }').replace("cases = 24", "cases = 3")
                                     + '[uncertainty]\nlimit = [260, "km/h"]\n', encoding="utf-8")
    assert main(["study", "s.toml", "--report", "s.html"]) == 0
    shown = capsys.readouterr()
    assert "3 cases failed" in shown.out and "none of the 3 cases has a value" in shown.out and "the first that failed, case 0" in shown.err
    text = (tmp_path / "s.html").read_text(encoding="utf-8")
    assert "No case has a value to draw" in text and "Failed cases" in text
    assert main(["study", "s.toml", "--resume", "--plot", "s.png"]) == 2 and "nothing to draw" in capsys.readouterr().err


def test_a_plain_study_of_two_factors_has_its_map(tmp_path):
    (tmp_path / "s.toml").write_text('[study]\nvehicle = "bogie"\n[analysis]\nkind = "critical_speed"\n[factors]\n'
                                     '"contact.conicity" = { grid = [[0.1, 0.3], "-"], points = 3 }\n'
                                     '"anti_yaw_damper.damping" = { grid = [[50, 150], "%"], points = 3 }\n[plan]\nkind = "full_grid"\n', encoding="utf-8")
    found = load(tmp_path / "s.toml").run(tmp_path / "s.nc")
    assert [figure.name for figure in found.figures()] == ["map"] and "9 cases: 9 done" in str(found)


# --- the command ---------------------------------------------------------------------------------------------------

def test_command_runs_a_study(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(SMALL.replace("cases = 24", "cases = 5"), encoding="utf-8")
    assert main(["study", "s.toml", "--report", "s.html", "--plot", "s.png", "--figures", "pictures", "--json", "s.json"]) == 0
    shown = capsys.readouterr()
    assert "5 cases: 5 done" in shown.out and "study: 5 cases" in shown.err
    assert json.loads((tmp_path / "s.json").read_text())["cases"] == 5
    assert (tmp_path / "s.nc").exists() and (tmp_path / "s.png").stat().st_size > 5000
    assert {p.stem for p in (tmp_path / "pictures").iterdir()} == {"histogram", "parallel", "scatter"}
    assert main(["study", "s.toml"]) == 2 and "--resume" in capsys.readouterr().err
    assert main(["study", "s.toml", "--resume", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["failed"] == 0


def test_command_writes_the_example(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["study", "--example"]) == 0
    assert capsys.readouterr().out.strip() == example().strip()
    assert main(["study", "--example", "damper.toml"]) == 0 and "railsym study damper.toml" in capsys.readouterr().out
    assert main(["study", "--example", "damper.toml"]) == 2
    made = load("damper.toml")
    assert len(made.study.names) == 12 and made.uncertainty.sobol and {one.name for one in made.optimisations} == {"damper", "trade"}


def test_ctrl_c_says_what_is_kept(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(WHOLE, encoding="utf-8")
    from railsym.optimise.speeds import SpeedDesign

    def interrupted(self, x):
        raise KeyboardInterrupt

    monkeypatch.setattr(SpeedDesign, "with_gradient", interrupted)
    assert main(["study", "s.toml"]) == 2
    message = capsys.readouterr().err
    assert "kept are study 24 of 24 cases, sobol 20 of 20 cases" in message and "--resume" in message


@pytest.mark.parametrize("package", ["SALib", "pymoo"])
def test_a_missing_package_is_said_before_anything_runs(package, tmp_path, capsys, monkeypatch):
    import sys

    monkeypatch.chdir(tmp_path)
    for name in [name for name in sys.modules if name.partition(".")[0] == package]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, package, None)
    (tmp_path / "s.toml").write_text(WHOLE, encoding="utf-8")
    assert main(["study", "s.toml"]) == 2
    assert "railsym[studies]" in capsys.readouterr().err and not (tmp_path / "s.nc").exists()


@pytest.mark.parametrize("arguments,text", [
    (["study"], "FILE is missing"),
    (["study", "none.toml"], "--example"),
    (["study", "s.toml", "--report", "s.pdf"], "must end in .html"),
    (["study", "s.toml", "--report", "nowhere/s.html"], "no directory"),
    (["study", "s.toml", "--workers", "0"], "at least one process"),
    (["study", "s.toml", "--reprot", "x"], "nearest: --report"),
])
def test_command_refuses_before_it_computes(arguments, text, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(SMALL, encoding="utf-8")
    assert main(arguments) == 2 and text in capsys.readouterr().err and not (tmp_path / "s.nc").exists()


@pytest.mark.parametrize("old,new,text", [
    ("limit = [260", "limits = [260", "[uncertainty] limits is"),
    ('limit = [260, "km/h"]', "limit = 260", "written with its unit"),
    ('limit = [260, "km/h"]', 'limit = [260, "kg"]', "wrong dimension"),
    ("sobol = 4", "sobol = 6", "power of two"),
    ('"-"], low = 0.1, high = 0.35', '"-"], lwo = 0.1', "lwo is"),
    ('maximise = "speed"', 'maximise = "sped"', "sped"),
    ('maximise = "speed"', 'maximise = "speed.p5"', "robust = 32"),
    ('maximise = "speed"', 'maximise = "speed"\nrobust = 8', "name a statistic"),
    ('maximise = "speed"', 'description = "none"', "no objective"),
    ('"anti_yaw_damper.damping" = { between = [[200', '"anti_yaw_damper.dampin" = { between = [[200', "anti_yaw_damper.damping"),
    ('between = [[2, 6], "MN/m"]', 'between = [[6, 2], "MN/m"]', "ascending"),
    ("population = 4", "most = 4", "with one objective"),
    ("recheck = true", "generations = 3", "with several objectives"),
    ("recheck = true", 'method = "newton"', "gradient, simplex, global"),
    ("conicity = 0.4", "conicty = 0.4", "conicty"),
    ("[optimise.trade]", "[optimize.trade]", "optimise"),
])
def test_what_a_file_cannot_say_is_named(old, new, text, tmp_path):
    assert old in WHOLE
    path = tmp_path / "wrong.toml"
    path.write_text(WHOLE.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(rs.RailsymError) as error:
        load(path)
    assert text in str(error.value) and "wrong.toml" in str(error.value)


def test_speed_comfort_and_derailment_at_once(tmp_path):
    """Critical speed, a ride over irregular track and a curve, as objectives and a constraint of one front; each number as the analyses give it alone."""
    text = SMALL + """
[optimise.trade]
maximise = "worn.speed"
minimise = ["ride.comfort.N_MV"]
population = 4
generations = 1
[optimise.trade.variables]
"secondary_lateral_damper.damping" = { between = [[5, 80], "kN*s/m"], scale = "log" }
"primary.stiffness.0" = { between = [[2, 8], "MN/m"] }
[optimise.trade.constraints]
"curve.derailment.YQ" = { at_most = [0.8, "-"] }
[optimise.trade.analyses]
worn = { kind = "critical_speed", conicity = 0.4 }
ride = { kind = "transient", speed = [40, "m/s"], duration = [6, "s"], irregularity = "erri_b176_low", criteria = ["comfort"] }
curve = { kind = "transient", speed = [20, "m/s"], duration = [9, "s"], track = "s_curve_500", criteria = ["derailment"] }
"""
    (tmp_path / "s.toml").write_text(text.replace("cases = 24", "cases = 2"), encoding="utf-8")
    campaign = load(tmp_path / "s.toml")
    front = campaign.run(tmp_path / "s.nc").optimised[0].found
    assert front.failed == 0 and front.evaluations == 5 and len(front) >= 1
    from railsym.sweep import Transient
    from railsym.sweep.worker import Case

    changes = dict(zip(front.problem.names, map(float, front.values[0])))
    curve = Transient(speed=20.0, duration=9.0, track="s_curve_500", criteria=("derailment",)).solver(campaign.study.base())
    assert front.outputs[0]["curve.derailment.YQ"] == curve(Case(campaign.study.base(), changes, {}))["derailment.YQ"]
    assert 0.0 < front.outputs[0]["curve.derailment.YQ"] < 0.8 and front.outputs[0]["ride.comfort.N_MV"] > 0.0
    # stiffer lateral dampers of the two that are otherwise alike would shake more: the spread is there to be traded
    assert np.ptp([case.outputs["ride.comfort.N_MV"] for case in front.cases]) > 0.01
