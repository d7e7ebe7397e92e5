/* SPDX-License-Identifier: BSD-3-Clause */
/* Creep forces of eight patches and their slopes, the ellipse included.
 *
 *   F_i = mu N A_i h_i(u, k)    A = (1, 1, sqrt(a b))    u_j = w G (a b)^m_j C_j(k) c_j/(mu N)    m = (1, 1, 3/2)    k = ln(a/b)
 *
 * so that, over the logarithms l = ln(a b) and k,
 *   dF_i/dN = mu A_i (h_i - u dh_i/du)
 *   dF_i/dl = mu N A_i sum_j m_j u_j dh_i/du_j, for Mz + F_i/2
 *   dF_i/dk = mu N A_i [sum_j u_j dh_i/du_j dlnC_j/dk + dh_i/dk]
 * A law knows dh/du only; dh/dk, how h depends on the shape of the ellipse by itself, is a quotient of differences.
 */
#include <math.h>

#include "motion.h"

#define LEAST_FRICTION_FORCE 1e-100 /* N: below it a wheel is in the air */
#define LARGEST_U 1e9               /* beyond it contacts slip fully to 1 in 1e9: u is scaled back to it */
#define SHAPE_STEP 1e-6             /* of k; the quotient errs by about as much */

typedef struct {
	rs_lane f[3];       /* creep coefficients w G (a b)^m C */
	rs_lane limit;      /* mu N, or 0 in the air */
	rs_lane touches;    /* 1 or 0 */
	rs_lane A[3];
	rs_lane scaled;     /* u as given to the law over u */
} scales;

RS_INLINE void normalise(const rs_wheel_rail *wr, const rs_adhesion_input *in, scales *s, rs_creep_input *to)
{
	rs_lane area = in->a * in->b, ratio = in->a / in->b, stiffness = in->weight * wr->creep.modulus * area, safe;
	s->A[0] = s->A[1] = RS_ZERO + 1.0;
	RS_SQRT(s->A[2], area);
	RS_SQRT(to->root, ratio);
	s->f[0] = stiffness * in->c[0];
	s->f[1] = stiffness * in->c[1];
	s->f[2] = stiffness * s->A[2] * in->c[2];
	RS_EACH(l) {
		double limit = RS_OF(in->load, l) * RS_OF(in->friction, l);
		int touches = limit > LEAST_FRICTION_FORCE;
		RS_AT(s->touches, l) = touches ? 1.0 : 0.0;
		RS_AT(s->limit, l) = touches ? limit : 0.0;
		RS_AT(safe, l) = touches ? 1.0 / limit : 1.0;
	}
	for (int j = 0; j < 3; j++)
		to->u[j] = s->f[j] * in->creepage[j] * safe;
	RS_EACH(l) {
		double size = fabs(RS_OF(to->u[0], l)) + fabs(RS_OF(to->u[1], l)) + fabs(RS_OF(to->u[2], l));
		RS_AT(s->scaled, l) = wr->creep.law != RS_CREEP_KALKER_LINEAR && size > LARGEST_U ? LARGEST_U / size : 1.0;
	}
	for (int j = 0; j < 3; j++)
		to->u[j] *= s->scaled;
	to->c11 = in->c[0];
	to->c22 = in->c[1];
	to->c23 = in->c[2];
	to->c33 = in->c[3];
	to->adhesion = RS_ZERO + wr->creep.adhesion;
	to->slip = RS_ZERO + wr->creep.slip;
	to->strips = wr->creep.strips;
	to->cells = wr->creep.cells;
	to->table = wr->creep.table;
}

/* dh/dk at constant u. */
RS_INLINE void shape_slopes(const rs_wheel_rail *wr, const rs_adhesion_input *in, const rs_creep_input *law,
                            const rs_creep_value *value, rs_lane *slope)
{
	rs_creep_input moved = *law;
	rs_creep_value there;
	moved.c11 += SHAPE_STEP * in->c_to[0];
	moved.c22 += SHAPE_STEP * in->c_to[1];
	moved.c23 += SHAPE_STEP * in->c_to[2];
	moved.c33 += SHAPE_STEP * in->c_to[3];
	moved.root *= 1.0 + 0.5 * SHAPE_STEP;
	wr->law(&moved, 0, &there);
	for (int i = 0; i < 3; i++)
		slope[i] = (there.h[i] - value->h[i]) * (1.0 / SHAPE_STEP);
}

RS_CLONES void rs_adhesion_forces(const rs_wheel_rail *wr, int slopes, const rs_adhesion_input *in, rs_adhesion *out)
{
	static const double power[3] = {1.0, 1.0, 1.5};
	scales s;
	rs_creep_input law;
	rs_creep_value value;
	rs_lane shape[3];
	normalise(wr, in, &s, &law);
	wr->law(&law, slopes, &value);
	for (int i = 0; i < 3; i++)
		out->force[i] = s.limit * s.A[i] * value.h[i];
	if (!slopes)
		return;
	shape_slopes(wr, in, &law, &value, shape);
	for (int i = 0; i < 3; i++) {
		rs_lane along = RS_ZERO, grows = RS_ZERO, reshapes = shape[i], factor = s.limit * s.A[i];
		for (int j = 0; j < 3; j++) {
			rs_lane part = law.u[j] * value.d[i][j];
			along += part;
			grows += power[j] * part;
			reshapes += part * in->c_to[j] / in->c[j];
			out->slope[i][j] = s.touches * s.A[i] * s.f[j] * s.scaled * value.d[i][j];
		}
		out->slope[i][3] = s.touches * s.A[i] * in->friction * (value.h[i] - along);
		out->slope[i][4] = factor * grows + (i == 2 ? 0.5 : 0.0) * out->force[i];
		out->slope[i][5] = factor * reshapes;
	}
}

static int piece(const rs_creep_settings *creep, double log_ratio)
{
	int k = (int)((log_ratio - creep->start) / creep->step);
	return k < 0 ? 0 : k >= creep->pieces ? creep->pieces - 1 : k;
}

int rs_kalker_covers(const rs_creep_settings *creep, double log_ratio)
{
	return log_ratio >= creep->start && log_ratio <= creep->start + creep->pieces * creep->step;
}

void rs_kalker_at(const rs_creep_settings *creep, double log_ratio, double *c, double *slope)
{
	int k = piece(creep, log_ratio);
	double t = log_ratio - (creep->start + k * creep->step);
	for (int j = 0; j < 4; j++) {
		const double *p = creep->c + 16 * k + 4 * j;
		c[j] = p[0] + t * (p[1] + t * (p[2] + t * p[3]));
		if (slope)
			slope[j] = p[1] + t * (2.0 * p[2] + 3.0 * t * p[3]);
	}
}
