# SPDX-License-Identifier: BSD-3-Clause
"""Results of simulations: named channels over time, with units, saved and read back.

    run = railsym.Run.from_netcdf("switch.nc")
    run["bogie1.above_wheelset1_left.ay"], run.unit("wheelset1.left.Q"), run.select("*.Y").to_csv("Y.csv")

Names are imported when they are first used.
"""

from railsym.lazy import lazy

_MODULE_OF = {
    "Channel": "channel",
    "ChannelWriter": "writer",
    "Channels": "channel",
    "Ending": "metadata",
    "FileRun": "lazy",
    "ResultError": "errors",
    "ResultFileError": "errors",
    "Run": "run",
    "RunInfo": "metadata",
    "Spectrum": "spectrum",
    "UnknownChannelError": "errors",
}

__getattr__, __dir__, __all__ = lazy(__name__, _MODULE_OF)
