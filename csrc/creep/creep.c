/* SPDX-License-Identifier: BSD-3-Clause */
/* Creep forces of any number of contacts: dimensionless numbers in, forces and slopes out (creep.h).
 *
 * With F = mu N h(u), u = w f_kalker (creepage)/(mu N):
 *   dF/d(creepage j) = w f_j dh/du_j    dF/dN = mu (h - u dh/du)    dF/dmu = N (h - u dh/du)
 *   dF/dw = (mu N/w) u dh/du
 */
#include <string.h>

#include "../creep.h"

enum { XI, ETA, PHI, A, B, LOAD, FRICTION, MODULUS, WEIGHT, C11, C22, C23, C33, ADHESION, SLIP };
_Static_assert(SLIP + 1 == RS_CREEP_INPUTS, "rows of rs_creep_forces");

#define LEAST_FRICTION_FORCE 1e-100 /* N: below it a wheel is in the air */
#define LARGEST_U 1e9               /* beyond it contacts slip fully to 1 in 1e9: u is scaled back to it */

static rs_creep_law *const LAWS[] = {rs_creep_kalker_linear, rs_creep_shen_hedrick_elkins, rs_creep_polach,
                                     rs_creep_fastsim, rs_creep_fastrip, rs_creep_exact_table};

typedef struct {
	rs_lane in[RS_CREEP_INPUTS];
	rs_lane f[3];       /* w G a b C11, w G a b C22, w G (a b)^(3/2) C23 */
	rs_lane limit;      /* mu N, or 0 in the air */
	rs_lane arm;        /* sqrt(a b) */
	rs_lane scaled;     /* u as given to the law over u */
} batch;

/* Lanes that are not used repeat the first one. */
static void gather(const double *in, int contacts, int first, int count, batch *b)
{
	for (int k = 0; k < RS_CREEP_INPUTS; k++) {
		const double *row = in + (size_t)k * contacts + first;
		if (count == RS_LANES)
			memcpy(&b->in[k], row, sizeof b->in[k]);
		else
			RS_EACH(l)
				RS_AT(b->in[k], l) = row[l < count ? l : 0];
	}
}

RS_INLINE void normalise(batch *b, int saturates, rs_creep_input *to)
{
	const rs_lane *in = b->in;
	rs_lane area = in[A] * in[B], ratio = in[A] / in[B], stiffness = in[WEIGHT] * in[MODULUS] * area, safe;
	RS_SQRT(b->arm, area);
	RS_SQRT(to->root, ratio);
	b->f[0] = stiffness * in[C11];
	b->f[1] = stiffness * in[C22];
	b->f[2] = stiffness * b->arm * in[C23];
	RS_EACH(l) {
		double load = RS_OF(in[LOAD], l), limit = load * RS_OF(in[FRICTION], l);
		int touches = load > 0.0 && limit > LEAST_FRICTION_FORCE;
		RS_AT(b->limit, l) = touches ? limit : 0.0;
		RS_AT(safe, l) = touches ? 1.0 / limit : 1.0;
	}
	for (int j = 0; j < 3; j++)
		to->u[j] = b->f[j] * in[XI + j];
	RS_EACH(l) { /* before the division, which might overflow */
		double size = fabs(RS_OF(to->u[0], l)) + fabs(RS_OF(to->u[1], l)) + fabs(RS_OF(to->u[2], l));
		double limit = RS_OF(b->limit, l), largest = limit > 0.0 ? LARGEST_U * limit : LARGEST_U;
		RS_AT(b->scaled, l) = saturates && size > largest ? largest / size : 1.0;
	}
	for (int j = 0; j < 3; j++)
		to->u[j] *= b->scaled * safe;
	to->c11 = in[C11];
	to->c22 = in[C22];
	to->c23 = in[C23];
	to->c33 = in[C33];
	to->adhesion = in[ADHESION];
	to->slip = in[SLIP];
}

/* Forces (3) and slopes (3 x 6, columns xi eta phi load friction weight) from h and dh/du. */
RS_INLINE void scale(const batch *b, const rs_creep_input *law, const rs_creep_value *value, int slopes,
                         rs_lane *force, rs_lane *slope)
{
	rs_lane touches;
	RS_EACH(l)
		RS_AT(touches, l) = RS_OF(b->limit, l) > 0.0 ? 1.0 : 0.0;
	for (int i = 0; i < 3; i++) {
		rs_lane arm = i < 2 ? (rs_lane)(RS_ZERO + 1.0) : b->arm;
		force[i] = b->limit * arm * value->h[i];
		if (!slopes)
			continue;
		rs_lane along = RS_ZERO, rest;
		for (int j = 0; j < 3; j++) {
			slope[6 * i + j] = touches * arm * b->f[j] * b->scaled * value->d[i][j];
			along += law->u[j] * value->d[i][j];
		}
		rest = touches * arm * (value->h[i] - along);
		slope[6 * i + 3] = b->in[FRICTION] * rest;
		slope[6 * i + 4] = b->in[LOAD] * rest;
		slope[6 * i + 5] = b->limit * arm * along / b->in[WEIGHT];
	}
}

static void scatter(const rs_lane *lanes, int rows, int contacts, int first, int count, double *to)
{
	if (count == RS_LANES)
		for (int k = 0; k < rows; k++)
			memcpy(to + (size_t)k * contacts + first, &lanes[k], sizeof *lanes);
	else
		for (int k = 0; k < rows; k++)
			memcpy(to + (size_t)k * contacts + first, &lanes[k], count * sizeof(double));
}

RS_CLONES static void one_batch(int law, int slopes, batch *b, rs_creep_input *input, rs_lane *force, rs_lane *slope)
{
	rs_creep_value value;
	normalise(b, law != RS_CREEP_KALKER_LINEAR, input);
	LAWS[law](input, slopes, &value);
	scale(b, input, &value, slopes, force, slope);
}

static void all_batches(int law, rs_creep_input *input, int contacts, const double *in, double *force, double *slopes)
{
	for (int first = 0; first < contacts; first += RS_LANES) {
		int count = contacts - first < RS_LANES ? contacts - first : RS_LANES;
		batch b;
		rs_lane lanes_force[3], lanes_slope[18];
		gather(in, contacts, first, count, &b);
		one_batch(law, slopes != NULL, &b, input, lanes_force, lanes_slope);
		scatter(lanes_force, 3, contacts, first, count, force);
		if (slopes)
			scatter(lanes_slope, 18, contacts, first, count, slopes);
	}
}

int rs_creep_forces(int law, int strips, int cells, int contacts, const double *in, double *force, double *slopes)
{
	if (law < 0 || law >= (int)(sizeof LAWS / sizeof *LAWS) || law == RS_CREEP_EXACT)
		return RS_BAD_INDEX;
	if (contacts < 0 || strips < 1 || cells < 1)
		return RS_BAD_SIZE;
	rs_creep_input input = {.strips = strips, .cells = cells};
	all_batches(law, &input, contacts, in, force, slopes);
	return RS_OK;
}

int rs_creep_forces_exact(const rs_creep_table *table, int contacts, const double *in, double *force, double *slopes)
{
	if (contacts < 0 || table->pieces < 1 || table->ratio_pieces < 1 || !(table->least > 0.0 && table->largest > table->least))
		return RS_BAD_SIZE;
	rs_creep_input input = {.table = table};
	all_batches(RS_CREEP_EXACT, &input, contacts, in, force, slopes);
	return RS_OK;
}

rs_creep_law *rs_creep_law_at(int law)
{
	return law < 0 || law >= (int)(sizeof LAWS / sizeof *LAWS) ? NULL : LAWS[law];
}
