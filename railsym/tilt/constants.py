# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of a sample that follow from the parameters once; Python and C take the same."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from railsym.tilt.signals import GRAVITY

_SAME = ("share", "limit", "kp", "trim_limit", "curve_on", "curve_off", "roll_on", "roll_off", "lateral_on", "lateral_off", "slowest",
         "disagreement", "gyro_tolerance", "database_tolerance", "follow_tolerance", "ahead", "lead")
_WHOLE = ("hold", "stale", "confirm", "leave", "follow_confirm")


def constants(parameters):
    """Namespace of floats and whole numbers, named as the fields of ``rs_tilt_constants``.

    Parameters
    ----------
    parameters : TiltParameters
    """
    p, T, omega = parameters, parameters.period, 2.0 * np.pi * parameters.reference_frequency
    found = {name: float(getattr(p, name)) for name in _SAME}
    found |= {"period": T, "gravity": GRAVITY, "demand_step": p.demand_rate * T, "return_step": p.return_rate * T, "ki": p.ki * T,
              "kd": p.kd * p.rate, "derivative": T / (p.derivative_time + T), "tracking": p.tracking * T, "stiffness": omega ** 2 * T,
              "damping": 2.0 * p.reference_damping * omega * T, "blend": T / p.crossover, "washout": T / p.washout,
              "start_delay": p.filter_delay(p.gyro_cutoff) + p.sensor_delay, "extrapolation": p.curve_off / (p.curve_on - p.curve_off)}
    found = {name: float(value) for name, value in found.items()}
    found |= {name: p.samples(getattr(p, name)) for name in _WHOLE}
    found |= {"delay": p.delay, "complementary": int(p.estimator == "complementary"), "source": ("own", "leading", "database").index(p.source)}
    found |= {"lateral": p.biquad(p.lateral_cutoff), "gyro": p.biquad(p.gyro_cutoff)}
    return SimpleNamespace(**found)
