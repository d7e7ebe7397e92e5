# SPDX-License-Identifier: BSD-3-Clause
"""Damper models from bench tests.

    tests = railsym.dampers.read_records(["1Hz_1mm.csv", "3Hz_1.5mm.csv"])
    fit = railsym.dampers.identify(tests, model="maxwell")
    fit.to_toml("damper.toml")

Names are imported when they are first used.
"""

from railsym.lazy import lazy

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
    "compare": "verdict:verdict",
    "identify": "fit",
    "put_into": "toml_output",
    "read_records": "reading",
    "shipped_records": "reading",
    "sweep": "bench",
    "virtual_bench": "bench",
}

__getattr__, __dir__, __all__ = lazy(__name__, _MODULE_OF)
