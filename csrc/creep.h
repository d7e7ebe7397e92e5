/* SPDX-License-Identifier: BSD-3-Clause */
/* Creep force laws on eight contacts at once.
 *
 * Every law here is one function h of three dimensionless numbers,
 *
 *   u1 = w G a b C11 xi/(mu N)    u2 = w G a b C22 eta/(mu N)    u3 = w G (a b)^(3/2) C23 phi/(mu N)
 *   Fx = mu N h0(u)    Fy = mu N h1(u)    Mz = mu N sqrt(a b) h2(u)
 *
 * the forces of Kalker's linear theory over mu N, so that a law gives h and dh/du only, and
 * load, friction and Kalker weight w follow by the chain rule (creep/creep.c). Signs: forces
 * on the wheel, creepages of the wheel against the rail, moment and spin about the normal
 * that points into the rail, x in the direction of rolling.
 *
 * A law (rs_creep_law)
 *   Given     in      one lane a quantity, all dimensionless
 *             slopes  0: only h is wanted
 *   Returned  out     h, and where slopes is not 0 d[i][j] = dh_i/du_j
 *   Notes     No allocation, no state. Any finite u; |u| up to about 1e9 keeps its precision.
 */
#ifndef RS_CREEP_H
#define RS_CREEP_H

#include "lanes.h"

typedef struct {
	rs_lane u[3];
	rs_lane c11, c22, c23, c33;  /* Kalker's coefficients */
	rs_lane root;                /* sqrt(a/b) */
	rs_lane adhesion, slip;      /* Polach's reduction factors kA, kS */
	int strips, cells;           /* grid: strips across, cells along a strip */
	const rs_creep_table *table; /* of the law that needs one */
} rs_creep_input;

typedef struct {
	rs_lane h[3];
	rs_lane d[3][3];
} rs_creep_value;

typedef void rs_creep_law(const rs_creep_input *in, int slopes, rs_creep_value *out);

rs_creep_law rs_creep_kalker_linear;
rs_creep_law rs_creep_shen_hedrick_elkins;
rs_creep_law rs_creep_polach;
rs_creep_law rs_creep_fastsim;
rs_creep_law rs_creep_fastrip;
rs_creep_law rs_creep_exact_table;

/* The law of a number RS_CREEP_..., NULL where there is none. */
rs_creep_law *rs_creep_law_at(int law);

/* For each of the eight contacts; l is its number. */
#define RS_EACH(l) for (int l = 0; l < RS_LANES; l++)
#define RS_AT(x, l) (((double *)&(x))[l])
#define RS_OF(x, l) (((const double *)&(x))[l])

/* Parts of a law: inlined, so that they are compiled for the processor their caller is compiled for. */
#if defined(__GNUC__)
#define RS_INLINE static inline __attribute__((always_inline))
#else
#define RS_INLINE static inline
#endif

#define RS_PI 3.14159265358979323846

#endif
