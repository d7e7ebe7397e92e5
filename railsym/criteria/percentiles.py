# SPDX-License-Identifier: BSD-3-Clause
"""Percentiles by track section, and the estimated largest value over sections, as UIC 518 does it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.criteria.errors import CriterionError

# k of mean + k standard deviations: UIC 518 / EN 14363, one-dimensional method, recalled (R)
SAFETY, FATIGUE, QUASI_STATIC = 3.0, 2.2, 0.0


@dataclass(frozen=True, eq=False)
class SectionStatistics:
    """Percentiles of a signal in each section.

    Attributes
    ----------
    sections : ndarray (m, 2)
        Start and end, m.
    percentiles : tuple of float
        Per cent.
    values : ndarray (m, p)
        A row a section, a column a percentile.
    """

    sections: np.ndarray
    percentiles: tuple
    values: np.ndarray

    @property
    def largest(self):
        """Largest modulus of all sections and percentiles, with its sign."""
        return float(self.values.ravel()[np.argmax(np.abs(self.values))])

    @property
    def mean(self):
        """Mean over sections, ndarray (p,)."""
        return self.values.mean(axis=0)

    @property
    def deviation(self):
        """Standard deviation over sections (n - 1), ndarray (p,)."""
        self._several()
        return self.values.std(axis=0, ddof=1)

    def estimated(self, k=SAFETY):
        """Estimated largest value, mean + k deviations away from 0, ndarray (p,): k = 3 safety, 2.2 track loading, 0 quasi-static (R).

        Raises
        ------
        CriterionError
            Fewer than two sections.
        """
        return self.mean + np.where(self.mean < 0.0, -1.0, 1.0) * k * self.deviation

    def _several(self):
        if len(self.values) < 2:
            raise CriterionError("one section has no standard deviation; at least 2 are needed (25 in UIC 518), so give shorter ones or a longer run")


def percentile_analysis(distance, values, percentiles=(0.15, 99.85), sections=None):
    """Percentiles of a signal in sections of the track.

    Parameters
    ----------
    distance, values : array_like (n,)
        m, strictly increasing.
    percentiles : sequence of float
        Per cent; between two samples by linear interpolation, the nearest sample where some are infinite.
    sections : float, or sequence of (float, float), optional
        Length of the sections in m (what is left at the end belongs to none), or their starts and ends. One section if not given.

    Returns
    -------
    SectionStatistics

    Raises
    ------
    CriterionError
        A section without samples, or a length beyond the record's.
    """
    distance, values = np.asarray(distance, dtype=float), np.asarray(values, dtype=float)
    table = section_table(distance, sections)
    rows = []
    for start, end in table:
        inside = values[(distance >= start) & (distance <= end)]
        if not inside.size:
            raise CriterionError(f"section {start:g} to {end:g} m has no sample; the signal covers {distance[0]:.6g} to {distance[-1]:.6g} m")
        rows.append(_percentiles(inside, percentiles))
    return SectionStatistics(table, tuple(percentiles), np.array(rows))


def _percentiles(values, percentiles):
    # infinite values (Y/Q of a lifted wheel) cannot be interpolated
    return np.percentile(values, percentiles, method="linear" if np.isfinite(values).all() else "nearest")


def section_table(distance, sections):
    """Starts and ends (m), ndarray (m, 2), of ``sections`` as `percentile_analysis` takes them."""
    first, last = float(distance[0]), float(distance[-1])
    if sections is None:
        return np.array([[first, last]])
    if np.ndim(sections) == 0:
        length = float(sections)
        if not 0.0 < length <= (last - first) * (1 + 1e-9):
            raise CriterionError(f"sections of {length:g} m: the record covers {last - first:.4g} m; at least one section must fit")
        count = int((last - first) / length * (1 + 1e-9))
        return first + length * np.stack((np.arange(count), np.arange(1, count + 1)), axis=1)
    table = np.asarray(sections, dtype=float)
    if table.ndim != 2 or table.shape[1] != 2 or not len(table) or not (table[:, 0] < table[:, 1]).all():
        raise CriterionError("sections: pairs of start and end in m are needed, such as [(0, 250), (250, 500)]")
    return table
