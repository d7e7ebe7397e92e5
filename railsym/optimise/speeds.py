# SPDX-License-Identifier: BSD-3-Clause
"""Critical speeds of a design, at one or several conicities, with analytic gradients of speed and frequency."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from railsym.optimise.errors import OptimisationError


class SpeedDesign:
    """``evaluate`` of a `Problem`: critical speed and frequency with their gradients.

    Parameters
    ----------
    vehicle : Vehicle
        With its configuration applied.
    names : sequence of str
        Dotted names, in the order of the values.
    conicity : float or sequence of float, optional
        That of `contact` when not given.
    options
        criterion, damping_ratio, speed_range, contact, frequency_band of `railsym.critical_speed`.

    Notes
    -----
    Outputs are ``speed`` (m/s) and ``frequency_hz``; with several conicities ``speed(0.1)``, ``frequency_hz(0.1)``, ... A vehicle that stays stable
    over the whole range of speeds has its upper end as ``speed``, no gradient there, and ``beyond_range`` = 1 (0 otherwise): the speed is at least
    that. One that is unstable at the lower end already has no result.
    """

    def __init__(self, vehicle, names: Sequence[str], conicity=None, **options):
        from railsym.uncertainty.speed_model import SpeedModel

        several = conicity is not None and np.ndim(conicity) > 0
        self.models = {f"{{}}({c:g})" if several else "{}": SpeedModel(vehicle, names, conicity=c, **options)
                       for c in (conicity if several else [conicity])}

    @classmethod
    def of(cls, models):
        """From models by prefix of their outputs: ``{"low.": SpeedModel(...)}``."""
        made = cls.__new__(cls)
        made.models = {prefix + "{}": model for prefix, model in models.items()}
        return made

    def __call__(self, x):
        """Outputs at x (SI).

        Raises
        ------
        OptimisationError
            Unstable at the lowest speed already.
        """
        return self._outputs(x, False)[0]

    def with_gradient(self, x):
        """Outputs, and gradients (k,) of the speeds and frequencies.

        Raises
        ------
        OptimisationError
            As `__call__`.
        """
        return self._outputs(x, True)

    def _outputs(self, x, with_gradient):
        outputs, slopes, beyond = {}, {}, 0.0
        for form, model in self.models.items():
            speed, frequency = form.format("speed"), form.format("frequency_hz")
            found = model.stability(x)
            if found.unstable_at_start:
                raise OptimisationError(f"{speed}: unstable at {model.speed_range[0]:g} m/s already: {found.message}")
            if found.speed is None:
                beyond, outputs[speed] = 1.0, float(model.speed_range[1])
                slopes[speed] = np.zeros(len(x))
                continue
            outputs |= {speed: found.speed, frequency: found.frequency_hz}
            if with_gradient:
                slopes |= dict(zip((speed, frequency), model.slopes(found, x)))
        return outputs | {"beyond_range": beyond}, slopes
