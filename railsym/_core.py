# SPDX-License-Identifier: BSD-3-Clause
"""The only module that touches the C library; above it everything is float64 arrays."""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from railsym._railsym import ffi, lib
from railsym.errors import ContactError, CoreError, ModelError

_MEANING = {
    lib.RS_NO_MEMORY: "no memory",
    lib.RS_BAD_INDEX: "an index is outside its range",
    lib.RS_BAD_SIZE: "a size is not positive, or force laws are missing",
    lib.RS_NOT_FINITE: "the residual is not finite",
    lib.RS_NOT_CONVERGED: "an iteration did not converge, or the force does not grow with speed",
}

LAWS = {
    "none": lib.RS_LAW_NONE,
    "spring_damper": lib.RS_LAW_SPRING_DAMPER,
    "maxwell": lib.RS_LAW_MAXWELL,
    "bump_stop": lib.RS_LAW_BUMP_STOP,
    "actuator_force": lib.RS_LAW_ACTUATOR_FORCE,
    "actuator_length": lib.RS_LAW_ACTUATOR_LENGTH,
}


FAULTS = "none", "stuck", "free", "damped"
SEEN = {"length": lib.RS_SEEN_LENGTH, "rate": lib.RS_SEEN_RATE, "force": lib.RS_SEEN_FORCE}

_LAW_NUMBERS = "preload", "stiffness", "damping", "clearance", "command", "lag", "rate_limit", "force_limit", "bypass_damping"


def _check(status, what):
    if status != lib.RS_OK:
        raise CoreError(f"{what}: {_MEANING.get(status, f'unknown status {status}')}", status)


def _doubles(array):
    return ffi.from_buffer("double[]", array)


def _vector(values, size, what):
    """A contiguous float64 array of ``size`` numbers, or an error that names both sizes."""
    array = np.ascontiguousarray(values, dtype=float)
    if array.size != size:
        raise ModelError(f"{what}: {size} numbers are needed, {array.size} were given")
    return array


@dataclass(frozen=True)
class Kernel:
    """Description of one generated kernel.

    Attributes
    ----------
    number : int
    name : str
    inputs, units : tuple of str
        Input names in slot order, with their units.
    coordinates : int
    pattern : ndarray of int, shape (entries, 2)
        Row and column of each pencil entry.
    slots : ndarray of int, shape (coordinates, 5)
        Input slots of q, u, a, sin, cos of each coordinate, -1 for none.
    has_law : bool
    """

    number: int
    name: str
    inputs: tuple
    units: tuple
    coordinates: int
    pattern: np.ndarray
    slots: np.ndarray
    has_law: bool

    @cached_property
    def slot_of(self):
        """Input name -> slot number."""
        return {name: k for k, name in enumerate(self.inputs)}


@cache
def kernels():
    """Name -> Kernel of every kernel in the library."""
    found = {}
    for number in range(lib.rs_kernel_count()):
        info = lib.rs_kernel_describe(number)
        names = [ffi.string(info.input_names[k]).decode() for k in range(info.inputs)]
        units = [ffi.string(info.input_units[k]).decode() for k in range(info.inputs)]
        rows = ffi.unpack(info.row, info.entries), ffi.unpack(info.column, info.entries)
        slots = np.array(ffi.unpack(info.slots, 5 * info.coordinates)).reshape(-1, 5)
        pattern = np.array([list(part) for part in rows]).T
        name = ffi.string(info.name).decode()
        found[name] = Kernel(number, name, tuple(names), tuple(units), info.coordinates,
                             pattern, slots, bool(info.has_law))
    return found


def lanes():
    """Instances that a kernel computes at once."""
    return lib.rs_kernel_lanes()


class Laws:
    """Force laws in C memory; kept alive as long as a model refers to them.

    Parameters
    ----------
    records : list of dict
        Keys ``kind`` (a key of LAWS), ``preload``, ``stiffness``, ``damping``,
        ``clearance``, ``command``, ``lag``, ``rate_limit``, ``force_limit`` (0: none),
        ``bypass_damping`` (SI), ``stiffness_curve``, ``damping_curve``
        (a pair of breakpoints (n,) and coefficients (n - 1, 4), or None), ``fault`` (one of FAULTS)
        and ``keep`` (True: elongation, rate and force of the last evaluation are kept).
    """

    def __init__(self, records):
        self._keep = []
        self.array = ffi.new("rs_law[]", len(records))
        for law, record in zip(self.array, records, strict=True):
            law.kind = LAWS[record["kind"]]
            for key in _LAW_NUMBERS:
                setattr(law, key, record.get(key, 0.0))
            law.fault = FAULTS.index(record.get("fault", "none"))
            if record.get("keep"):
                law.seen = self._seen()
            for key in ("stiffness_curve", "damping_curve"):
                setattr(law, key, self._curve(record.get(key)))
        self.pointers = ffi.new("rs_law *[]", [ffi.addressof(self.array, k) for k in range(len(records))])

    def _seen(self):
        room = ffi.new("double[]", lib.RS_SEEN_ROOM)
        self._keep.append(room)
        return room

    def _curve(self, table):
        if table is None:
            return ffi.NULL
        x, c = (np.ascontiguousarray(part, dtype=float) for part in table)
        curve = ffi.new("rs_curve *", {"n": len(x), "x": _doubles(x), "c": _doubles(c)})
        self._keep += [curve, x, c]
        return curve

    def set_numbers(self, numbers, record):
        """Give some laws of one group, by their places, the numbers (SI) of a record of the same kind and curves; the preload stays."""
        first = self.array[numbers[0]]
        changed = {key: record.get(key, 0.0) for key in _LAW_NUMBERS[1:] if getattr(first, key) != record.get(key, 0.0)}
        for number in numbers if changed else ():
            for key, value in changed.items():
                setattr(self.array[number], key, value)

    def set_preload(self, values):
        """Set the preload (N) of every law; shape (n,)."""
        for law, value in zip(self.array, _vector(values, len(self.array), "preloads"), strict=True):
            law.preload = value

    def set_command(self, number, value):
        """Set the command (N or m) of one actuator."""
        if not 0 <= number < len(self.array):
            raise ModelError(f"command of force law {number}: there are {len(self.array)}, counted from 0")
        self.array[number].command = value

    def command(self, number):
        """Command (N or m) of one actuator."""
        return self.array[number].command

    def lags(self, number):
        """Whether an actuator lags behind its command."""
        return self.array[number].lag > 0.0

    def set_fault(self, number, fault):
        """Set the fault, one of FAULTS, of one actuator."""
        self.array[number].fault = FAULTS.index(fault)

    def fault(self, number):
        """Fault of one actuator, one of FAULTS."""
        return FAULTS[self.array[number].fault]

    def seen(self, number):
        """Elongation (m), rate (m/s) and force (N) of one actuator at the last evaluation, shape (3,)."""
        return np.array(ffi.unpack(self.array[number].seen, lib.RS_SEEN))


def kernel_real(name, inputs, seed, law=None):
    """Residual and pencil of one kernel for one instance.

    Parameters
    ----------
    inputs : array_like, shape (inputs,)
    seed : array_like, shape (3,)
        (cq, cu, ca).
    law : dict, optional
        Force law record, see `Laws`.

    Returns
    -------
    residual : ndarray, shape (coordinates,)
    pencil : ndarray, shape (coordinates, coordinates)
    """
    kernel, width = kernels()[name], lanes()
    packed = np.repeat(_vector(inputs, len(kernel.inputs), name)[:, None], width, axis=1)
    laws = Laws([law or {"kind": "none"}] * width)
    r = np.empty((kernel.coordinates, width))
    entries = np.empty((len(kernel.pattern), width))
    _check(lib.rs_kernel_real(kernel.number, _doubles(np.ascontiguousarray(packed)), laws.pointers,
                              _doubles(_vector(seed, 3, "seed")), _doubles(r), _doubles(entries)), name)
    return r[:, 0].copy(), _dense(kernel, entries[:, 0])


def kernel_complex(name, inputs, seed, law=None):
    """As `kernel_real` with complex inputs, residual and pencil (for the complex step)."""
    kernel = kernels()[name]
    packed = np.ascontiguousarray(inputs, dtype=complex)
    if packed.size != len(kernel.inputs):
        raise ModelError(f"{name}: {len(kernel.inputs)} inputs are needed, {packed.size} were given")
    laws = Laws([law or {"kind": "none"}])
    r = np.empty(kernel.coordinates, dtype=complex)
    entries = np.empty(len(kernel.pattern), dtype=complex)
    _check(lib.rs_kernel_complex(kernel.number, _doubles(packed.view(float)), laws.pointers[0],
                                 _doubles(_vector(seed, 3, "seed")), _doubles(r.view(float)),
                                 _doubles(entries.view(float))), name)
    return r, _dense(kernel, entries)


def _dense(kernel, entries):
    matrix = np.zeros((kernel.coordinates, kernel.coordinates), dtype=entries.dtype)
    matrix[kernel.pattern[:, 0], kernel.pattern[:, 1]] = entries
    return matrix


def _check_motion(status, what, residual):
    """As `_check`; names the first coordinate whose residual is not finite."""
    if status != lib.RS_OK:
        wrong = np.flatnonzero(~np.isfinite(residual))
        _check(status, f"{what}, coordinate {wrong[0]}" if len(wrong) else what)


class Assembly:
    """The assembled model in C: residual and pencil over all coordinates.

    Parameters
    ----------
    is_angle : array_like of bool, shape (n,)
        Coordinates whose sine and cosine the kernels need.
    """

    def __init__(self, is_angle):
        flags = np.ascontiguousarray(is_angle, dtype=np.uint8)
        self.size = len(flags)
        model = lib.rs_model_create(self.size, ffi.from_buffer("unsigned char[]", flags))
        if model == ffi.NULL:
            raise ModelError(f"a model of {self.size} coordinates cannot be created")
        self._model = ffi.gc(model, lib.rs_model_free)
        self._is_angle, self._counts, self._laws = flags, {}, {}

    def add(self, name, inputs, index, laws=None):
        """Add every instance of one kernel.

        Parameters
        ----------
        name : str
        inputs : array_like, shape (count, inputs)
            Parameters in their slots; coordinate slots are ignored.
        index : array_like of int, shape (count, coordinates)
            Coordinate numbers, -1 for one that does not exist.
        laws : Laws, optional
        """
        if name not in kernels() or name in self._counts:
            raise ModelError(f"kernel {name!r} " + ("was added before; add all its instances at once" if name in self._counts
                                                    else f"does not exist; there are {', '.join(kernels())}"))
        kernel = kernels()[name]
        inputs = np.ascontiguousarray(inputs, dtype=float)
        index = np.ascontiguousarray(index, dtype=np.intc)
        if inputs.shape != (len(index), len(kernel.inputs)) or index.shape[1:] != (kernel.coordinates,):
            raise ModelError(f"{name}: inputs {inputs.shape} and index {index.shape} do not fit "
                             f"{len(kernel.inputs)} inputs and {kernel.coordinates} coordinates")
        if laws is not None and len(laws.array) != len(index):
            raise ModelError(f"{name}: {len(index)} instances need as many force laws, {len(laws.array)} were given")
        turned = index[:, kernel.slots[:, 3] >= 0]
        turned = turned[(turned >= 0) & (turned < self.size)]
        if not self._is_angle[turned].all():
            unknown = turned[self._is_angle[turned] == 0][0]
            raise ModelError(f"{name}: coordinate {unknown} is an angle there, but the model was not made to compute its "
                             "sine and cosine; set it in is_angle")
        pointers = laws.pointers if laws else ffi.NULL
        _check(lib.rs_model_add(self._model, kernel.number, len(index), _doubles(inputs),
                                ffi.from_buffer("int[]", index), pointers), f"adding {name}")
        self._counts[name], self._laws[name] = len(index), laws

    def set_input(self, name, slot_name, values):
        """Give one input of every instance of a kernel new values, shape (count,)."""
        if name not in self._counts:
            raise ModelError(f"input {slot_name!r} of kernel {name!r}: none was added; there are {', '.join(self._counts) or 'none'}")
        kernel = kernels()[name]
        if slot_name not in kernel.slot_of:
            raise ModelError(f"kernel {name} has no input {slot_name!r}; it has {', '.join(kernel.inputs)}")
        values = _vector(values, self._counts[name], f"{name}.{slot_name}")
        _check(lib.rs_model_set_input(self._model, kernel.number, kernel.slot_of[slot_name], _doubles(values)),
               f"{name}.{slot_name}")

    def residual(self, q, u, a):
        """Residual r(q, u, a), shape (n,); inputs are left as they are."""
        state = [_vector(v, self.size, what) for v, what in zip((q, u, a), "qua", strict=True)]
        r = np.empty(self.size)
        _check_motion(lib.rs_model_residual(self._model, *map(_doubles, state), _doubles(r)), "residual", r)
        return r

    def pencil(self, q, u, a, seed):
        """Matrix cq dr/dq + cu dr/du + ca dr/da, shape (n, n), for seed (cq, cu, ca)."""
        state = [_vector(v, self.size, what) for v, what in zip((q, u, a), "qua", strict=True)]
        r, matrix = np.empty(self.size), np.empty((self.size, self.size))
        status = lib.rs_model_pencil(self._model, *map(_doubles, state), _doubles(_vector(seed, 3, "seed")),
                                     _doubles(r), _doubles(matrix))
        _check_motion(status, "pencil", r)
        return matrix


def bench_run(law, time, elongation, rate, substeps=1, start=0.0):
    """Force (N) and damper elongation (m) of one law under imposed motion, arrays (n,) in SI.

    Raises
    ------
    CoreError
        With the time of the step that failed.
    """
    n = len(time)
    given = [_vector(part, n, "bench") for part in (time, elongation, rate)]
    force, state, failed = np.zeros(n), np.zeros(n), ffi.new("int *")
    laws = Laws([law])
    status = lib.rs_bench_run(laws.array, n, *map(_doubles, given), substeps, start, _doubles(force),
                              _doubles(state), failed)
    _check(status, f"virtual bench at t = {given[0][min(failed[0], n - 1)]:.6g} s")
    return force, state


def bench_cycles(law, period, elongation, rate, substeps=1, state=None):
    """Periodic force and damper elongation, arrays (tests, n), of one law; ``period`` (tests,) in s.

    ``state`` (tests, n) is a guess and is overwritten.
    """
    elongation = np.ascontiguousarray(elongation, dtype=float)
    tests, n = elongation.shape
    given = [_vector(part, size, "bench") for part, size in ((period, tests), (elongation, tests * n), (rate, tests * n))]
    force, failed = np.empty((tests, n)), ffi.new("int *")
    state = np.zeros((tests, n)) if state is None else state
    laws = Laws([law])
    status = lib.rs_bench_cycles(laws.array, tests, n, *map(_doubles, given), substeps, _doubles(force), _doubles(state), failed)
    _check(status, f"virtual bench, test number {failed[0]}")
    return force, state


CREEP_LAWS = {
    "kalker_linear": "RS_CREEP_KALKER_LINEAR",
    "shen_hedrick_elkins": "RS_CREEP_SHEN_HEDRICK_ELKINS",
    "polach": "RS_CREEP_POLACH",
    "fastsim": "RS_CREEP_FASTSIM",
    "fastrip": "RS_CREEP_FASTRIP",
    "exact": "RS_CREEP_EXACT",
}


def creep_forces(law, rows, grid, slopes):
    """Creep forces of n contacts, and their slopes if asked.

    Parameters
    ----------
    law : str
        A key of CREEP_LAWS.
    rows : array_like, shape (15, n)
        Inputs as listed at rs_creep_forces in railsym.h.
    grid : pair of int
        Strips and cells of FASTSIM and FaStrip.
    slopes : bool

    Returns
    -------
    forces : ndarray, shape (3, n)
    slopes : ndarray, shape (3, 6, n), or None
    """
    rows = np.ascontiguousarray(rows, dtype=float)
    if rows.ndim != 2 or len(rows) != lib.RS_CREEP_INPUTS:
        raise ContactError(f"creep forces take {lib.RS_CREEP_INPUTS} rows, got shape {rows.shape}")
    contacts = rows.shape[1]
    forces, found = np.empty((3, contacts)), np.empty((3, 6, contacts)) if slopes else None
    arrays = contacts, _doubles(rows), _doubles(forces), _doubles(found) if slopes else ffi.NULL
    if law == "exact":
        from railsym._core_exact import creep_table

        status = lib.rs_creep_forces_exact(creep_table(), *arrays)
    else:
        status = lib.rs_creep_forces(getattr(lib, CREEP_LAWS[law]), *grid, *arrays)
    _check(status, f"creep law {law}")
    return forces, found
