/* SPDX-License-Identifier: BSD-3-Clause */
/* Elastic contact of a patch that is cut into strips along the track (strips.c). */
#ifndef RS_STRIPS_H
#define RS_STRIPS_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "../dispatch.h"

enum { RS_STRIPS = 16 };
enum { RS_INFLUENCE_BELOW = 14, RS_INFLUENCE_ABOVE = 12, RS_INFLUENCE_PARTS = 16,
       RS_INFLUENCE_SIZE = (RS_INFLUENCE_BELOW + RS_INFLUENCE_ABOVE) * RS_INFLUENCE_PARTS };

/* H(v) of influence.c on octaves from 2^-BELOW to 2^ABOVE. */
typedef struct {
	double lowest, highest, first_slope;
	double c[RS_INFLUENCE_SIZE][8];      /* four of H, three of H'/2 */
} rs_influence;

void rs_influence_make(rs_influence *table);

/* H(v), and v H'(v)/2. A piece is found by the bits of v: no logarithm. */
static RS_ALWAYS_INLINE double rs_influence_at(const rs_influence *table, double v, double *half_slope)
{
	const int bits_of_part = 4, lowest = 1023 - RS_INFLUENCE_BELOW; /* biased exponent of the first octave */
	double size = fabs(v), t;
	if (size < table->lowest) {
		*half_slope = 0.5 * v * table->first_slope;
		return v * table->first_slope;
	}
	if (!(size < table->highest)) { /* H' = pi/(2 v) */
		const double *c = table->c[RS_INFLUENCE_SIZE - 1], half_pi = 1.57079632679489661923;
		*half_slope = copysign(0.5 * half_pi, v);
		return copysign(c[0] + c[1] + c[2] + c[3] + half_pi * log(size / table->highest), v);
	}
	uint64_t bits;
	memcpy(&bits, &size, sizeof bits);
	const double *c = table->c[(int)(bits >> (52 - bits_of_part)) - (lowest << bits_of_part)];
	bits = bits << (12 + bits_of_part) >> 12 | (uint64_t)1023 << 52;
	memcpy(&t, &bits, sizeof t);
	t -= 1.0;
	*half_slope = v * (c[4] + t * (c[5] + t * c[6]));
	return copysign(c[0] + t * (c[1] + t * (c[2] + t * c[3])), v);
}

/* Carlson's R_D(0, y, z), y >= 0, z > 0 (elliptic.c). */
double rs_elliptic_rd(double y, double z);

/* Given: u, s, width, curvature, modulus, and a as a guess. Returned: a and gradient. */
typedef struct {
	double s[RS_STRIPS];   /* m, place of each strip across the track, along the surface */
	double u[RS_STRIPS];   /* m, by how much the surfaces would overlap there; contact is where u > 0 or less */
	double a[RS_STRIPS];   /* m, half length of each strip, 0 where there is no contact */
	int together;          /* 1: the strips lie side by side, in one run */
	double width;          /* m, of every strip */
	double curvature;      /* 1/m, A: the gap along the track is A x^2 */
	double modulus;        /* N/m^2, contact modulus E' */
	double gradient;       /* N/m^3, returned: peak pressure over half length */
} rs_strip_patch;

/* RS_OK, RS_NOT_CONVERGED. */
int rs_strip_contact(const rs_influence *table, rs_strip_patch *patch);

#endif
