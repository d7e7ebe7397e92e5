# SPDX-License-Identifier: BSD-3-Clause
"""Where a number comes from: versions, files with their hashes, cases, seeds, and what of the vehicle's data is assumed."""

from __future__ import annotations

import hashlib
import platform
import subprocess
import sys
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

_PACKAGES = ("railsym", "numpy", "scipy", "matplotlib", "SALib", "pymoo")
_REPLACED = "set by"


@dataclass(frozen=True)
class Source:
    """Something that numbers come from.

    Attributes
    ----------
    mark : str
        Short name in the report, such as "S1".
    title : str
    facts : tuple of (str, str)
    """

    mark: str
    title: str
    facts: tuple[tuple[str, str], ...]


def sources(found):
    """Everything that the numbers of a report come from: dict of name to `Source`.

    Parameters
    ----------
    found : CampaignResults
    """
    study, made = found.campaign.study, {}

    def add(name, title, facts):
        made[name] = Source(f"S{len(made) + 1}", title, tuple((key, str(value)) for key, value in facts if value not in (None, "")))

    add("vehicle", "vehicle file", [("file", study.path), ("SHA-256", file_hash(study.path)), ("configuration", study.configuration),
                                    ("set", ", ".join(f"{k} = {v}" for k, v in study.set.items()))])
    add("study", "study: store of results", _store_facts(found.results, found.files["study"]))
    if "sobol" in found.files and found.uncertainty is not None:
        add("sobol", "cases for the Sobol indices (Saltelli's scheme, SALib)", _store_facts(found.uncertainty.sobol_results, found.files["sobol"]))
    if found.uncertainty is not None and (found.uncertainty.tornado is not None or found.uncertainty.form is not None):
        add("model", "analytic gradient of the critical speed, computed for this report", [
            ("vehicle", f"file {made['vehicle'].mark}, factors at their medians"), ("analysis", _analysis(study)),
            ("tornado", found.uncertainty.tornado and f"1 gradient, {2 * len(study.names)} values computed anew"),
            ("first-order reliability", found.uncertainty.form and f"{found.uncertainty.form.evaluations} gradients")])
    for one in found.optimised:
        _add_optimised(add, found, one)
    return made


def _add_optimised(add, found, one):
    name = f"optimise.{one.optimisation.name}"
    path = found.files[name]
    add(name, f"history of the optimisation {one.optimisation.name!r}", [
        ("file", path), ("SHA-256", file_hash(path)), ("key of the problem", one.found.problem.key()), ("seed", one.optimisation.options.get("seed")),
        ("cases", f"{one.found.evaluations}, numbers as in the file; {one.found.failed} failed"),
        ("cases a design", one.optimisation.robust)])
    if one.recheck is not None:
        add(f"recheck.{one.optimisation.name}", f"the study at the optimum of {one.optimisation.name!r}",
            _store_facts(one.recheck, found.files[f"recheck.{one.optimisation.name}"]))


def _store_facts(results, path):
    study = results.study
    return [("file", path), ("SHA-256", file_hash(path)), ("hash of the study", study.hash), ("plan", study.plan.kind.replace("_", " ")),
            ("seed", study.seed), ("cases", f"0 to {len(results) - 1}; {results.message}"), ("analysis", _analysis(study))]


def _analysis(study):
    from railsym.sweep.analysis import to_table

    return ", ".join(f"{name} = {value}" for name, value in to_table(study.analysis).items())


def file_hash(path):
    """SHA-256 of a file; empty where there is none."""
    path = Path(path)
    if not path.is_file():
        return ""
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def versions():
    """Versions of what computed the report: list of (name, version)."""
    found = [("Python", platform.python_version())]
    for name in _PACKAGES:
        try:
            found.append((name, version(name)))
        except PackageNotFoundError:
            continue
    revision = commit()
    return found + ([("commit of railsym", revision)] if revision else []) + [("machine", f"{platform.machine()}, {platform.system()}")]


def commit():
    """Commit of the checkout that railsym runs from, with a mark where files differ from it; empty for an installed package."""
    root = Path(__file__).resolve().parents[2]
    if not (root / ".git").exists():
        return ""
    try:
        def git(*words):
            return subprocess.run(["git", "-C", str(root), *words], capture_output=True, text=True, check=True, timeout=10).stdout.strip()

        return git("rev-parse", "HEAD") + (" with changes" if git("status", "--porcelain", "--untracked-files=no", "--", "railsym", "csrc") else "")
    except (OSError, subprocess.SubprocessError):
        return ""


def command():
    """The command line that runs."""
    return " ".join([Path(sys.argv[0]).name, *sys.argv[1:]])


def now():
    """Time of the report, UTC."""
    return datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")


def origin(study, name):
    """Origin of a factor's own value in the vehicle file, and whether it is assumed.

    Returns
    -------
    (str, bool)
    """
    base = study.base()
    if name not in base.parameters:
        return ("input of the analysis", False)
    text = base.parameters[name].origin or ""
    return text, is_assumed(text)


def is_assumed(text):
    """Whether an origin says so."""
    return "assumed" in text.lower()


def assumed_share(vehicle):
    """How many numbers of the vehicle are assumed, and of how many (places left out, whose origin is the drawing)."""
    origins = [q.origin or "" for name, q in vehicle.parameters.items() if not name.endswith("position")]
    return sum(map(is_assumed, origins)), len(origins)
