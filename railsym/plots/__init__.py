# SPDX-License-Identifier: BSD-3-Clause
"""Drawings of results. Functions take result objects, only draw, and return Matplotlib axes; Matplotlib is imported when one
is called. Speeds are shown in km/h, frequencies in Hz, damping ratios in per cent."""

from railsym.plots.damper_map import plot_damper_map
from railsym.plots.dampers import plot_damper
from railsym.plots.eigenvalues import plot_damping, plot_eigenvalues, plot_root_locus
from railsym.plots.mode_shape import plot_mode_shape
from railsym.plots.optimisation import plot_optimisation, plot_pareto
from railsym.plots.profile_pair import plot_profile_pair
from railsym.plots.runs import plot_run, plot_spectrum
from railsym.plots.sensitivities import plot_parameter_map, plot_sensitivities
from railsym.plots.stability_curves import (plot_change, plot_critical_speed, plot_frequency, plot_stability_map,
                                            plot_stability_report)
from railsym.plots.study import plot_parallel, plot_scatter, plot_study_map
from railsym.plots.switch import plot_quasi_linear, plot_switch_study
from railsym.plots.tilt_linkage import plot_tilt_linkage
from railsym.plots.track import plot_track
from railsym.plots.uncertainty import plot_convergence, plot_probability, plot_sobol, plot_tornado

__all__ = ["plot_change", "plot_convergence", "plot_critical_speed", "plot_damper", "plot_damper_map", "plot_damping", "plot_eigenvalues",
           "plot_frequency", "plot_mode_shape", "plot_optimisation", "plot_parallel", "plot_parameter_map", "plot_pareto",
           "plot_probability", "plot_profile_pair", "plot_quasi_linear", "plot_root_locus", "plot_run", "plot_scatter",
           "plot_sensitivities", "plot_sobol", "plot_spectrum", "plot_stability_map", "plot_stability_report", "plot_study_map",
           "plot_switch_study", "plot_tilt_linkage", "plot_tornado", "plot_track"]
