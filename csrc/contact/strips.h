/* SPDX-License-Identifier: BSD-3-Clause */
/* Elastic contact of a patch that is cut into strips along the track (strips.c). */
#ifndef RS_STRIPS_H
#define RS_STRIPS_H

enum { RS_STRIPS = 16 };
enum { RS_INFLUENCE_BELOW = 8, RS_INFLUENCE_ABOVE = 12, RS_INFLUENCE_PARTS = 16,
       RS_INFLUENCE_SIZE = (RS_INFLUENCE_BELOW + RS_INFLUENCE_ABOVE) * RS_INFLUENCE_PARTS };

/* H(v) of influence.c on octaves from 2^-BELOW to 2^ABOVE. */
typedef struct {
	double lowest, highest, first_slope;
	double c[RS_INFLUENCE_SIZE][4];
} rs_influence;

void rs_influence_make(rs_influence *table);
double rs_influence_at(const rs_influence *table, double v);

/* Carlson's R_D(0, y, z), y >= 0, z > 0 (elliptic.c). */
double rs_elliptic_rd(double y, double z);

/* Given: u, s, width, curvature, modulus, and a as a guess. Returned: a and pressure. */
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
