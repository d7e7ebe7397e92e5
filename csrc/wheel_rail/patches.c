/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of eight patches on their wheelsets.
 *
 *   n = s sin(delta) e2 + cos(delta) e3        into the rail, square to the rail's direction e1
 *   t1 ~ f - n (f n)    t2 = n x t1            forward and to the right in the contact plane
 *   r = x f + s across a + radius d            contact from the wheelset's centre
 *   pdot = n (close + turn x r)                N = N_elastic (1 + chi pdot), not below zero
 *   slip = v + omega x r    xi = t1 slip/V    eta = t2 slip/V    phi = n omega/V
 *   F = -N n + Fx t1 + Fy t2    M = r x F + Mz n
 *
 * and for every column the tangent of each line.
 */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "../trigonometry.h"
#include "motion.h"
#include "vectors.h"

enum { LOAD, ALONG, ACROSS, RADIUS, ANGLE, SEMI_A, SEMI_B };
_Static_assert(offsetof(rs_patch, zone) == RS_PATCH_ROWS * 5 * sizeof(double), "rs_patch begins with seven rows of five");

typedef struct {
	rs_motion_lanes at, to[RS_COLUMNS];
	rs_lane place_to[RS_COLUMNS][RS_PLACE_SIZE];
	rs_lane patch[RS_PATCH_ROWS][5];
	rs_lane side, e2[3], e3[3], sine, cosine, damping;
	rs_adhesion_input adhesion;
} inputs;

typedef struct {
	rs_lane n[3], tilt[3];          /* tilt: dn/d(delta) */
	rs_lane t1[3], t2[3], forward_n, inverse;  /* f n, 1/|f - n (f n)| */
	rs_lane r[3], rate[3], slip[3];
	rs_lane opening, presses;       /* 1 + chi pdot; 1 where it is positive, else 0 */
} geometry;

typedef struct {
	rs_lane force[3], moment[3];
	rs_lane force_to[RS_COLUMNS][3], moment_to[RS_COLUMNS][3];
	rs_adhesion creep;
} results;

/* n numbers of each of eight rows into lanes. */
static void spread(const double *const *from, int n, rs_lane *to)
{
	for (int k = 0; k < n; k++)
		RS_EACH(l)
			RS_AT(to[k], l) = from[l][k];
}

#define SPREAD(member, n, to) \
	do { \
		const double *rows_[RS_LANES]; \
		RS_EACH(l_) \
			rows_[l_] = (const double *)&wheel[l_]->member; \
		spread(rows_, n, (rs_lane *)(to)); \
	} while (0)

/* Seven rows of a value and its slopes; columns 1: the values only. */
static void spread_patches(const double *const *from, int columns, inputs *to)
{
	for (int row = 0; row < RS_PATCH_ROWS; row++)
		for (int k = 0; k < columns; k++)
			RS_EACH(l)
				RS_AT(to->patch[row][k], l) = from[l][5 * row + k];
}

/* Motion of the batch's wheels, which most often are eight wheels with one patch each. */
static void gather_motion(const rs_wheel_rail *wr, const int *number, inputs *to)
{
	int first = number[0] / RS_LANES, same = number[0] % RS_LANES == 0;
	RS_EACH(l)
		same &= number[l] == number[0] + l;
	if (same) {
		const rs_wheels *from = wr->wheels + first;
		to->at = from->at;
		to->side = from->side;
		memcpy(to->e2, from->e2, sizeof to->e2);
		memcpy(to->e3, from->e3, sizeof to->e3);
		return;
	}
	RS_EACH(l) {
		const rs_wheels *from = wr->wheels + number[l] / RS_LANES;
		int k = number[l] % RS_LANES;
		RS_AT(to->side, l) = RS_OF(from->side, k);
		EACH_AXIS(i) {
			RS_AT(to->e2[i], l) = RS_OF(from->e2[i], k);
			RS_AT(to->e3[i], l) = RS_OF(from->e3[i], k);
		}
		for (int i = 0; i < RS_MOTION_SIZE; i++)
			RS_AT(((rs_lane *)&to->at)[i], l) = RS_OF(((const rs_lane *)&from->at)[i], k);
	}
}

/* Lanes that are not used repeat the first one. */
static void gather(const rs_wheel_rail *wr, const rs_batch *batch, int tangents, inputs *to)
{
	const rs_wheel_state *wheel[RS_LANES];
	const double *patch[RS_LANES];
	int numbers[RS_LANES];
	RS_EACH(l) {
		int from = l < batch->count ? l : 0, number = batch->wheel[from];
		const rs_wheel *given = &wr->wheelset[number / 2].wheel[number % 2];
		double c[4], slope[4] = {0.0};
		numbers[l] = number;
		wheel[l] = &wr->axle[number / 2].wheel[number % 2];
		patch[l] = wheel[l]->patch[batch->patch[from]].load;
		RS_AT(to->damping, l) = given->damping;
		RS_AT(to->adhesion.friction, l) = given->friction;
		RS_AT(to->adhesion.weight, l) = given->weight;
		rs_kalker_at(&wr->creep, wheel[l]->log_ratio[batch->patch[from]], c, tangents ? slope : NULL);
		for (int j = 0; j < 4; j++) {
			RS_AT(to->adhesion.c[j], l) = c[j];
			RS_AT(to->adhesion.c_to[j], l) = slope[j];
		}
	}
	spread_patches(patch, tangents ? 5 : 1, to);
	gather_motion(wr, numbers, to);
	if (tangents) {
		SPREAD(place_to, RS_COLUMNS * RS_PLACE_SIZE, to->place_to);
		SPREAD(to, RS_COLUMNS * RS_MOTION_SIZE, to->to);
	}
}

/* Contact angles are small but for flanges. */
RS_INLINE void contact_angles(inputs *x)
{
	RS_EACH(l)
		rs_sine_cosine_series(RS_OF(x->patch[ANGLE][0], l), &RS_AT(x->sine, l), &RS_AT(x->cosine, l));
	RS_EACH(l)
		if (fabs(RS_OF(x->patch[ANGLE][0], l)) > RS_SMALL_ANGLE)
			rs_sine_cosine(RS_OF(x->patch[ANGLE][0], l), &RS_AT(x->sine, l), &RS_AT(x->cosine, l));
}

RS_INLINE void axes_of_contact(const inputs *x, geometry *g)
{
	const rs_motion_lanes *m = &x->at;
	rs_lane across = x->side * x->patch[ACROSS][0], square;
	EACH_AXIS(i) {
		g->n[i] = x->side * x->sine * x->e2[i] + x->cosine * x->e3[i];
		g->tilt[i] = x->side * x->cosine * x->e2[i] - x->sine * x->e3[i];
		g->r[i] = x->patch[ALONG][0] * m->f[i] + across * m->a[i] + x->patch[RADIUS][0] * m->d[i];
	}
	g->forward_n = DOT(m->f, g->n);
	square = 1.0 - g->forward_n * g->forward_n;
	RS_SQRT(g->inverse, square);
	g->inverse = 1.0 / g->inverse;
	EACH_AXIS(i)
		g->t1[i] = (m->f[i] - g->forward_n * g->n[i]) * g->inverse;
	CROSS(g->t2, g->n, g->t1);
}

RS_INLINE void load_and_creepages(inputs *x, double V, geometry *g)
{
	const rs_motion_lanes *m = &x->at;
	double inverse = 1.0 / V;
	CROSS(g->rate, m->turn, g->r);
	CROSS(g->slip, m->omega, g->r);
	EACH_AXIS(i) {
		g->rate[i] += m->close[i];
		g->slip[i] += m->v[i];
	}
	g->opening = 1.0 + x->damping * DOT(g->n, g->rate);
	RS_EACH(l)
		RS_AT(g->presses, l) = RS_OF(g->opening, l) > 0.0 ? 1.0 : 0.0;
	x->adhesion.load = x->patch[LOAD][0] * g->opening * g->presses;
	x->adhesion.creepage[0] = DOT(g->t1, g->slip) * inverse;
	x->adhesion.creepage[1] = DOT(g->t2, g->slip) * inverse;
	x->adhesion.creepage[2] = DOT(g->n, m->omega) * inverse;
	x->adhesion.a = x->patch[SEMI_A][0];
	x->adhesion.b = x->patch[SEMI_B][0];
}

RS_INLINE void forces(const inputs *x, const geometry *g, results *y)
{
	const rs_lane *F = y->creep.force;
	EACH_AXIS(i) {
		y->force[i] = F[0] * g->t1[i] + F[1] * g->t2[i] - x->adhesion.load * g->n[i];
		y->moment[i] = F[2] * g->n[i];
	}
	ADD_CROSS(y->moment, g->r, y->force);
}

/* Changes of a column that more than one line needs. */
typedef struct {
	rs_lane patch[RS_PATCH_ROWS], n[3], t1[3], t2[3], r[3], load, creep[3];
} column;

RS_INLINE void column_geometry(const inputs *x, const geometry *g, int k, column *c)
{
	const rs_motion_lanes *m = &x->at, *to = &x->to[k];
	for (int row = 0; row < RS_PATCH_ROWS; row++)
		c->patch[row] = x->patch[row][1] * x->place_to[k][0] + x->patch[row][2] * x->place_to[k][1]
		              + x->patch[row][3] * x->place_to[k][2] + x->patch[row][4] * x->place_to[k][3];
	rs_lane across = x->side * x->patch[ACROSS][0], moved = x->side * c->patch[ACROSS], changes[3];
	EACH_AXIS(i) {
		c->n[i] = g->tilt[i] * c->patch[ANGLE];
		c->r[i] = c->patch[ALONG] * m->f[i] + x->patch[ALONG][0] * to->f[i] + moved * m->a[i] + across * to->a[i]
		        + c->patch[RADIUS] * m->d[i] + x->patch[RADIUS][0] * to->d[i];
	}
	rs_lane forward_n = DOT(to->f, g->n) + DOT(m->f, c->n);
	EACH_AXIS(i)
		changes[i] = to->f[i] - forward_n * g->n[i] - g->forward_n * c->n[i];
	rs_lane along = DOT(g->t1, changes);
	EACH_AXIS(i)
		c->t1[i] = (changes[i] - along * g->t1[i]) * g->inverse;
	CROSS(c->t2, c->n, g->t1);
	ADD_CROSS(c->t2, g->n, c->t1);
}

RS_INLINE void column_creep(const inputs *x, double V, const geometry *g, const rs_adhesion *creep, int k, column *c)
{
	const rs_motion_lanes *m = &x->at, *to = &x->to[k];
	rs_lane rate[3], slip[3], in[RS_ADHESION_SLOPES];
	double inverse = 1.0 / V;
	EACH_AXIS(i) {
		rate[i] = to->close[i];
		slip[i] = to->v[i];
	}
	ADD_CROSS(rate, to->turn, g->r);
	ADD_CROSS(rate, m->turn, c->r);
	ADD_CROSS(slip, to->omega, g->r);
	ADD_CROSS(slip, m->omega, c->r);
	rs_lane approach = DOT(c->n, g->rate) + DOT(g->n, rate);
	c->load = g->presses * (c->patch[LOAD] * g->opening + x->patch[LOAD][0] * x->damping * approach);
	rs_lane a = c->patch[SEMI_A] / x->adhesion.a, b = c->patch[SEMI_B] / x->adhesion.b;
	in[0] = (DOT(c->t1, g->slip) + DOT(g->t1, slip)) * inverse;
	in[1] = (DOT(c->t2, g->slip) + DOT(g->t2, slip)) * inverse;
	in[2] = (DOT(c->n, m->omega) + DOT(g->n, to->omega)) * inverse;
	in[3] = c->load;
	in[4] = a + b;
	in[5] = a - b;
	for (int i = 0; i < 3; i++) {
		c->creep[i] = creep->slope[i][0] * in[0];
		for (int j = 1; j < RS_ADHESION_SLOPES; j++)
			c->creep[i] += creep->slope[i][j] * in[j];
	}
}

RS_INLINE void column_forces(const inputs *x, const geometry *g, const column *c, int k, results *y)
{
	const rs_lane *F = y->creep.force;
	rs_lane *force = y->force_to[k], *moment = y->moment_to[k];
	EACH_AXIS(i) {
		force[i] = c->creep[0] * g->t1[i] + F[0] * c->t1[i] + c->creep[1] * g->t2[i] + F[1] * c->t2[i]
		         - c->load * g->n[i] - x->adhesion.load * c->n[i];
		moment[i] = c->creep[2] * g->n[i] + F[2] * c->n[i];
	}
	ADD_CROSS(moment, c->r, y->force);
	ADD_CROSS(moment, g->r, force);
}

RS_CLONES static void contact(const rs_wheel_rail *wr, double V, int tangents, inputs *x, results *y)
{
	geometry g;
	contact_angles(x);
	axes_of_contact(x, &g);
	load_and_creepages(x, V, &g);
	rs_adhesion_forces(wr, tangents, &x->adhesion, &y->creep);
	forces(x, &g, y);
	for (int k = 0; tangents && k < RS_COLUMNS; k++) {
		column c;
		column_geometry(x, &g, k, &c);
		column_creep(x, V, &g, &y->creep, k, &c);
		column_forces(x, &g, &c, k, y);
	}
}

static void keep(const inputs *x, const results *y, const rs_batch *batch, rs_found *to)
{
	static const int rows[] = {ALONG, ACROSS, RADIUS, ANGLE, SEMI_A, SEMI_B};
	to->batch = *batch;
	to->load = x->adhesion.load;
	memcpy(to->creepage, x->adhesion.creepage, sizeof to->creepage);
	memcpy(to->creep, y->creep.force, sizeof to->creep);
	for (int j = 0; j < 6; j++)
		to->place[j] = x->patch[rows[j]][0];
}

void rs_patch_forces(const rs_wheel_rail *wr, double V, int tangents, const rs_batch *batch, rs_found *found)
{
	inputs x;
	results y;
	gather(wr, batch, tangents, &x);
	contact(wr, V, tangents, &x, &y);
	keep(&x, &y, batch, found);
	for (int l = 0; l < batch->count; l++) {
		rs_wheel_state *wheel = &wr->axle[batch->wheel[l] / 2].wheel[batch->wheel[l] % 2];
		EACH_AXIS(i) {
			wheel->force[i] += RS_OF(y.force[i], l);
			wheel->moment[i] += RS_OF(y.moment[i], l);
		}
		for (int k = 0; tangents && k < RS_COLUMNS; k++)
			EACH_AXIS(i) {
				wheel->force_to[k][i] += RS_OF(y.force_to[k][i], l);
				wheel->moment_to[k][i] += RS_OF(y.moment_to[k][i], l);
			}
	}
}
