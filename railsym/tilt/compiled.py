# SPDX-License-Identifier: BSD-3-Clause
"""The controller in C, and laws of users in C."""

from __future__ import annotations

import numpy as np

from railsym._core import _doubles, ffi, lib
from railsym.tilt.constants import constants
from railsym.tilt.controller import Controller, checked_times
from railsym.tilt.errors import TiltError
from railsym.tilt.faults import OUTPUTS
from railsym.tilt.signals import SIGNALS, recorded


def c_constants(parameters):
    """``rs_tilt_constants`` of parameters."""
    made = ffi.new("rs_tilt_constants *")
    for name, value in vars(constants(parameters)).items():
        setattr(made, name, value)
    return made


class CompiledController(Controller):
    """The same controller in C: the same outputs to the bit, called from the loop in C without Python.

    Parameters
    ----------
    parameters : TiltParameters, optional
    database : TrackDatabase, optional
    """

    def reset(self):
        """Back to upright, straight track, nothing remembered."""
        table = () if self.database is None else (self.database.place, self.database.curvature, np.sin(self.database.cant))
        columns = [np.ascontiguousarray(column) for column in table] or [np.zeros(1)] * 3
        made = lib.rs_tilt_controller_create(c_constants(self.parameters), len(columns[0]) if table else 0, *map(_doubles, columns))
        if made == ffi.NULL:
            raise MemoryError("no memory for a tilting controller")
        self.context = ffi.gc(made, lib.rs_tilt_controller_free)
        self.function = ffi.addressof(lib, "rs_tilt_controller_step")
        self._room = np.zeros(len(SIGNALS)), np.zeros(1), np.zeros(len(OUTPUTS))
        self._pointers = [_doubles(array) for array in self._room]

    @property
    def outputs(self):
        """Of the last sample, in the order of OUTPUTS."""
        return self._room[2].tolist()

    def step(self, time, signals):
        """Tilt command (rad) for a sample; as `Controller.step`."""
        self._room[0][:] = signals
        lib.rs_tilt_controller_step(self.context, time, *self._pointers)
        return float(self._room[1][0])

    def replay(self, times, signals):
        """Outputs (n, 12) for recorded signals; as `Controller.replay`."""
        times = checked_times(times, self.parameters)
        rows, control, command = recorded(signals, times), self.fresh(), ffi.new("double *")
        found = np.empty((len(times), len(OUTPUTS)))
        for time, row, out in zip(times.tolist(), rows, found):
            lib.rs_tilt_controller_step(control.context, time, _doubles(row), command, _doubles(out))
        return found


class CompiledLaw:
    """A user's law in C, from a shared library.

        int my_law(void *context, double time, const double *signal, double *command, double *output)

    gets the seven SIGNALS, writes the tilt command (rad) and, where it likes, up to twelve outputs (zero otherwise; the first
    becomes the command); anything but 0 stops the run.

    Parameters
    ----------
    library : str or Path
        Such as ``./law.so``.
    name : str
        Of the function.
    rate : float
        Hz, at which it is called.
    context : bytes, optional
        Memory that it gets and may write to: its parameters and its state.

    Raises
    ------
    TiltError
        No such library or function.
    """

    def __init__(self, library, name, *, rate=100.0, context=b""):
        import ctypes
        from pathlib import Path

        try:
            self._library = ctypes.CDLL(str(Path(library).resolve()))
            address = ctypes.cast(getattr(self._library, name), ctypes.c_void_p).value
        except OSError as error:
            raise TiltError(f"law in C: {library}: {error}; build it with cc -shared -fPIC") from None
        except AttributeError:
            raise TiltError(f"law in C: {library} has no function {name!r}; it must be exported under this name") from None
        self.rate, self.name = float(rate), name
        self.function = ffi.cast("rs_tilt_law", address)
        self.memory = ffi.new("char[]", max(len(context), 1))
        ffi.buffer(self.memory)[:len(context)] = context
        self.context = ffi.cast("void *", self.memory)
