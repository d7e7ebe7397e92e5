# SPDX-License-Identifier: BSD-3-Clause
"""Runs in time: Python drives blocks of steps, C takes them.

docs/simulation.md says what is computed and how far to trust it.
"""

from __future__ import annotations

from contextlib import nullcontext

import numpy as np

from railsym._core_integrator import STOPPED
from railsym.errors import ControllerError, SimulationError
from railsym.results import ChannelWriter, ResultFileError, Run
from railsym.results.metadata import Ending, RunInfo
from railsym.simulation.assembled import Assembled
from railsym.simulation.channels import Recorder, catalogue, chosen
from railsym.simulation.controls import Controls
from railsym.simulation.failure import ending_of
from railsym.simulation.speed import SpeedProfile

RHO = 0.9          # of the generalised-alpha scheme: what is left in a step of a motion much faster than it
TOLERANCE = 1e-2   # m/s^2: on irregular track a fifth or less of what a step of 1 ms leaves wrong, a third for Q (docs/simulation.md)
_BLOCK = 0.5       # s of motion between two looks at the keyboard and the progress bar
_ENOUGH = 500      # samples that wait before channels are made of them (and written)


class Simulation:
    """A vehicle in motion, stepped as far as wanted.

    Parameters
    ----------
    vehicle : Vehicle
    speed : float, sequence of (time, speed), or SpeedProfile
        m/s (and s).
    track : railsym.Track, optional
        Straight and level without it.
    contact : LinearContact, contact table, ConicalContact or WheelRail, optional
        ``LinearContact()`` by default; None: no wheel touches a rail.
    dt : float
        s
    start : float, optional
        m, arc length of the vehicle's centre at t = 0. Without it the foremost body stands at s = 0: behind it the track goes on
        as it begins, without irregularities.
    commands : dict of str to float, optional
        Commands of actuators from the start, m or N, as `Controls.command` sets them; actuators with a lag begin at them.
    faults : sequence of (float, str, str)
        Actuators that fail: time (s, to the nearest step), element, and kind as `Controls.fault` has them.
    initial : dict of str to float, or (q, u), optional
        ``{"wheelset1.y": 3e-3, "car.y.rate": 0.1}``, SI; the rest of the vehicle rolls at its design position.
    channels : str or sequence of str, optional
        Names and patterns, ``"all"`` for everything; see `available`.
    rate : float, optional
        Samples in a second, Hz; as close as a whole number of steps comes. 200 Hz without it.
    markers : dict of str to (str, array (3,)), optional
        Further points whose accelerations can be recorded: body, position in vehicle coordinates (m).
    rho, tolerance : float
        Spectral radius at infinite frequency; m/s^2 that an iteration may leave wrong (a thousandth of the largest acceleration if less).
    drive : str
        ``"held"``: the heaviest body is held softly (0.1 Hz, critically damped on the mass of the vehicle) to its place along
        the track, which supplies traction and stands for the drive that keeps the speed. ``"free"``: the vehicle rolls.
    forces : dict
        Arguments of `railsym.wheel_rail.WheelRail`: law, grid, friction, ...

    Attributes
    ----------
    parts : Assembled
    recorder : Recorder
    ending : Ending
    """

    def __init__(self, vehicle, *, speed, track=None, contact="linear", dt=1e-3, start=None, initial=None, channels=None, rate=None,
                 markers=None, rho=RHO, tolerance=TOLERANCE, drive="held", commands=None, faults=(), **forces):
        from railsym.contact import LinearContact

        _check_numbers(dt=dt, rho=rho, tolerance=tolerance)
        foremost = max((body.position[0] for body in vehicle.bodies), default=0.0)
        profile = SpeedProfile.of(speed, -foremost if start is None else start)
        contact = LinearContact() if isinstance(contact, str) and contact == "linear" else contact
        self.parts = Assembled(vehicle, contact, track, profile, dt, rho, tolerance, drive, forces)
        self.available = catalogue(self.parts, markers or {})
        self.recorder = Recorder(chosen(self.available, channels))
        self.every, self.faults = _steps_between(dt, rate), []
        self.dt, self.ending = float(dt), Ending("running")
        integrator = self.parts.integrator
        integrator.set_channels(self.recorder.raw)
        q, u = self.parts.start(initial)
        self._command(commands or {}, q)
        self._planned = _planned(faults, dt, Controls(self))
        status = integrator.start(0.0, q, u)
        row, sampled = integrator.sample()
        if status or sampled:
            self.ending = ending_of(self.parts, status or sampled)
            raise SimulationError(f"the run cannot begin: {self.ending}")
        self._times, self._values, self._waiting = [np.zeros(1)], [self.recorder.values(np.zeros(1), row[None])], []
        self._waiting_samples = 0
        self._file = None  # the run's file, where samples are not kept in memory

    def _command(self, commands, q):
        """Set commands of actuators, dict of m or N, and in the coordinates q (n,) the states of those that have followed them."""
        controls, internal = Controls(self), self.parts.model.topology.internal
        for element, value in commands.items():
            controls.command(element, value)
            if element in internal:
                q[internal[element]] = value

    @property
    def time(self):
        """s, of the present state."""
        return self.parts.integrator.report.time

    def steps(self, count):
        """Take ``count`` steps in C; returns times and values of the samples on the way, or fewer with `ending` set."""
        self._advance(count)
        return self._keep()

    def _advance(self, count):
        """Take ``count`` steps in C; samples wait as they are."""
        integrator = self.parts.integrator
        done = integrator.report.steps
        rows = (done + count) // self.every - done // self.every
        samples = np.empty((rows, len(self.recorder.raw)))
        status = 0
        try:
            status, _ = integrator.run(count, self.every, samples)
        finally:  # Ctrl-C while C was at work shows when it has come back: what it sampled is kept
            sampled = integrator.report.steps // self.every - done // self.every
            times = (done // self.every + 1 + np.arange(sampled)) * self.every * self.dt
            self._waiting.append((times, samples[:sampled]))
            self._waiting_samples += sampled
        if status:
            self.ending = ending_of(self.parts, status)
            if status == STOPPED and integrator.why is not None and (error := integrator.why()) is not None:
                raise error

    def _keep(self):
        """Channels of the samples that wait; returns their times and values."""
        waiting, self._waiting, self._waiting_samples = self._waiting, [], 0
        times, samples = (np.concatenate(part) for part in zip(*waiting, strict=True))
        values = self.recorder.values(times, samples)
        if self._file is None:
            self._times.append(times)
            self._values.append(values)
        return times, values

    def run(self, duration, *, controllers=(), progress=False, writer=None, keep="memory"):
        """Go on for ``duration`` (s); Ctrl-C ends the run with what there is.

        Parameters
        ----------
        duration : float
        controllers : sequence of (callable, float)
            Each is called with a `Controls` before the step at its rate (Hz).
        progress : bool
            A bar on the error stream.
        writer : ChannelWriter, optional
            Gets the samples as they come.
        keep : {"memory", "file"}
            ``"file"``: samples go to the writer and are forgotten, so that memory does not grow; from then on `result` reads the
            writer's file, once it is finished.

        Raises
        ------
        ControllerError
            A controller whose answer makes no sense, with the run until then.
        """
        self._keep_in(keep, writer)
        total = self._check_duration(duration)
        first = self.parts.integrator.report.steps
        calls = [(function, _period(rate, self.dt)) for function, rate in controllers]
        block = max(1, round(_BLOCK / self.dt))
        controls = Controls(self)
        self.ending = Ending("running")
        try:
            with _bar(total, self.dt, progress) as bar:
                while self.ending.reason == "running" and (left := first + total - self.parts.integrator.report.steps) > 0:
                    done = self.parts.integrator.report.steps
                    self._fail(controls, done)
                    for function, period in calls:
                        if done % period == 0:
                            function(controls)
                            self.parts.integrator.follow()
                    count = min(left, block, *(period - done % period for _, period in calls), *(step - done for step, _, _ in self._planned[:1]))
                    self._advance(count)
                    if self._waiting_samples >= _ENOUGH:
                        self._hand_over(writer)
                    bar.update(count)
        except KeyboardInterrupt:
            self.ending = Ending("interrupted", time=self.time, distance=float(self.parts.speed.place(self.time)))
        except ControllerError as error:
            self.ending = Ending("interrupted", time=self.time, distance=float(self.parts.speed.place(self.time)), detail=str(error))
            self._hand_over(writer)
            if self._file is not None:
                writer.info = self.info
                writer.finish(self.ending)
            error.run = self.result()
            raise
        self._hand_over(writer)
        if self.ending.reason == "running":
            self.ending = Ending("completed", time=self.time, distance=float(self.parts.speed.place(self.time)))

    def _keep_in(self, keep, writer):
        if keep not in ("memory", "file"):
            raise SimulationError(f"keep = {keep!r}: samples are kept in 'memory', or in the 'file' only")
        if keep == "file" and writer is None:
            raise SimulationError("keep = 'file' needs the file: simulate(..., save=\"run.nc\"), or run(..., writer=ChannelWriter(...))")
        if keep == "memory" and self._file is not None:
            raise SimulationError(f"the samples before are in {self._file} only: go on with keep=\"file\" and the same writer")
        if keep == "file":
            self._file = writer.path

    def _fail(self, controls, done):
        """Let actuators fail whose time has come."""
        while self._planned and self._planned[0][0] <= done:
            _, element, kind = self._planned.pop(0)
            controls.fault(element, kind)

    def _hand_over(self, writer):
        """Make channels of what waits, and write them."""
        if self._waiting:
            times, values = self._keep()
            if writer is None or not len(times):
                return
            try:
                writer.write(times, values)
            except ResultFileError as error:
                if self._file is None:  # the disk is full: what was computed goes with the error
                    self.ending = Ending("interrupted", time=self.time, distance=float(self.parts.speed.place(self.time)), detail=str(error))
                    error.run = self.result()
                raise

    def _check_duration(self, duration):
        if not 0.0 < duration < np.inf:
            raise SimulationError(f"duration {duration} s: a finite time above 0 s is needed")
        total = round(duration / self.dt)
        if total < 1:
            raise SimulationError(f"duration {duration} s is shorter than half a step of {self.dt} s")
        end = self.time + total * self.dt
        self.parts.check_track(end)
        self.parts.integrator.set_kinks(self.parts.kinks(end + self.dt))
        return total

    @property
    def info(self):
        """`RunInfo` of what was run so far."""
        parts, report = self.parts, self.parts.integrator.report
        counts = {name: int(getattr(report, name)) for name in ("steps", "residuals", "pencils", "wheel_factors", "solves")}
        law = getattr(parts.wheels, "_law", "linear")
        return RunInfo(vehicle=parts.vehicle.name, configuration=parts.vehicle.configuration or "", track=getattr(parts.track, "name", "straight"),
                       speed=float(parts.speed.at(0.0)), time_step=self.dt, creep_law=law, ending=self.ending,
                       message=str(self.ending), extra={"counts": counts, **parts.static_loads()} | ({"faults": self.faults} if self.faults else {}))

    def result(self):
        """The `Run` so far; of a run that is kept in its file, a `railsym.results.FileRun` once the writer is finished."""
        if self._file is not None:
            return Run.from_netcdf(self._file, lazy=True)
        return Run(np.concatenate(self._times), np.concatenate(self._values), self.recorder.channels, self.info)


def simulate(vehicle, *, speed, duration, controllers=(), progress=False, save=None, keep="memory", **options):
    """Simulate a vehicle in motion.

    Parameters
    ----------
    vehicle : Vehicle
    speed, options
        As `Simulation`.
    duration : float
        s
    controllers : sequence of (callable, float)
        Each is called with a `Controls` at its rate (Hz) and may set commands of actuators and applied forces.
    progress : bool
    save : str or Path, optional
        netCDF file that the samples are written to as they come, so that nothing is lost when the program ends.
    keep : {"memory", "file"}
        ``"file"``: samples are in the file ``save`` only and memory does not grow with the length of the run; the result reads each
        channel from the file when it is asked for (`railsym.results.FileRun`).

    Returns
    -------
    railsym.Run
        Also when the run stopped early: ``run.status`` and ``run.message`` say why, where and what to do.

    Raises
    ------
    SimulationError
        What cannot be started as asked.
    railsym.results.ResultFileError
        A file that cannot be written on, a full disk say: what it holds can be read, and ``error.run`` is the `Run` until then (not with
        ``keep="file"``).
    """
    simulation = Simulation(vehicle, speed=speed, **options)
    if keep == "file" and save is None:
        raise SimulationError('keep = "file" needs the file: save="run.nc"')
    channels = simulation.recorder.channels
    with ChannelWriter(save, channels, simulation.info) if save is not None else nullcontext() as writer:
        if writer is not None:
            writer.write(simulation._times[0], simulation._values[0])
        simulation.run(duration, controllers=controllers, progress=progress, writer=writer, keep=keep)
        if writer is not None:
            writer.info = simulation.info  # with what happened on the way
            writer.finish(simulation.ending, str(simulation.ending))
    return simulation.result()


def _planned(faults, dt, controls):
    """Faults as (step, element, kind), the first one first."""
    planned = []
    for time, element, kind in faults:
        if not 0.0 <= time < np.inf:
            raise SimulationError(f"fault of {element!r} at {time} s: a time from 0 s on is needed")
        controls.check_fault(element, kind)
        planned.append((round(time / dt), element, kind))
    return sorted(planned, key=lambda fault: fault[0])


def _check_numbers(dt, rho, tolerance):
    for name, value, good, words in (("dt", dt, 0.0 < dt < np.inf, "above 0 s"), ("rho", rho, 0.0 <= rho <= 1.0, "from 0 to 1"),
                                     ("tolerance", tolerance, 0.0 < tolerance < np.inf, "above 0 m/s^2")):
        if not good:
            raise SimulationError(f"{name} = {value!r}: a number {words} is needed")


def _steps_between(dt, rate):
    if rate is None:
        return max(1, round(1.0 / (200.0 * dt)))
    if not 0.0 < rate <= 1.0000001 / dt:
        raise SimulationError(f"rate {rate!r} Hz: samples are taken at the ends of steps, so between 0 and {1.0 / dt:g} Hz for dt = {dt:g} s")
    return max(1, round(1.0 / (rate * dt)))


def _period(rate, dt):
    if not 0.0 < rate <= 1.0000001 / dt:
        raise SimulationError(f"controller rate {rate!r} Hz: between 0 and {1.0 / dt:g} Hz for dt = {dt:g} s")
    return max(1, round(1.0 / (rate * dt)))


class _NoBar:
    def __enter__(self):
        return self

    def __exit__(self, *_):
        return False

    def update(self, _):
        """Nothing is shown."""


def _bar(steps, dt, show):
    if not show:
        return _NoBar()
    from tqdm import tqdm

    form = "{desc}: {percentage:3.0f}%|{bar}| [{elapsed}<{remaining}]"
    return tqdm(total=steps, desc=f"simulating {steps * dt:g} s", bar_format=form)
