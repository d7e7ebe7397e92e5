/* SPDX-License-Identifier: BSD-3-Clause */
/* Sine and cosine by Taylor's series up to RS_SMALL_ANGLE, where what is left out is below 1e-18 (x^19/19!, x^18/18!); arcsine and
 * arctangent likewise up to RS_SMALL_RATIO (below 1e-17 of the angle). No branches: loops over them become vectors.
 */
#ifndef RS_TRIGONOMETRY_H
#define RS_TRIGONOMETRY_H

#include <math.h>

#include "dispatch.h"

#define RS_SMALL_ANGLE 0.8
#define RS_SMALL_RATIO 0.05

static RS_ALWAYS_INLINE void rs_sine_cosine_series(double x, double *sine, double *cosine)
{
	double y = x * x;
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
	*sine = x + x * y * s;
	*cosine = 1.0 + y * (-0.5 + y * c);
}

static RS_ALWAYS_INLINE void rs_sine_cosine(double x, double *sine, double *cosine)
{
	if (fabs(x) <= RS_SMALL_ANGLE) {
		rs_sine_cosine_series(x, sine, cosine);
		return;
	}
	*sine = sin(x);
	*cosine = cos(x);
}

static RS_ALWAYS_INLINE double rs_arcsine_series(double x)
{
	double y = x * x;
	return x + x * y * (1.0 / 6.0 + y * (3.0 / 40.0 + y * (15.0 / 336.0 + y * (105.0 / 3456.0 + y * (945.0 / 42240.0)))));
}

/* Angle of (1, t). */
static RS_ALWAYS_INLINE double rs_arctangent_series(double t)
{
	double s = t * t;
	return t + t * s * (-1.0 / 3.0 + s * (1.0 / 5.0 + s * (-1.0 / 7.0 + s * (1.0 / 9.0 + s * (-1.0 / 11.0)))));
}

#endif
