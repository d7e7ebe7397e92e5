/* SPDX-License-Identifier: BSD-3-Clause */
/* Deflection beside a strip of elliptic pressure, integrated across the strip:
 *
 *   G(v) = integral from -1 to 1 of sqrt(1 - t^2)/sqrt(t^2 + v^2) dt = 2 sqrt(1 + v^2) [K(m) - E(m)],  m = 1/(1 + v^2)
 *   H(v) = integral of G from 0 to v,  odd,  2 v ln(4/v) for small v
 *
 * A strip of half length a and width w under p0 sqrt(1 - x^2/a^2) bends the half-space at (0, d) from its
 * middle by p0 a/(pi E') [H((d + w/2)/a) - H((d - w/2)/a)] (Boussinesq; K. L. Johnson, Contact Mechanics, 1985, 3.19).
 *
 * H is kept as cubics on PARTS intervals of every octave, with half its slope; rs_influence_at reads them.
 */
#include <math.h>

#include "strips.h"

#define HALF_PI 1.57079632679489661923

/* K(m) - E(m) for m = 1 - c^2 by the arithmetic-geometric mean: K = pi/(2 M), E = K [1 - sum 2^(n-1) c_n^2]. */
static double difference_of_integrals(double m)
{
	double a = 1.0, g = sqrt(1.0 - m), sum = 0.5 * m, weight = 0.5;
	for (int n = 0; n < 12 && fabs(a - g) > 1e-16 * a; n++) {
		double c = 0.5 * (a - g), mean = 0.5 * (a + g);
		g = sqrt(a * g);
		a = mean;
		weight *= 2.0;
		sum += weight * c * c;
	}
	return HALF_PI / a * sum;
}

static double slope(double v)
{
	return 2.0 * sqrt(1.0 + v * v) * difference_of_integrals(1.0 / (1.0 + v * v));
}

/* Integral of G over [v, v + h] by Gauss's rule of three points. */
static double increment(double v, double h)
{
	double middle = v + 0.5 * h, away = 0.5 * h * sqrt(0.6);
	return h / 18.0 * (5.0 * slope(middle - away) + 8.0 * slope(middle) + 5.0 * slope(middle + away));
}

static double place(int k)
{
	return ldexp(1.0 + (k % RS_INFLUENCE_PARTS) / (double)RS_INFLUENCE_PARTS, k / RS_INFLUENCE_PARTS - RS_INFLUENCE_BELOW);
}

void rs_influence_make(rs_influence *table)
{
	double v = place(0), value = 2.0 * v * log(4.0 / v) - 0.125 * v * v * v, g0 = slope(v);
	table->lowest = v;
	table->first_slope = value / v;
	for (int k = 0; k < RS_INFLUENCE_SIZE; k++) {
		double next = place(k + 1), h = next - v, g1 = slope(next), rise = increment(v, h);
		double *c = table->c[k];
		c[0] = value;
		c[1] = h * g0;
		c[2] = 3.0 * rise - h * (2.0 * g0 + g1);
		c[3] = h * (g0 + g1) - 2.0 * rise;
		for (int n = 1; n < 4; n++)
			c[3 + n] = 0.5 * n * c[n] / h;
		v = next;
		g0 = g1;
		value += rise;
	}
	table->highest = v;
}
