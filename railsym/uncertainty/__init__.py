# SPDX-License-Identifier: BSD-3-Clause
"""What tolerances of parameters do to a result: tornado charts, Sobol indices, probabilities, first-order reliability.

    model = rs.uncertainty.SpeedModel(vehicle, list(tolerances), conicity=0.2)
    print(rs.uncertainty.tornado(model, tolerances))
    print(rs.uncertainty.form(model, tolerances, limit=70.0))

Tolerances are distributions by dotted name: anything with SciPy's ``ppf``, such as `railsym.sweep.Normal` or ``scipy.stats.norm(...)``.
"""

from railsym.lazy import lazy

_MODULE_OF = {
    "Form": "form",
    "Probability": "probability",
    "Sobol": "sobol",
    "SpeedModel": "speed_model",
    "Tolerances": "tolerances",
    "Tornado": "tornado",
    "UncertaintyError": "errors",
    "form": "form",
    "probability_below": "probability",
    "saltelli": "sobol",
    "sobol_indices": "sobol",
    "tornado": "tornado",
}

__getattr__, __dir__, __all__ = lazy(__name__, _MODULE_OF)
