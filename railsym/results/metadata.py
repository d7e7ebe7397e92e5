# SPDX-License-Identifier: BSD-3-Clause
"""What was simulated, with what, and how it ended."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field, fields, replace

import numpy as np

from railsym.results.errors import ResultError

REASONS = ("completed", "derailed", "not_converged", "interrupted", "running")


@dataclass(frozen=True)
class Ending:
    """Why a run ended.

    Parameters
    ----------
    reason : str
        ``"completed"``, ``"derailed"``, ``"not_converged"``, ``"interrupted"`` (by the user, or the program ended), or
        ``"running"`` while a `ChannelWriter` is open.
    wheel : str
        Of a derailment, such as ``"wheelset3.left"``.
    time, distance : float or None
        Where it ended, s and m.
    detail : str
        Such as the worst equation when the iteration did not converge.
    """

    reason: str = "completed"
    wheel: str = ""
    time: float | None = None
    distance: float | None = None
    detail: str = ""

    def __post_init__(self):
        if self.reason not in REASONS:
            raise ResultError(f"a run cannot end for the reason {self.reason!r}; there are {', '.join(REASONS)}")

    def __str__(self):
        words = {"not_converged": "did not converge"}.get(self.reason, self.reason)
        wheel = f" ({self.wheel})" if self.wheel else ""
        time = "" if self.time is None else f" at t = {self.time:.6g} s"
        place = "" if self.distance is None else f", s = {self.distance:.6g} m"
        return f"{words}{wheel}{time}{place}{': ' + self.detail if self.detail else ''}"


@dataclass(frozen=True)
class RunInfo:
    """Metadata of a run.

    Parameters
    ----------
    vehicle, configuration, track, creep_law : str
    parameters : dict of str to value
        Parameters that were changed, by dotted name, SI.
    speed : float or None
        m/s, at the start.
    time_step : float or None
        s, of the integration.
    railsym_version : str
        Filled in when not given.
    message : str
        What was found, for people.
    ending : Ending
    extra : dict of str to value
        Anything else that JSON holds (numbers, texts, lists, dicts), such as ``{"wheel_loads": {"wheelset1.left": 55e3}}`` (N).

    Raises
    ------
    ResultError
        Something that a file cannot hold.
    """

    vehicle: str = ""
    configuration: str = ""
    parameters: dict = field(default_factory=dict)
    track: str = ""
    speed: float | None = None
    time_step: float | None = None
    creep_law: str = ""
    railsym_version: str = ""
    message: str = ""
    ending: Ending = field(default_factory=Ending)
    extra: dict = field(default_factory=dict)

    def __post_init__(self):
        for name in ("parameters", "extra"):
            object.__setattr__(self, name, _plain(getattr(self, name), name))
        for name in ("speed", "time_step"):
            value = getattr(self, name)
            object.__setattr__(self, name, None if value is None else float(value))
        if not self.railsym_version:
            from railsym import __version__

            object.__setattr__(self, "railsym_version", __version__)

    @property
    def status(self):
        """The reason why the run ended, one of ``REASONS``."""
        return self.ending.reason

    def ended(self, ending, message=None):
        """The same with another ending, and message if one is given."""
        return replace(self, ending=ending, message=self.message if message is None else message)

    def to_json(self):
        """One line of JSON."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text):
        """From `to_json`; what a newer railsym added is kept in ``extra``."""
        given = json.loads(text)
        ending = Ending(**{k: v for k, v in given.pop("ending", {}).items() if k in {f.name for f in fields(Ending)}})
        known = {f.name for f in fields(cls)}
        extra = given.pop("extra", {}) | {name: given.pop(name) for name in list(given) if name not in known}
        return cls(ending=ending, extra=extra, **given)


def _plain(value, where):
    """The value as JSON holds it: NumPy arrays become lists, numbers floats or ints."""
    if isinstance(value, dict):
        for key in value:
            if not isinstance(key, str):
                raise ResultError(f"metadata {where}: the key {key!r} is no text")
        return {key: _plain(item, f"{where}.{key}") for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item, where) for item in value]
    if isinstance(value, (np.ndarray, np.generic)):
        return _plain(value.tolist(), where)
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    raise ResultError(f"metadata {where}: {type(value).__name__} cannot be saved; give a number, text, list or dict")
