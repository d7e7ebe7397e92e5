# SPDX-License-Identifier: BSD-3-Clause
"""Means weighted by variances that are themselves estimated: the factor of the intervals against draws."""

import numpy as np
import pytest

from railsym.dampers.uncertainty import estimated_weights


@pytest.mark.parametrize(("tests", "cycles"), [(3, 11), (12, 7), (12, 21)])
def test_the_factor_is_the_variance_over_what_the_weights_say(tests, cycles):
    """Means of unit noise in each of several tests: variance of the weighted mean over the mean of 1/sum(weights).

    40,000 draws tell the ratio to 0.7 %; the formula is the first order in 1/freedom, whose square is the tolerance.
    """
    random, draws = np.random.default_rng(5), 40000
    freedom = 2.4 * (cycles - 1.0)
    means = random.standard_normal((draws, tests))
    weights = freedom / random.chisquare(freedom, (draws, tests))
    found = np.sum(weights * means, axis=1) / weights.sum(axis=1)
    ratio = np.mean(found**2) / np.mean(1.0 / weights.sum(axis=1))
    assert ratio == pytest.approx(estimated_weights(np.full(tests, cycles)), abs=0.02 + (4.0 / freedom) ** 2)
