/* SPDX-License-Identifier: BSD-3-Clause */
/* Carlson's symmetric integral of the second kind with its first argument zero,
 *
 *   R_D(0, y, z) = (3/2) integral from 0 to infinity of dt / [t^(1/2) (t + y)^(1/2) (t + z)^(3/2)],
 *
 * by duplication: arguments go to (x + lambda)/4 until they are alike, then a series of fifth order. Not a number where y < 0,
 * z <= 0 or one of them is no number.
 *
 * B. C. Carlson, Numerical computation of real or complex elliptic integrals, Numer. Algorithms 10 (1995) 13-26, (2.28).
 */
#include <math.h>

#include "strips.h"

enum { MOST_DUPLICATIONS = 600 }; /* each takes a factor of 4 off the arguments' distance; doubles have 2 x 308 decades */
#define ALIKE 2e-3 /* largest deviation from the mean: the series then errs by 3 ALIKE^6 */

double rs_elliptic_rd(double y, double z)
{
	double x = 0.0, sum = 0.0, power = 1.0;
	for (int k = 0; k < MOST_DUPLICATIONS; k++) {
		double mean = 0.2 * (x + y + 3.0 * z);
		double dx = 1.0 - x / mean, dy = 1.0 - y / mean, dz = -(dx + dy) / 3.0;
		if (fabs(dx) < ALIKE && fabs(dy) < ALIKE && fabs(dz) < ALIKE) {
			double ea = dx * dy, eb = dz * dz, ec = ea - eb, ed = ea - 6.0 * eb, ee = ed + ec + ec;
			double series = 1.0 + ed * (-3.0 / 14.0 + 9.0 / 88.0 * ed - 4.5 / 26.0 * dz * ee) +
			                dz * (ee / 6.0 + dz * (-9.0 / 22.0 * ec + dz * 3.0 / 26.0 * ea));
			return 3.0 * sum + power * series / (mean * sqrt(mean));
		}
		double rx = sqrt(x), ry = sqrt(y), rz = sqrt(z), lambda = rx * (ry + rz) + ry * rz;
		sum += power / (rz * (z + lambda));
		power *= 0.25;
		x = 0.25 * (x + lambda);
		y = 0.25 * (y + lambda);
		z = 0.25 * (z + lambda);
	}
	return NAN;
}
