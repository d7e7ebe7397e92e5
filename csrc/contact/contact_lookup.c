/* SPDX-License-Identifier: BSD-3-Clause */
/* Reading a contact table: cubics over shift, roll and penetration (contact_table.h), with exact slopes of the interpolant.
 *
 * In wheelset axes the outline of a wheel yawed by psi is touched x = r t psi ahead of its centre (t the slope of the contact
 * plane to the axle), where it is lower by psi^2/2 t (r t - Y') (to the second order in psi).
 */
#include <math.h>
#include <string.h>

#include "../dispatch.h"
#include "contact_table.h"

#define LEAST_TAU 1e-6 /* less is no contact: the load is below 1e-18 of that at the deepest level */

#if defined(__GNUC__)
#define INLINE static inline __attribute__((always_inline))
#else
#define INLINE static inline
#endif

typedef struct {
	int node;                        /* first of four */
	double w[4], d[4], dd[4];        /* weights of value, slope, second slope */
} cell;

/* Weights of a cubic through nodes 1 and 2 whose slopes there are the central differences. */
INLINE void weigh(double t, double inverse_step, cell *c)
{
	double s = t * t, q = inverse_step, qq = q * q;
	c->w[0] = t * (-0.5 + t * (1.0 - 0.5 * t));
	c->w[1] = 1.0 + s * (-2.5 + 1.5 * t);
	c->w[2] = t * (0.5 + t * (2.0 - 1.5 * t));
	c->w[3] = s * (-0.5 + 0.5 * t);
	c->d[0] = q * (-0.5 + t * (2.0 - 1.5 * t));
	c->d[1] = q * t * (-5.0 + 4.5 * t);
	c->d[2] = q * (0.5 + t * (4.0 - 4.5 * t));
	c->d[3] = q * t * (-1.0 + 1.5 * t);
	c->dd[0] = qq * (2.0 - 3.0 * t);
	c->dd[1] = qq * (-5.0 + 9.0 * t);
	c->dd[2] = qq * (4.0 - 9.0 * t);
	c->dd[3] = qq * (-1.0 + 3.0 * t);
}

/* 0 where x is outside the range that may be read. */
INLINE int locate(const rs_axis *axis, double x, cell *c)
{
	double inverse = 1.0 / axis->step, t = (x - axis->start) * inverse;
	if (!(t >= 1.0 && t <= axis->count - 2))
		return 0;
	int k = (int)t;
	k = k > axis->count - 3 ? axis->count - 3 : k;
	c->node = k - 1;
	weigh(t - k, inverse, c);
	return 1;
}

enum { VALUE, BY_SHIFT, BY_ROLL, TWICE_BY_SHIFT, BY_BOTH, CLOSURES }; /* of c, s, r, Y' */
enum { BY_TAU = 3, FIELD_SLOPES };                                     /* of the fields, after the first three */

INLINE void read_closure(const rs_contact_table *t, int zone, const cell *shift, const cell *roll, double out[CLOSURES][RS_CLOSURE])
{
	const double *first = t->zone[zone].closure + ((size_t)shift->node * (size_t)t->roll.count + (size_t)roll->node) * RS_CLOSURE;
	memset(out, 0, CLOSURES * sizeof out[0]);
	for (int i = 0; i < 4; i++) {
		const double *node = first + (size_t)i * (size_t)t->roll.count * RS_CLOSURE;
		for (int f = 0; f < RS_CLOSURE; f++) {
			double value = 0.0, by_roll = 0.0;
			for (int j = 0; j < 4; j++) {
				value += roll->w[j] * node[j * RS_CLOSURE + f];
				by_roll += roll->d[j] * node[j * RS_CLOSURE + f];
			}
			out[VALUE][f] += shift->w[i] * value;
			out[BY_SHIFT][f] += shift->d[i] * value;
			out[BY_ROLL][f] += shift->w[i] * by_roll;
			out[TWICE_BY_SHIFT][f] += shift->dd[i] * value;
			out[BY_BOTH][f] += shift->d[i] * by_roll;
		}
	}
}

INLINE void read_field(const rs_contact_table *t, int zone, const cell *shift, const cell *roll, const cell *level,
                       double out[FIELD_SLOPES][RS_FIELDS])
{
	size_t along = (size_t)t->levels * RS_FIELDS;
	const double *first = t->zone[zone].field + ((size_t)shift->node * (size_t)t->roll.count + (size_t)roll->node) * along +
	                      (size_t)level->node * RS_FIELDS;
	memset(out, 0, FIELD_SLOPES * sizeof out[0]);
	for (int i = 0; i < 4; i++) {
		double value[RS_FIELDS] = {0}, by_roll[RS_FIELDS] = {0}, by_tau[RS_FIELDS] = {0};
		for (int j = 0; j < 4; j++) {
			const double *node = first + ((size_t)i * (size_t)t->roll.count + (size_t)j) * along;
			for (int f = 0; f < RS_FIELDS; f++) {
				double a = node[f], b = node[RS_FIELDS + f], c = node[2 * RS_FIELDS + f], d = node[3 * RS_FIELDS + f];
				double here = level->w[0] * a + level->w[1] * b + level->w[2] * c + level->w[3] * d;
				value[f] += roll->w[j] * here;
				by_roll[f] += roll->d[j] * here;
				by_tau[f] += roll->w[j] * (level->d[0] * a + level->d[1] * b + level->d[2] * c + level->d[3] * d);
			}
		}
		for (int f = 0; f < RS_FIELDS; f++) {
			out[VALUE][f] += shift->w[i] * value[f];
			out[BY_SHIFT][f] += shift->d[i] * value[f];
			out[BY_ROLL][f] += shift->w[i] * by_roll[f];
			out[BY_TAU][f] += shift->w[i] * by_tau[f];
		}
	}
}

/* A number with its slopes over (eta, roll at constant eta, drop, yaw). */
typedef struct {
	double v, d[4];
} slopes;

/* Normal penetration p of a zone: s P, P = drop - c + yaw^2/2 t (r t - Y'), t = -dc/d(eta). */
INLINE slopes penetration(const double c[CLOSURES][RS_CLOSURE], double drop, double yaw)
{
	double t = -c[BY_SHIFT][0], r = c[VALUE][2], half = 0.5 * yaw * yaw, arm = r * t - c[VALUE][3], s = c[VALUE][1];
	double P = drop - c[VALUE][0] + half * t * arm, by[2];
	for (int k = 0; k < 2; k++) { /* shift, roll */
		const double *d = c[BY_SHIFT + k], dt = -c[TWICE_BY_SHIFT + k][0];
		by[k] = s * (-d[0] + half * (dt * (arm + r * t) + t * (t * d[2] - d[3]))) + P * d[1];
	}
	return (slopes){s * P, {by[0], by[1], s, s * yaw * t * arm}};
}

/* factor(p) F with its slopes, changed to (y, roll, drop, yaw): d/d(roll) at constant y is d/d(roll) - r0 d/d(eta). */
INLINE void put(const double f[FIELD_SLOPES][RS_FIELDS], int field, const slopes *tau, const slopes *p, double factor, double factor_slope,
                double radius, double *to)
{
	double value = f[VALUE][field], d[4];
	for (int k = 0; k < 4; k++)
		d[k] = factor * f[BY_TAU][field] * tau->d[k] + factor_slope * value * p->d[k];
	d[0] += factor * f[BY_SHIFT][field];
	d[1] += factor * f[BY_ROLL][field];
	to[0] = factor * value;
	to[1] = d[0];
	to[2] = d[1] - radius * d[0];
	to[3] = d[2];
	to[4] = d[3];
}

/* The contact of a yawed wheel: ahead by r t psi, inward by r t psi^2, below by r t^2 psi^2/2 (t = tan of the slope to the axle). */
INLINE void turn(double yaw, const double *slope_angle, rs_patch *patch)
{
	double t = tan(slope_angle[0]), t_angle = 1.0 + t * t, r = patch->radius[0], square = yaw * yaw;
	double arm = r * t, arm_slope[5], half = 0.5 * arm * t, half_slope[5];
	for (int k = 1; k < 5; k++) {
		double dt = t_angle * slope_angle[k], dr = patch->radius[k];
		arm_slope[k] = dr * t + r * dt;
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

INLINE void read_patch(const rs_contact_table *t, int zone, const cell *shift, const cell *roll, const slopes *p, const double *place,
                       rs_patch *patch)
{
	double root = sqrt(p->v), deepest = sqrt(t->deepest), field[FIELD_SLOPES][RS_FIELDS], r0 = t->wheel_radius;
	slopes tau = {root / deepest, {0.0}};
	for (int k = 0; k < 4; k++)
		tau.d[k] = p->d[k] / (2.0 * deepest * root);
	int parts = t->levels - 3, k = (int)(tau.v * parts);
	cell level;
	level.node = k < parts ? k : parts - 1;
	weigh(tau.v * parts - level.node, parts, &level);
	read_field(t, zone, shift, roll, &level, field);
	put(field, RS_STIFFNESS, &tau, p, p->v * root, 1.5 * root, r0, patch->load);
	put(field, RS_ACROSS, &tau, p, 1.0, 0.0, r0, patch->across);
	put(field, RS_RADIUS, &tau, p, 1.0, 0.0, r0, patch->radius);
	put(field, RS_ANGLE, &tau, p, 1.0, 0.0, r0, patch->angle);
	put(field, RS_LENGTH, &tau, p, root, 0.5 / root, r0, patch->a);
	put(field, RS_WIDTH, &tau, p, root, 0.5 / root, r0, patch->b);
	turn(place[3], patch->angle, patch);
	patch->angle[0] -= place[1];
	patch->angle[2] -= 1.0;
	patch->zone = zone;
}

static int refuse(int which, int *beyond)
{
	*beyond = which;
	return RS_OUT_OF_TABLE;
}

RS_CLONES int rs_contact_lookup(const rs_contact_table *t, const double *place, rs_patch *patch, int *count, int *beyond)
{
	cell shift[RS_ZONES], roll;
	slopes p[RS_ZONES];
	double eta = place[0] - t->wheel_radius * place[1];
	*count = 0;
	if (!isfinite(place[0] + place[1] + place[2] + place[3]))
		return RS_NOT_FINITE;
	if (!locate(&t->roll, place[1], &roll))
		return refuse(1, beyond);
	if (!locate(&t->shift, eta, &shift[0]))
		return refuse(0, beyond);
	for (int z = 0; z < t->zones; z++) {
		double closure[CLOSURES][RS_CLOSURE];
		p[z].v = 0.0;
		if (!locate(&t->zone[z].shift, eta, &shift[z]))
			continue; /* the zone cannot touch here */
		read_closure(t, z, &shift[z], &roll, closure);
		p[z] = penetration(closure, place[2], place[3]);
		if (!(p[z].v <= t->deepest))
			return refuse(2, beyond);
	}
	for (int z = 0; z < t->zones; z++)
		if (p[z].v > LEAST_TAU * LEAST_TAU * t->deepest) {
			read_patch(t, z, &shift[z], &roll, &p[z], place, patch + *count);
			if (!isfinite(patch[*count].load[0])) { /* a zone that meets the rail beyond an end of a profile */
				*count = 0;
				return refuse(0, beyond);
			}
			(*count)++;
		}
	return RS_OK;
}

int rs_contact_lookup_many(const rs_contact_table *t, int n, const double *place, rs_patch *patch, int *count, int *beyond)
{
	int worst = RS_OK;
	for (int k = 0; k < n; k++) {
		beyond[k] = -1;
		int status = rs_contact_lookup(t, place + RS_PLACE_SIZE * (size_t)k, patch + RS_ZONES * (size_t)k, count + k, beyond + k);
		if (status == RS_NOT_FINITE)
			beyond[k] = RS_PLACE_SIZE;
		worst = status != RS_OK ? status : worst;
	}
	return worst;
}
