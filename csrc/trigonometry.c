/* SPDX-License-Identifier: BSD-3-Clause */
/* Sine and cosine of many angles: Taylor's series up to 0.8 rad, where what is left out is
 * below 1e-18 (x^19/19!, x^18/18!), eight at a time; the C library beyond.
 */
#include <math.h>

#include "dispatch.h"
#include "model.h"

enum { WIDTH = 8 };

static RS_ALWAYS_INLINE void series(const double *x, double *sine, double *cosine)
{
	for (int k = 0; k < WIDTH; k++) {
		double y = x[k] * x[k];
		double s = -1.0 / 1307674368000.0 + y * (1.0 / 355687428096000.0);
		double c = -1.0 / 87178291200.0 + y * (1.0 / 20922789888000.0);
		s = 1.0 / 6227020800.0 + y * s;
		c = 1.0 / 479001600.0 + y * c;
		s = -1.0 / 39916800.0 + y * s;
		c = -1.0 / 3628800.0 + y * c;
		s = 1.0 / 362880.0 + y * s;
		c = 1.0 / 40320.0 + y * c;
		s = -1.0 / 5040.0 + y * s;
		c = -1.0 / 720.0 + y * c;
		s = 1.0 / 120.0 + y * s;
		c = 1.0 / 24.0 + y * c;
		s = -1.0 / 6.0 + y * s;
		sine[k] = x[k] + x[k] * y * s;
		cosine[k] = 1.0 + y * (-0.5 + y * c);
	}
}

RS_CLONES
void rs_model_trigonometry(rs_model *model)
{
	int n = model->coordinates;
	double *q = model->state, *sines = q + 3 * n, *cosines = q + 4 * n;
	for (int first = 0; first < model->angles; first += WIDTH) {
		double x[WIDTH] = {0.0}, sine[WIDTH], cosine[WIDTH];
		int count = model->angles - first < WIDTH ? model->angles - first : WIDTH, small = 1;
		const int *angle = model->angle + first;
		for (int k = 0; k < count; k++) {
			x[k] = q[angle[k]];
			small &= fabs(x[k]) <= 0.8;
		}
		series(x, sine, cosine);
		for (int k = 0; k < count; k++) {
			sines[angle[k]] = small ? sine[k] : sin(x[k]);
			cosines[angle[k]] = small ? cosine[k] : cos(x[k]);
		}
	}
}
