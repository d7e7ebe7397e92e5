/* SPDX-License-Identifier: BSD-3-Clause */
/* Reading a contact table: splines over shift, roll and penetration (contact_table.h), with exact slopes of the interpolant.
 *
 * In wheelset axes the outline of a wheel yawed by psi is touched x = r t psi ahead of its centre (t the slope of the contact
 * plane to the axle), where it is lower by psi^2/2 t (r t - Y') (to the second order in psi).
 */
#include <math.h>
#include <stddef.h>

#include "../trigonometry.h"
#include "rows.h"

#define INLINE static RS_ALWAYS_INLINE
#define LEAST_TAU 1e-6 /* less is no contact: the load is below 1e-18 of that at the deepest level */

enum { BATCH = 8 };

/* Three coefficients of a quadratic B-spline. */
typedef struct {
	int node;                        /* first of three */
	double w[3], d[3];               /* weights of value and slope */
} knot;

/* x: place in nodes; the nearest node is the middle one of the three. */
INLINE knot knot_at(double x, double inverse_step)
{
	int middle = (int)(x + 0.5);
	double t = x - middle, below = 0.5 - t, above = 0.5 + t;
	return (knot){middle - 1, {0.5 * below * below, 0.75 - t * t, 0.5 * above * above},
	              {-below * inverse_step, -2.0 * t * inverse_step, above * inverse_step}};
}

/* 0 where x is outside the range that may be read. */
INLINE int locate(const rs_axis *axis, double x, knot *k)
{
	double place = (x - axis->start) * axis->inverse;
	if (!(place >= 1.0 && place <= axis->count - 2))
		return 0;
	*k = knot_at(place, axis->inverse);
	return 1;
}

enum { VALUE, BY_SHIFT, BY_ROLL, TWICE_BY_SHIFT, BY_BOTH, CLOSURES }; /* of c, s, r, Y' */
enum { BY_TAU = 3, FIELD_SLOPES };                                     /* of the fields, after the first three */

/* Value and slope over the shift, and (all) the others. */
INLINE void read_closure(const rs_contact_table *t, int zone, const knot *shift, const knot *roll, int all, half_row *out)
{
	const half_row *first = (const half_row *)t->zone[zone].closure + (size_t)shift->node * (size_t)t->roll.count + (size_t)roll->node;
	double square = t->zone[zone].shift.inverse * t->zone[zone].shift.inverse, twice[3] = {square, -2.0 * square, square};
	half_row value = {0}, by_shift = {0}, by_roll = {0}, second = {0}, both = {0};
	for (int i = 0; i < 3; i++) {
		const half_row *node = first + (size_t)i * (size_t)t->roll.count;
		half_row here = {0}, slope = {0};
		for (int j = 0; j < 3; j++) {
			ADD_SCALED(here, roll->w[j], node[j]);
			if (all)
				ADD_SCALED(slope, roll->d[j], node[j]);
		}
		ADD_SCALED(value, shift->w[i], here);
		ADD_SCALED(by_shift, shift->d[i], here);
		if (!all)
			continue;
		ADD_SCALED(by_roll, shift->w[i], slope);
		ADD_SCALED(second, twice[i], here);
		ADD_SCALED(both, shift->d[i], slope);
	}
	out[VALUE] = value;
	out[BY_SHIFT] = by_shift;
	if (!all)
		return;
	out[BY_ROLL] = by_roll;
	out[TWICE_BY_SHIFT] = second;
	out[BY_BOTH] = both;
}

INLINE const row *first_node(const rs_contact_table *t, int zone, const knot *shift, const knot *roll, const knot *level)
{
	return (const row *)t->zone[zone].field + ((size_t)shift->node * (size_t)t->roll.count + (size_t)roll->node) * (size_t)t->levels + (size_t)level->node;
}

/* Level by level over shift and roll for the value and its slope over tau; node by node over the levels for the other slopes. */
INLINE void read_field(const rs_contact_table *t, int zone, const knot *shift, const knot *roll, const knot *level, row *out)
{
	size_t along = (size_t)t->levels, across = along * (size_t)t->roll.count;
	const row *first = first_node(t, zone, shift, roll, level);
	row at[3] = {{{{0}}}}, by_shift = {{{0}}}, by_roll = {{{0}}}, value = {{{0}}}, by_tau = {{{0}}};
	for (int i = 0; i < 3; i++) {
		row sum = {{{0}}};
		for (int j = 0; j < 3; j++) {
			const row *node = first + (size_t)i * across + (size_t)j * along;
			double weight = shift->w[i] * roll->w[j];
			row here = {{{0}}};
			for (int k = 0; k < 3; k++) {
				ADD_SCALED_ROW(here, level->w[k], node[k]);
				ADD_SCALED_ROW(at[k], weight, node[k]);
			}
			ADD_SCALED_ROW(sum, roll->w[j], here);
			ADD_SCALED_ROW(by_roll, shift->w[i] * roll->d[j], here);
		}
		ADD_SCALED_ROW(by_shift, shift->d[i], sum);
	}
	for (int k = 0; k < 3; k++) {
		ADD_SCALED_ROW(value, level->w[k], at[k]);
		ADD_SCALED_ROW(by_tau, level->d[k], at[k]);
	}
	out[VALUE] = value;
	out[BY_SHIFT] = by_shift;
	out[BY_ROLL] = by_roll;
	out[BY_TAU] = by_tau;
}

/* The value alone, added up as in read_field. */
INLINE void read_field_value(const rs_contact_table *t, int zone, const knot *shift, const knot *roll, const knot *level, row *value)
{
	size_t along = (size_t)t->levels, across = along * (size_t)t->roll.count;
	const row *first = first_node(t, zone, shift, roll, level);
	row at[3] = {{{{0}}}}, sum = {{{0}}};
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++) {
			const row *node = first + (size_t)i * across + (size_t)j * along;
			double weight = shift->w[i] * roll->w[j];
			for (int k = 0; k < 3; k++)
				ADD_SCALED_ROW(at[k], weight, node[k]);
		}
	for (int k = 0; k < 3; k++)
		ADD_SCALED_ROW(sum, level->w[k], at[k]);
	*value = sum;
}

/* A number with its slopes over (eta, roll at constant eta, drop, yaw). */
typedef struct {
	double v, d[4];
} slopes;

/* Normal penetration p of a zone: s P, P = drop - c + yaw^2/2 t (r t - Y'), t = -dc/d(eta). */
INLINE slopes penetration(const double (*c)[RS_CLOSURE], double drop, double yaw, int with_slopes)
{
	double t = -c[BY_SHIFT][0], r = c[VALUE][2], half = 0.5 * yaw * yaw, arm = r * t - c[VALUE][3], s = c[VALUE][1];
	double P = drop - c[VALUE][0] + half * t * arm, by[2];
	if (!with_slopes)
		return (slopes){s * P, {0.0}};
	for (int k = 0; k < 2; k++) { /* shift, roll */
		const double *d = c[BY_SHIFT + k], dt = -c[TWICE_BY_SHIFT + k][0];
		by[k] = s * (-d[0] + half * (dt * (arm + r * t) + t * (t * d[2] - d[3]))) + P * d[1];
	}
	return (slopes){s * P, {by[0], by[1], s, s * yaw * t * arm}};
}

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized" /* GCC 12 says so of the vectors in the initialiser of power and slope */
#endif

/* Values of all fields with their slopes over (y, roll, drop, yaw), load and semi-axes with their power of p: column 0 of out,
 * then 1 to 4. d/d(roll) at constant y is d/d(roll) - r0 d/d(eta). */
INLINE void chain(const row *f, const double *tau, const slopes *p, double root, double inverse, double radius, row *out)
{
	static const row load = ROW_OF(1.0, 0.0, 0.0, 0.0, 0.0, 0.0), place = ROW_OF(0.0, 1.0, 1.0, 1.0, 0.0, 0.0), axes = ROW_OF(0.0, 0.0, 0.0, 0.0, 1.0, 1.0);
	row power = place, slope = ROW_OF(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), by_tau, by_p;
	ADD_SCALED_ROW(power, p->v * root, load);
	ADD_SCALED_ROW(power, root, axes);
	ADD_SCALED_ROW(slope, 1.5 * root, load);
	ADD_SCALED_ROW(slope, 0.5 * inverse, axes);
	MULTIPLY_ROWS(by_tau, power, f[BY_TAU]);
	MULTIPLY_ROWS(by_p, slope, f[VALUE]);
	MULTIPLY_ROWS(out[0], power, f[VALUE]);
	MULTIPLY_ROWS(out[1], power, f[BY_SHIFT]);
	MULTIPLY_ROWS(out[2], power, f[BY_ROLL]);
	out[3] = out[4] = (row){{{0}}};
	for (int k = 0; k < 4; k++) {
		ADD_SCALED_ROW(out[1 + k], tau[k], by_tau);
		ADD_SCALED_ROW(out[1 + k], p->d[k], by_p);
	}
	ADD_SCALED_ROW(out[2], -radius, out[1]);
}

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

INLINE void take(const double (*from)[RS_FIELDS], int field, double *to)
{
	for (int k = 0; k < 5; k++)
		to[k] = from[k][field];
}

/* The contact of a yawed wheel: ahead by r t psi, inward by r t psi^2, below by r t^2 psi^2/2, t the tangent of its slope to the
 * axle: of the angle itself, so that the normal meets the axle. */
INLINE void turn(double yaw, const double *slope_angle, rs_patch *patch)
{
	double sine, cosine, arm_slope[5], half_slope[5];
	rs_sine_cosine(slope_angle[0], &sine, &cosine);
	double t = sine / cosine, t_angle = 1.0 + t * t, r = patch->radius[0], square = yaw * yaw, arm = r * t, half = 0.5 * arm * t;
	for (int k = 1; k < 5; k++) {
		double dt = t_angle * slope_angle[k];
		arm_slope[k] = patch->radius[k] * t + r * dt;
		half_slope[k] = 0.5 * (arm_slope[k] * t + arm * dt);
	}
	patch->x[0] = arm * yaw;
	patch->across[0] -= arm * square;
	patch->radius[0] += half * square;
	for (int k = 1; k < 5; k++) {
		patch->x[k] = arm_slope[k] * yaw;
		patch->across[k] -= arm_slope[k] * square;
		patch->radius[k] += half_slope[k] * square;
	}
	patch->x[4] += arm;
	patch->across[4] -= 2.0 * arm * yaw;
	patch->radius[4] += 2.0 * half * yaw;
}

/* Level 1 is tau = 0. */
INLINE knot level_of(const rs_contact_table *t, double tau)
{
	int parts = t->levels - 3;
	return knot_at(1.0 + tau * parts, parts);
}

INLINE void read_patch(const rs_contact_table *t, int zone, const knot *shift, const knot *roll, const slopes *p, const double *place,
                       rs_patch *patch)
{
	double root = sqrt(p->v), inverse = 1.0 / root, half = 0.5 * t->inverse_root * inverse;
	double tau[4] = {half * p->d[0], half * p->d[1], half * p->d[2], half * p->d[3]}; /* slopes of tau */
	row rows[FIELD_SLOPES], out[5];
	knot level = level_of(t, root * t->inverse_root);
	read_field(t, zone, shift, roll, &level, rows);
	chain(rows, tau, p, root, inverse, t->wheel_radius, out);
	take((const double (*)[RS_FIELDS])out, RS_STIFFNESS, patch->load);
	take((const double (*)[RS_FIELDS])out, RS_ACROSS, patch->across);
	take((const double (*)[RS_FIELDS])out, RS_RADIUS, patch->radius);
	take((const double (*)[RS_FIELDS])out, RS_ANGLE, patch->angle);
	take((const double (*)[RS_FIELDS])out, RS_LENGTH, patch->a);
	take((const double (*)[RS_FIELDS])out, RS_WIDTH, patch->b);
	turn(place[3], patch->angle, patch);
	patch->angle[0] -= place[1];
	patch->angle[2] -= 1.0;
	patch->zone = zone;
}

/* The same without slopes: the numbers [0] of the patch. */
INLINE void read_patch_values(const rs_contact_table *t, int zone, const knot *shift, const knot *roll, double p, const double *place,
                              rs_patch *patch)
{
	double root = sqrt(p), yaw = place[3], square = yaw * yaw;
	knot level = level_of(t, root * t->inverse_root);
	row value;
	read_field_value(t, zone, shift, roll, &level, &value);
	const double *f = (const double *)&value;
	double sine, cosine;
	rs_sine_cosine(f[RS_ANGLE], &sine, &cosine);
	double tangent = sine / cosine, arm = f[RS_RADIUS] * tangent, half = 0.5 * arm * tangent;
	patch->load[0] = p * root * f[RS_STIFFNESS];
	patch->x[0] = arm * yaw;
	patch->across[0] = f[RS_ACROSS] - arm * square;
	patch->radius[0] = f[RS_RADIUS] + half * square;
	patch->angle[0] = f[RS_ANGLE] - place[1];
	patch->a[0] = root * f[RS_LENGTH];
	patch->b[0] = root * f[RS_WIDTH];
	patch->zone = zone;
}

/* What is no number is outside every range, and told apart only here. */
static int refuse(const double *place, int which, int *beyond)
{
	*beyond = which;
	return isfinite(place[0] + place[1] + place[2] + place[3]) ? RS_OUT_OF_TABLE : RS_NOT_FINITE;
}

/* A place found on the axes, and how deep each zone is. */
typedef struct {
	knot shift[RS_ZONES], roll;
	slopes p[RS_ZONES];
} found_place;

INLINE int find_place(const rs_contact_table *t, const double *place, int with_slopes, found_place *f, int *beyond)
{
	double eta = place[0] - t->wheel_radius * place[1], at = (eta - t->shift.start) * t->shift.inverse;
	if (!locate(&t->roll, place[1], &f->roll))
		return refuse(place, 1, beyond);
	if (!(at >= 1.0 && at <= t->shift.count - 2))
		return refuse(place, 0, beyond);
	for (int z = 0; z < t->zones; z++) {
		half_row closure[CLOSURES];
		f->p[z].v = 0.0;
		if (!locate(&t->zone[z].shift, eta, &f->shift[z]))
			continue; /* the zone cannot touch here */
		read_closure(t, z, &f->shift[z], &f->roll, with_slopes, closure);
		f->p[z] = penetration((const double (*)[RS_CLOSURE])closure, place[2], place[3], with_slopes);
		if (!(f->p[z].v <= t->deepest))
			return refuse(place, 2, beyond);
	}
	return RS_OK;
}

INLINE int read_zones(const rs_contact_table *t, const double *place, const found_place *f, int with_slopes, rs_patch *patch, int *count,
                      int *beyond)
{
	for (int z = 0; z < t->zones; z++)
		if (f->p[z].v > LEAST_TAU * LEAST_TAU * t->deepest) {
			if (with_slopes)
				read_patch(t, z, &f->shift[z], &f->roll, &f->p[z], place, patch + *count);
			else
				read_patch_values(t, z, &f->shift[z], &f->roll, f->p[z].v, place, patch + *count);
			if (!isfinite(patch[*count].load[0])) { /* a zone that meets the rail beyond an end of a profile */
				*count = 0;
				return refuse(place, 0, beyond);
			}
			(*count)++;
		}
	return RS_OK;
}

INLINE int look_up(const rs_contact_table *t, const double *place, int with_slopes, rs_patch *patch, int *count, int *beyond)
{
	found_place f;
	*count = 0;
	int status = find_place(t, place, with_slopes, &f, beyond);
	return status == RS_OK ? read_zones(t, place, &f, with_slopes, patch, count, beyond) : status;
}

RS_CLONES int rs_contact_lookup(const rs_contact_table *t, const double *place, rs_patch *patch, int *count, int *beyond)
{
	return look_up(t, place, 1, patch, count, beyond);
}

RS_CLONES int rs_contact_lookup_values(const rs_contact_table *t, const double *place, rs_patch *patch, int *count, int *beyond)
{
	return look_up(t, place, 0, patch, count, beyond);
}

/* First the places of a batch, then their patches: loops short enough for the processor to begin the next wheel meanwhile. */
RS_CLONES static int look_up_batch(const rs_contact_table *t, int n, const double *place, rs_patch *patch, int *count, int *beyond)
{
	found_place f[BATCH];
	int status[BATCH], worst = RS_OK;
	for (int k = 0; k < n; k++)
		status[k] = find_place(t, place + RS_PLACE_SIZE * k, 1, f + k, beyond + k);
	for (int k = 0; k < n; k++) {
		if (status[k] == RS_OK)
			status[k] = read_zones(t, place + RS_PLACE_SIZE * k, f + k, 1, patch + RS_ZONES * k, count + k, beyond + k);
		if (status[k] == RS_NOT_FINITE)
			beyond[k] = RS_PLACE_SIZE;
		worst = status[k] != RS_OK ? status[k] : worst;
	}
	return worst;
}

int rs_contact_lookup_many(const rs_contact_table *t, int n, const double *place, rs_patch *patch, int *count, int *beyond)
{
	int worst = RS_OK;
	for (int k = 0; k < n; k++) {
		count[k] = 0;
		beyond[k] = -1;
	}
	for (int k = 0; k < n; k += BATCH) {
		int status = look_up_batch(t, n - k < BATCH ? n - k : BATCH, place + RS_PLACE_SIZE * (size_t)k, patch + RS_ZONES * (size_t)k, count + k, beyond + k);
		worst = status != RS_OK ? status : worst;
	}
	return worst;
}
