# SPDX-License-Identifier: BSD-3-Clause
"""Reading study files with ``[uncertainty]`` and ``[optimise.NAME]`` (docs/uncertainty_and_optimisation.md describes them)."""

from __future__ import annotations

import tomllib
from pathlib import Path

from railsym.campaign.campaign import Campaign
from railsym.campaign.errors import CampaignError
from railsym.campaign.optimisation import read as read_optimisation
from railsym.campaign.tables import known
from railsym.campaign.uncertainty import read as read_uncertainty
from railsym.errors import RailsymError
from railsym.sweep.study_file import _SECTIONS, ON_TOP, from_document

EXAMPLE = Path(__file__).parent.parent / "data" / "studies" / "pendolino_damper.toml"


def load(path):
    """A campaign from its TOML file.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    Campaign

    Raises
    ------
    CampaignError
        Naming the file, the key, and what is allowed.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
        content = tomllib.loads(text)
    except OSError as error:
        raise CampaignError(f"study file {path}: {error.strerror}; `railsym study --example` writes one to begin with") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise CampaignError(f"study file {path}: {error}") from None
    try:
        known("the file:", content, (*_SECTIONS, *ON_TOP))
        own = {name: content.pop(name) for name in ON_TOP if name in content}
        study = from_document(content, path.parent)
        uncertainty = read_uncertainty(own["uncertainty"], study) if "uncertainty" in own else None
        optimise = own.get("optimise", {})
        if not isinstance(optimise, dict) or not all(isinstance(table, dict) for table in optimise.values()):
            raise CampaignError("[optimise]: optimisations have names, write [optimise.damper]")
        optimisations = tuple(read_optimisation(name, table, study, path.parent) for name, table in optimise.items())
    except RailsymError as error:
        raise CampaignError(f"study file {path}: {error}") from None
    title = own.get("title") or f"{study.loaded.name}{' ' + study.configuration if study.configuration else ''}: {study.analysis.kind.replace('_', ' ')}"
    return Campaign(study, uncertainty, optimisations, str(title), str(own.get("description", "")), path, text)


def example():
    """Text of the demonstration study."""
    return EXAMPLE.read_text(encoding="utf-8")
