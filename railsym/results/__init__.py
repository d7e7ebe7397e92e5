# SPDX-License-Identifier: BSD-3-Clause
"""Results of simulations: named channels over time, with units, saved and read back.

    run = railsym.Run.from_netcdf("switch.nc")
    run["bogie1.above_wheelset1_left.ay"], run.unit("wheelset1.left.Q"), run.select("*.Y").to_csv("Y.csv")

Names are imported when they are first used.
"""

from importlib import import_module

_MODULE_OF = {
    "Channel": "channel",
    "ChannelWriter": "writer",
    "Channels": "channel",
    "Ending": "metadata",
    "ResultError": "errors",
    "ResultFileError": "errors",
    "Run": "run",
    "RunInfo": "metadata",
    "Spectrum": "spectrum",
    "UnknownChannelError": "errors",
}

__all__ = [*_MODULE_OF]


def __getattr__(name):
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'railsym.results' has no attribute {name!r}; it offers {', '.join(__all__)}")
    value = getattr(import_module(f"railsym.results.{_MODULE_OF[name]}"), name)
    globals()[name] = value
    return value


def __dir__():
    return sorted({*globals(), *__all__})
