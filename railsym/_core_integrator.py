# SPDX-License-Identifier: BSD-3-Clause
"""The integrator of the C library; above it everything is float64 arrays."""

import numpy as np

from railsym._core import _MEANING, _check, _doubles, _vector, ffi, lib
from railsym.errors import ModelError

CHANNELS = {"position": lib.RS_CHANNEL_POSITION, "rate": lib.RS_CHANNEL_RATE, "acceleration": lib.RS_CHANNEL_ACCELERATION,
            "element": lib.RS_CHANNEL_ELEMENT, "wheel": lib.RS_CHANNEL_WHEEL, "patch": lib.RS_CHANNEL_PATCH,
            "law": lib.RS_CHANNEL_LAW}
OK, NOT_CONVERGED, NOT_FINITE = lib.RS_OK, lib.RS_NOT_CONVERGED, lib.RS_NOT_FINITE
SINGULAR, STOPPED, OUT_OF_TRACK = lib.RS_SINGULAR, lib.RS_STOPPED, lib.RS_OUT_OF_TRACK
OUT_OF_TABLE, BAD_SPEED = lib.RS_OUT_OF_TABLE, lib.RS_BAD_SPEED

_MEANING.setdefault(SINGULAR, "a block of the matrix is singular")
_MEANING.setdefault(STOPPED, "the controller stopped the run")
_MEANING.setdefault(OUT_OF_TRACK, "a body is beyond the end of the track")


def _integers(values):
    array = np.ascontiguousarray(values, dtype=np.intc)
    return ffi.from_buffer("int[]", array) if array.size else ffi.new("int[]", 1)


def _floats(values):
    array = np.ascontiguousarray(values, dtype=float)
    return _doubles(array) if array.size else ffi.new("double[]", 1)


class Integrator:
    """A model in motion, stepped in C.

    Parameters
    ----------
    assembly : railsym._core.Assembly
        Kept, and used as work space: evaluate nothing else with it during a run.
    block : array_like of int, shape (second,)
        Number of the body of each coordinate; the coordinates after them are internal ones.
    step : float
        s
    rho : float
        Spectral radius at infinite frequency, 0 ... 1.
    tolerance : float
        m/s^2, acceleration that the iteration may leave wrong.

    Raises
    ------
    ModelError
        A value outside its range, or blocks that do not fit the model.
    """

    def __init__(self, assembly, block, step, rho, tolerance):
        block = np.asarray(block)
        self._assembly, self.size, self.step = assembly, assembly.size, step
        made = lib.rs_integrator_create(assembly._model, len(block), int(block.max()) + 1, _integers(block), step, rho, tolerance)
        if made == ffi.NULL:
            raise ModelError(f"an integrator with step {step} s, rho {rho}, tolerance {tolerance} m/s^2 and {len(block)} coordinates in "
                             f"{int(block.max()) + 1} bodies cannot be made: step and tolerance must be positive, rho between 0 and 1, "
                             "at most eight coordinates a body, each internal coordinate in one element")
        self._pointer = ffi.gc(made, lib.rs_integrator_free)
        self._travel = self._callback = self.why = None
        self.channels = 0

    def start(self, time, q, u):
        """Begin at a time (s) from q and u (n,); returns the status, see `report`."""
        return lib.rs_integrator_start(self._pointer, time, *(_doubles(_vector(v, self.size, w)) for v, w in ((q, "q"), (u, "u"))))

    def set_step(self, step):
        """Steps of another length (s), from the next `start` on."""
        _check(lib.rs_integrator_set_step(self._pointer, step), f"step of {step} s")
        self.step = step

    def hold(self, coordinates, stiffness, damping, mass):
        """Hold coordinates by springs (N/m) and dampers (N s/m) to where they are zero, and pull masses (kg) along as the frames speed up."""
        _check(lib.rs_integrator_hold(self._pointer, len(coordinates), _integers(coordinates), _floats(stiffness),
                                      _floats(damping), _floats(mass)), "holding coordinates")

    @property
    def force(self):
        """Applied generalised forces (n,), N and N m; a view to write to between runs."""
        pointer = lib.rs_integrator_force(self._pointer)
        return np.frombuffer(ffi.buffer(pointer, 8 * self.size), dtype=float)

    def set_kinks(self, times):
        """Times (s, increasing) where steps end and begin anew."""
        if (np.diff(times) < 0.0).any():
            raise ModelError("kinks: the times (s) must increase")
        _check(lib.rs_integrator_kinks(self._pointer, len(times), _floats(times)), "kinks")

    def set_channels(self, channels):
        """What a sample holds: list of (kind of CHANNELS, number, instance, row); elements in the order of kernels and instances."""
        record = ffi.new("rs_channel[]", max(len(channels), 1))
        for entry, values in zip(record, channels):
            entry.kind, entry.number, entry.instance, entry.row = CHANNELS[values[0]], *values[1:]
        _check(lib.rs_integrator_channels(self._pointer, len(channels), record), "channels")
        self.channels = len(channels)

    def set_controller(self, function, every, context=ffi.NULL, why=None):
        """A C function (cffi pointer to rs_controller) called before every ``every``-th step; None takes it away.

        ``why`` () gives the exception that tells why it stopped a run, or None.
        """
        self._callback, self._context, self.why = function, context, why
        lib.rs_integrator_controller(self._pointer, ffi.NULL if function is None else function, context, every)

    def set_watcher(self, function, context=ffi.NULL):
        """A C function (as for `set_controller`) called before every step, which sees and changes nothing; None takes it away."""
        self._watcher, self._watched = function, context
        lib.rs_integrator_watcher(self._pointer, ffi.NULL if function is None else function, context)

    def set_travel(self, travel):
        """A `Travel` that moves the track frames, or None."""
        self._travel = travel
        lib.rs_integrator_travel(self._pointer, ffi.NULL if travel is None else travel._pointer)

    def set_wheels(self, forces, first):
        """Wheel-rail forces (`railsym.wheel_rail.WheelRail`) and the first coordinate of each wheelset; needs a travel."""
        self._wheels = forces
        _check(lib.rs_integrator_wheels(self._pointer, forces.pointer, len(first), _integers(first)), "wheels")

    def restart(self):
        """A force has jumped: accelerations anew from the state as it is; returns the status."""
        return lib.rs_integrator_restart(self._pointer)

    def follow(self):
        """Commands or faults of actuators are new: what they follow goes on from there without ringing."""
        lib.rs_integrator_follow(self._pointer)

    def look(self):
        """Evaluate everything at the present state, so that laws have seen it; returns the status."""
        return lib.rs_integrator_look(self._pointer)

    def inertial(self, kernel, instance, arm, felt):
        """Specific force (m/s^2) and angular velocity (rad/s) of a point of a body, into ``felt`` (6,); ``arm`` (3,) in m. Returns the status."""
        return lib.rs_integrator_inertial(self._pointer, kernel, instance, _doubles(arm), _doubles(felt))

    def sample(self):
        """Channels at the present state, shape (channels,), and the status."""
        row = np.empty(max(self.channels, 1))
        status = lib.rs_integrator_sample(self._pointer, _doubles(row))
        return row[:self.channels], status

    def run(self, steps, every, samples):
        """Steps in C with the interpreter free; fills rows of ``samples`` (rows, channels).

        Returns
        -------
        status, rows : int
        """
        done = ffi.new("int *")
        room = samples if samples.size else np.empty(1)
        status = lib.rs_integrator_run(self._pointer, steps, every, _doubles(room), done)
        return status, done[0]

    def state(self):
        """q, u, a of the present time, each (n,)."""
        found = np.empty((3, self.size))
        lib.rs_integrator_state(self._pointer, *map(_doubles, found))
        return found

    @property
    def report(self):
        """Counts and the last status: an rs_run_report."""
        return lib.rs_integrator_report(self._pointer)[0]

    def residual(self, time, q, u, a):
        """r(q, u, a) at a time with holds, forces, wheels and track, shape (n,)."""
        r = np.empty(self.size)
        given = [_doubles(_vector(v, self.size, w)) for v, w in ((q, "q"), (u, "u"), (a, "a"))]
        _check(lib.rs_integrator_residual(self._pointer, time, *given, _doubles(r)), "residual")
        return r

    def solve(self, q, u, a, seed, b):
        """S x = b with the pencil at a state, by blocks; shape (n,). Start again before the next run."""
        x = np.empty(self.size)
        given = [_doubles(_vector(v, size, w)) for v, size, w in ((q, self.size, "q"), (u, self.size, "u"), (a, self.size, "a"),
                                                                 (seed, 3, "seed"), (b, self.size, "b"))]
        _check(lib.rs_integrator_solve(self._pointer, *given, _doubles(x)), "solution in blocks")
        return x

    def fill(self):
        """Block operations of one factorisation, doubles of the factors."""
        counts = ffi.new("int[2]")
        lib.rs_integrator_fill(self._pointer, counts, counts + 1)
        return counts[0], counts[1]


class Travel:
    """Track frames that move along a track, and the inputs that follow them.

    Parameters
    ----------
    track : pointer or None
        rs_track of the C library; None: straight and level.
    x : array_like, shape (frames,)
        m, places of the frames ahead of the vehicle's centre.
    pieces : array_like, shape (pieces, 4)
        Start time (s), place (m), speed (m/s) and acceleration (m/s^2) of each piece of constant acceleration.
    gravity : float
        m/s^2
    """

    def __init__(self, track, x, pieces, gravity, keep=None):
        columns = np.ascontiguousarray(np.asarray(pieces, dtype=float).T)
        made = lib.rs_travel_create(ffi.NULL if track is None else track, len(x), _floats(x), columns.shape[1],
                                    *map(_floats, columns), gravity)
        if made == ffi.NULL:
            raise ModelError("the motion of the track frames cannot be made: no frames, no pieces of speed, or no memory")
        self._pointer, self._keep = ffi.gc(made, lib.rs_travel_free), keep

    def add_bodies(self, assembly, kernel, frames):
        """Kernel number and the frame of each of its instances."""
        _check(lib.rs_travel_bodies(self._pointer, assembly._model, kernel, _integers(frames)), "frames of bodies")

    def add_pairs(self, assembly, kernel, instances, frames, offsets):
        """Instances (count,) of a kernel, frames (count, 2) and offsets (count, 2, 3) of their ends."""
        _check(lib.rs_travel_pairs(self._pointer, assembly._model, kernel, len(instances), _integers(instances), _integers(frames),
                                   _floats(offsets)), "frames of elements")

    def add_wheelsets(self, frames):
        """Frames of the wheelsets."""
        _check(lib.rs_travel_wheelsets(self._pointer, len(frames), _integers(frames)), "frames of wheelsets")

    def set_steady(self):
        """Take every place as if it went on for ever: no angular acceleration of the frames."""
        lib.rs_travel_steady(self._pointer, 1)
