# SPDX-License-Identifier: BSD-3-Clause
"""An analysis that logs what it computes, and fails, dies or dawdles when told to: for tests of studies."""

import os
import signal
import time
from dataclasses import dataclass
from pathlib import Path

from railsym.sweep import Analysis, CriticalSpeed, Input, Output


@dataclass(frozen=True)
class Logged(Analysis):
    """y = x^2, with one line of a log for every case begun.

    ``fail``, ``die``, ``die_once``: values of x that raise, that end their process, and that end it the first time only.
    """

    log: str = ""
    seconds: float = 0.0
    fail: tuple = ()
    die: tuple = ()
    die_once: tuple = ()
    kind = "logged"

    def inputs(self, vehicle):
        return {"x": Input("-", 0.0)}

    def outputs(self, vehicle):
        return {"y": Output("-", "square of x"), "word": Output("", "x in words", True)}

    def solver(self, vehicle):
        def solve(case):
            x = case.settings["x"]
            before = numbers(self.log).count(x) if self.die_once else 0
            with open(self.log, "ab", buffering=0) as log:
                log.write(f"{x!r}\n".encode())
            if x in self.die or (x in self.die_once and not before):
                os.kill(os.getpid(), signal.SIGKILL)
            if x in self.fail:
                raise ValueError(f"x = {x:g} will not do")
            time.sleep(self.seconds)
            return {"y": x * x, "word": f"x is {x:g}"}

        return solve


@dataclass(frozen=True)
class LoggedSpeed(CriticalSpeed):
    """A critical speed, with the conicity of every case begun in a log."""

    log: str = ""
    kind = "logged_speed"

    def solver(self, vehicle):
        solve = super().solver(vehicle)

        def logging(case):
            with open(self.log, "ab", buffering=0) as log:
                log.write(f"{case.settings['contact.conicity']!r}\n".encode())
            return solve(case)

        return logging


def numbers(log):
    """What a log holds, in the order of writing."""
    path = Path(log)
    return [float(line) for line in path.read_text().split()] if path.exists() else []
