# SPDX-License-Identifier: BSD-3-Clause
"""The control loop where nothing limits: plant from the linear model, step response, bandwidth, margins.

    plant      x' = A x + B set point,  tilt = C x      linear model of the vehicle with the actuators' lag
    set point  runs straight from one command to the next within a period
    servo      u = demand + kp e + i + d,  e = y - tilt  (railsym.tilt.servo without its limits, as matrices)
    loop       L(z) = z^-n (kp + ki T/(z - 1) + D(z)) P(z),  P from sample to sample (SciPy)
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from railsym.tilt.constants import constants
from railsym.tilt.drive import TiltDrive
from railsym.tilt.errors import TiltError
from railsym.tilt.parameters import TiltParameters

_LOWEST = 0.01       # Hz, of frequency responses
_POINTS = 2000


@dataclass(frozen=True)
class Margins:
    """Of a loop.

    Attributes
    ----------
    gain : float
        Factor that the loop's gain can grow by; inf where the phase never reaches -180 degrees.
    gain_frequency : float
        Hz, where it would then oscillate.
    phase : float
        rad; inf where the gain stays below 1.
    phase_frequency : float
        Hz, where the gain is 1.
    sensitivity : float
        Largest of |1/(1 + L)|.
    """

    gain: float
    gain_frequency: float
    phase: float
    phase_frequency: float
    sensitivity: float

    def __str__(self):
        gain = f"{self.gain:.2f} ({20.0 * np.log10(self.gain):.1f} dB) at {self.gain_frequency:.2f} Hz" if np.isfinite(self.gain) else "unlimited"
        phase = f"{np.degrees(self.phase):.1f} deg at {self.phase_frequency:.2f} Hz" if np.isfinite(self.phase) else "unlimited (gain below 1)"
        return f"gain margin {gain}, phase margin {phase}, largest sensitivity {self.sensitivity:.2f}"


@dataclass(frozen=True, eq=False)
class TiltLoop:
    """A controller on the linear model of a vehicle.

    Attributes
    ----------
    parameters : TiltParameters
    A, B, C : ndarray (n, n), (n,), (n,)
        Plant: tilt command (rad) to tilt (rad).
    speed : float
        m/s
    """

    parameters: TiltParameters
    A: np.ndarray = field(repr=False)
    B: np.ndarray = field(repr=False)
    C: np.ndarray = field(repr=False)
    speed: float = 0.0

    @classmethod
    def of(cls, vehicle, speed, parameters=None, contact=None):
        """Of a tilting vehicle at a speed (m/s) on straight track.

        Raises
        ------
        TiltError
            Actuators without a lag, which have no state that the command moves.
        """
        from railsym.linear import linearise

        drive, lin = TiltDrive.of(vehicle), linearise(vehicle, speed=speed, contact=contact) if contact else linearise(vehicle, speed=speed)
        place = {name: k for k, name in enumerate(lin.states)}
        B, C = np.zeros(len(place)), np.zeros(len(place))
        elements = {e.name: e for e in vehicle.elements}
        for name, powers in zip(drive.actuators, drive.powers):
            lag = elements[name].parameters.get("lag", 0.0)
            if not lag > 0.0 or f"{name}.s" not in place:
                raise TiltError(f"actuator {name} has no lag: the linear plant needs one (s)")
            B[place[f"{name}.s"]] = powers[1] / lag
        C[place[f"{drive.car}.roll"]] = 1.0
        for bolster in drive.bolsters:
            C[place[f"{bolster}.roll"]] -= 1.0 / len(drive.bolsters)
        return cls(parameters or TiltParameters(), lin.A, B, C, float(speed))

    @property
    def frequencies(self):
        """Hz, up to half of the controller's rate."""
        return np.geomspace(_LOWEST, 0.5 * self.parameters.rate, _POINTS)

    def plant(self, frequency):
        """Response (complex) of tilt to its command at frequencies (Hz)."""
        return self._partial(2j * np.pi * np.atleast_1d(frequency))

    @cached_property
    def _partial(self):
        return partial_fractions(self.A, self.B, self.C)

    @cached_property
    def held_plant(self):
        """(A, B, C) from sample to sample: states x and the set point; input the command, which the set point reaches in a period."""
        from scipy.signal import cont2discrete

        n, T = len(self.B), self.parameters.period
        A = np.zeros((n + 1, n + 1))
        A[:n, :n], A[:n, n] = self.A, self.B
        C, slope = np.append(self.C, 0.0), np.eye(n + 1)[n]
        Ad, Bd, *_ = cont2discrete((A, slope[:, None], C[None], np.zeros((1, 1))), T)
        per_command = Bd[:, 0] / T
        return Ad - np.outer(per_command, slope), per_command, C

    def open_loop(self, frequency):
        """L at frequencies (Hz)."""
        z = np.exp(2j * np.pi * np.asarray(frequency) * self.parameters.period)
        return z ** -self.parameters.delay * pid_response(self.parameters, z) * self._held_partial(z)

    @cached_property
    def _held_partial(self):
        A, B, _ = self.held_plant
        n = len(self.B)
        moving, standing = (partial_fractions(A[:n, :n], part, self.C) for part in (B[:n], A[:n, n]))
        return lambda z: moving(z) + standing(z) / z

    def margins(self):
        """`Margins` of the loop."""
        f = self.frequencies[:-1]
        return margins(f, self.open_loop(f))

    def closed(self):
        """Discrete system (scipy.signal.dlti): demand (rad) to tilt and command (rad)."""
        from scipy.signal import dlti

        return dlti(*closed_loop(self.parameters, *self.held_plant), dt=self.parameters.period)

    def step(self, duration=5.0, size=1.0):
        """Times (s), tilt and command for a step of the demand (rad), by SciPy's dlsim."""
        from scipy.signal import dlsim

        n = round(duration * self.parameters.rate) + 1
        times, found, _ = dlsim(self.closed(), np.full((n, 1), size))
        return times, found[:, 0], found[:, 1]

    def response(self, frequency):
        """Tilt over demand at frequencies (Hz): P z^-n (1 + C M)/(1 + L), M the reference model with its latency."""
        k, z = constants(self.parameters), np.exp(2j * np.pi * np.asarray(frequency) * self.parameters.period)
        model = k.stiffness * k.period * z / ((z - 1.0) * (z - 1.0 + k.damping) + k.stiffness * k.period * z)
        late, plant, pid = z ** -self.parameters.delay, self._held_partial(z), pid_response(self.parameters, z)
        return plant * late * (1.0 + pid * model * late) / (1.0 + late * pid * plant)

    def bandwidth(self):
        """Hz, at which tilt over demand has fallen by 3 dB."""
        f = self.frequencies
        found = np.abs(self.response(f))
        below = found < found[0] / np.sqrt(2.0)
        return float(f[np.argmax(below)]) if below.any() else np.inf

    def __str__(self):
        times, tilt, _ = self.step()
        end = tilt[-1]
        rise = times[np.argmax(tilt > 0.9 * end)] - times[np.argmax(tilt > 0.1 * end)]
        half = times[np.argmax(tilt > 0.5 * end)]
        static = np.abs(self.plant(_LOWEST)[0])
        return (f"tilt follows its command with a static gain of {static:.3f}; loop at {3.6 * self.speed:.0f} km/h, {self.parameters.rate:g} Hz, latency "
                f"{1e3 * self.parameters.latency:g} ms: {self.margins()}; step of the demand: half after {half:.2f} s, 10 to 90 % in {rise:.2f} s, overshoot "
                f"{100.0 * max(tilt.max() / end - 1.0, 0.0):.1f} %, -3 dB at {self.bandwidth():.2f} Hz")


def partial_fractions(A, B, C):
    """Function of complex s (n,): C (s - A)^-1 B by the eigenvalues of A."""
    values, left = np.linalg.eig(A)
    residues = (C @ left) * np.linalg.solve(left, B.astype(complex))
    return lambda s: (residues / (s[:, None] - values)).sum(axis=1)


def pid_response(parameters, z):
    """kp + ki T/(z - 1) + kd/T b (1 - 1/z)/(1 - (1 - b)/z) at complex z."""
    k = constants(parameters)
    return k.kp + k.ki / (z - 1.0) + k.derivative * k.kd * (1.0 - 1.0 / z) / (1.0 - (1.0 - k.derivative) / z)


def margins(frequency, loop):
    """`Margins` of a frequency response (n,) at frequencies (n,) in Hz."""
    size, phase = np.abs(loop), np.unwrap(np.angle(loop))
    down = np.flatnonzero((size[:-1] >= 1.0) & (size[1:] < 1.0))
    turned = np.flatnonzero((phase[:-1] > -np.pi) & (phase[1:] <= -np.pi))
    gain, gain_at, left, left_at = np.inf, np.nan, np.inf, np.nan
    if turned.size:
        k = turned[0]
        part = (phase[k] + np.pi) / (phase[k] - phase[k + 1])
        gain, gain_at = (float(1.0 / (size[k] + part * (size[k + 1] - size[k]))), float(frequency[k] + part * (frequency[k + 1] - frequency[k])))
    if down.size:
        each = [np.interp(1.0, size[[k + 1, k]], phase[[k + 1, k]]) + np.pi for k in down]
        worst = int(np.argmin(each))
        left, left_at = float(each[worst]), float(frequency[down[worst]])
    return Margins(gain, gain_at, left, left_at, float(np.abs(1.0 / (1.0 + loop)).max()))


def servo_matrices(parameters):
    """(A, B, C, D) of the servo without limits: inputs demand, tilt; output command.

    States: y, its rate, the integral, the derivative, the last error, commands and demands that wait (latency).
    """
    k = constants(parameters)
    n, size = k.delay, 5 + 2 * k.delay
    A, B = np.zeros((size, size)), np.zeros((size, 2))
    error, error_in = np.eye(size)[0], np.array([0.0, -1.0])
    derivative = k.derivative * k.kd * (error - np.eye(size)[4]) + (1.0 - k.derivative) * np.eye(size)[3]
    derivative_in = k.derivative * k.kd * error_in
    now = k.kp * error + np.eye(size)[2] + derivative
    now_in = k.kp * error_in + derivative_in + [1.0, 0.0]
    leaving = (np.eye(size)[5], np.zeros(2)) if n else (now, now_in)
    demand = (np.eye(size)[5 + n], np.zeros(2)) if n else (np.zeros(size), np.array([1.0, 0.0]))
    A[1] = np.eye(size)[1] * (1.0 - k.damping) + k.stiffness * (demand[0] - error)
    B[1] = k.stiffness * demand[1]
    A[0], B[0] = error + k.period * A[1], k.period * B[1]
    A[2], B[2] = np.eye(size)[2] + k.ki * error, k.ki * error_in
    A[3], B[3], A[4], B[4] = derivative, derivative_in, error, error_in
    for i in range(n):
        A[5 + i], B[5 + i] = (now, now_in) if i == n - 1 else (np.eye(size)[6 + i], np.zeros(2))
        A[5 + n + i], B[5 + n + i] = (np.zeros(size), np.array([1.0, 0.0])) if i == n - 1 else (np.eye(size)[6 + n + i], np.zeros(2))
    return A, B, leaving[0][None], leaving[1][None]


def closed_loop(parameters, Ad, Bd, C):
    """(A, B, C, D): demand to tilt and command, plant states before those of the servo."""
    As, Bs, Cs, Ds = servo_matrices(parameters)
    tilt = np.concatenate([C, np.zeros(len(As))])
    command = np.concatenate([Ds[0, 1] * C, Cs[0]])
    A = np.block([[Ad, np.zeros((len(Ad), len(As)))], [Bs[:, 1:] * C[None], As]])
    A[:len(Ad)] += np.outer(Bd, command)
    B = np.concatenate([Bd * Ds[0, 0], Bs[:, 0]])[:, None]
    return A, B, np.array([tilt, command]), np.array([[0.0], [Ds[0, 0]]])


def fitted_plant(frequency, response):
    """Frequency (Hz) and damping ratio of the second-order model w^2/(s^2 + 2 z w s + w^2) times a gain nearest to a response.

    Parameters
    ----------
    frequency : array_like (n,)
        Hz
    response : array_like (n,)
        Complex.

    Returns
    -------
    frequency, damping, gain : float
    """
    from scipy.optimize import least_squares

    s = 2j * np.pi * np.asarray(frequency, dtype=float)

    def off(x):
        w = 2.0 * np.pi * x[0]
        error = x[2] * w ** 2 / (s ** 2 + 2.0 * x[1] * w * s + w ** 2) - response
        return np.concatenate([error.real, error.imag])

    found = least_squares(off, [1.0, 0.8, float(np.abs(response[0]))], bounds=([1e-3, 0.05, 1e-3], [np.inf, 20.0, np.inf]))
    return tuple(float(x) for x in found.x)
