# SPDX-License-Identifier: BSD-3-Clause
"""The report in a real browser, headless: pictures loaded, no errors, nothing from outside, sorting, narrow and wide windows."""

import os
import re
import shutil
import subprocess

import pytest

from railsym.campaign import load

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
BROWSER = os.environ.get("RAILSYM_BROWSER") or next(filter(None, map(shutil.which, NAMES)), None)
pytestmark = pytest.mark.skipif(BROWSER is None, reason=f"no browser found ({', '.join(NAMES)}); install chromium, or name one in RAILSYM_BROWSER")
STUDY = """
title = "Bogie in the browser"
[study]
vehicle = "bogie"
[analysis]
kind = "critical_speed"
[factors]
"contact.conicity" = { uniform = [[0.15, 0.25], "-"] }
"primary.stiffness.0" = { normal = [[100, 8], "%"], low = 75, high = 125 }
"a_very_long_parameter" = { uniform = [[80, 120], "%"] }
[plan]
kind = "latin_hypercube"
cases = 12
[uncertainty]
limit = [260, "km/h"]
""".replace("a_very_long_parameter", "secondary_vertical_damper.series_stiffness")
# asks the page what a reader would see: width, order of a table before and after two clicks on its first heading
PROBE = """<script>
addEventListener("load", () => {
  const table = document.querySelector("#cases table.sort"), order = () => [...table.tBodies[0].rows].map(row => row.cells[0].textContent).join(" ");
  const said = { inner: innerWidth, wide: document.documentElement.scrollWidth, before: order() };
  const speed = [...table.tHead.rows[0].cells].findIndex(cell => cell.textContent.startsWith("speed"));
  table.tHead.rows[0].cells[speed].click();
  said.values = [...table.tBodies[0].rows].map(row => Number(row.cells[speed].dataset.value));
  table.tHead.rows[0].cells[0].click();
  table.tHead.rows[0].cells[0].click();
  said.after = order();
  document.body.dataset.said = JSON.stringify(said);
});
</script>"""


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    (folder / "s.toml").write_text(STUDY, encoding="utf-8")
    load(folder / "s.toml").run(folder / "s.nc").report(folder / "s.html")
    text = (folder / "s.html").read_text(encoding="utf-8")
    (folder / "probe.html").write_text(text.replace("</body>", PROBE + "</body>"), encoding="utf-8")
    (folder / "broken.html").write_text(text.replace("data:image/png;base64,", "data:image/png;base64,AA", 1).replace(
        "</body>", "<script>nothing.here()</script></body>"), encoding="utf-8")
    return folder


def browse(page, *options, width=1280, height=1600):
    """What the browser gives on standard output, and on the console."""
    profile = page.parent / f"profile-{page.stem}-{width}"
    done = subprocess.run([BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
                           "--disable-component-update", "--disable-sync", "--hide-scrollbars", "--force-device-scale-factor=1", "--enable-logging=stderr",
                           f"--user-data-dir={profile}", f"--window-size={width},{height}", *options, page.as_uri()],
                          capture_output=True, text=True, timeout=120, check=True)
    return done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line]


def said(dom):
    import json
    from html import unescape

    return json.loads(unescape(re.search(r'data-said="([^"]*)"', dom)[1]))


def test_all_pictures_have_loaded_and_nothing_complains(report):
    dom, console = browse(report / "s.html", "--dump-dom")
    found = re.search(r"(\d+) of (\d+) pictures shown", dom)
    assert found and found[1] == found[2] and int(found[1]) == dom.count("<img ") >= 4
    assert console == []


def test_the_check_can_fail(report):
    dom, console = browse(report / "broken.html", "--dump-dom")
    found = re.search(r"(\d+) of (\d+) pictures shown", dom)
    assert int(found[1]) == int(found[2]) - 1 and any("nothing is not defined" in line for line in console)


@pytest.mark.parametrize("width", [500, 1280])
def test_the_page_fits_its_window_and_sorts(report, width):
    dom, console = browse(report / "probe.html", "--dump-dom", width=width)
    seen = said(dom)
    assert seen["wide"] <= seen["inner"] == width and console == []
    assert seen["values"] == sorted(seen["values"]) and len(seen["values"]) == 12
    assert seen["before"].split() == [str(k) for k in range(12)] and seen["after"].split() == [str(k) for k in range(11, -1, -1)]


def test_a_picture_of_the_page_is_not_blank(report):
    import matplotlib.image

    browse(report / "s.html", f"--screenshot={report / 's.png'}", width=900)
    seen = matplotlib.image.imread(report / "s.png")[..., :3]
    assert seen.shape[:2] == (1600, 900)
    ink = (seen.min(axis=2) < 0.9)
    # text and drawings in every quarter of the window, from top to bottom
    assert all(0.01 < part.mean() < 0.6 for part in (ink[k:k + 400] for k in range(0, 1600, 400)))
