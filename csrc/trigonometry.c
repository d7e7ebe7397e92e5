/* SPDX-License-Identifier: BSD-3-Clause */
/* Sine and cosine of many angles: a series (trigonometry.h) eight at a time, the C library for large ones. */
#include <math.h>

#include "dispatch.h"
#include "model.h"
#include "trigonometry.h"

enum { WIDTH = 8 };

RS_CLONES
void rs_model_trigonometry(rs_model *model)
{
	int n = model->stride;
	double *q = model->state, *sines = q + 3 * n, *cosines = q + 4 * n;
	for (int first = 0; first < model->angles; first += WIDTH) {
		double x[WIDTH] = {0.0}, sine[WIDTH], cosine[WIDTH];
		int count = model->angles - first < WIDTH ? model->angles - first : WIDTH, small = 1;
		const int *angle = model->angle + first;
		for (int k = 0; k < count; k++) {
			x[k] = q[angle[k]];
			small &= fabs(x[k]) <= RS_SMALL_ANGLE;
		}
		for (int k = 0; k < WIDTH; k++)
			rs_sine_cosine_series(x[k], sine + k, cosine + k);
		for (int k = 0; k < count; k++) {
			sines[angle[k]] = small ? sine[k] : sin(x[k]);
			cosines[angle[k]] = small ? cosine[k] : cos(x[k]);
		}
	}
}
