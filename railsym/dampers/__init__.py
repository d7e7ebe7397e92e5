# SPDX-License-Identifier: BSD-3-Clause
"""Damper models from bench tests.

    tests = railsym.dampers.read_records(["1Hz_1mm.csv", "3Hz_1.5mm.csv"])
    fit = railsym.dampers.identify(tests, model="maxwell")
    fit.to_toml("damper.toml")

Names are imported when they are first used.
"""

from importlib import import_module

_MODULE_OF = {
    "CleanRecord": "record",
    "DamperModel": "models",
    "Fit": "fit",
    "Record": "record",
    "RecordError": "record",
    "RecordWarning": "record",
    "Verdict": "verdict",
    "clean": "cleaning",
    "clean_all": "cleaning",
    "damper_toml": "toml_output",
    "identify": "fit",
    "put_into": "toml_output",
    "read_records": "reading",
    "shipped_records": "reading",
    "sweep": "bench",
    "virtual_bench": "bench",
}

__all__ = [*_MODULE_OF, "compare"]


def __getattr__(name):
    if name == "compare":
        from railsym.dampers.verdict import verdict

        return verdict
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'railsym.dampers' has no attribute {name!r}; it offers {', '.join(__all__)}")
    value = getattr(import_module(f"railsym.dampers.{_MODULE_OF[name]}"), name)
    globals()[name] = value
    return value


def __dir__():
    return sorted({*globals(), *__all__})
