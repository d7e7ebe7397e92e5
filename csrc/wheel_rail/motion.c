/* SPDX-License-Identifier: BSD-3-Clause */
/* Place of a wheel on its rail, and its motion against it, of eight wheels at once.
 *
 * The rail's head is a prism along e1 ~ (1, y', z') that has the rail's deviation (y, z) at the wheelset, turned about e1
 * by the cross level, sin rho = (z right - z left)/spacing:
 *
 *   e2 = cos rho h + sin rho (e1 x h)    e3 = -sin rho h + cos rho (e1 x h)    h ~ (-y', 1, 0)
 *
 * With D = centre of the wheelset - head of the rail's design place and deviation, in the same section, s the side,
 *
 *   y = s e2 D + spacing/2    drop = e3 D + r0 + sink    roll = s asin(axle e3)    yaw = s atan2(-axle e1, axle e2)
 *   f ~ axle x e3    d = f x axle
 *   dD/dt = (0, y' - V rail y', z' - V rail z') of the place;    v = V ex + w x (place) + q' of the material
 *
 * rail: left y z, right y z, then their derivatives d/ds (rs_track_rails_at).
 * The material of the rail rests, so its deviation moves the place of the contact and not the slip.
 */
#include <math.h>
#include <string.h>

#include "../trigonometry.h"
#include "motion.h"
#include "vectors.h"

enum { X, Y, Z, YAW, ROLL, SPIN };

/* What is given of eight wheels; rail: deviation of the own rail, y and z, and its slopes; cross level and its slope. */
typedef struct {
	rs_lane q[RS_COLUMNS], u[RS_COLUMNS], w[3], offset[3], spacing, raised;
	rs_lane own[2], slope[2], level, level_slope;
} given;

/* Lanes that are not used repeat the last wheel. */
RS_INLINE void gather(const rs_wheel_rail *wr, const double *q, const double *u, const double *w, const double *rail, int first, given *to,
                      rs_wheels *wheels)
{
	RS_EACH(l) {
		int number = first + l < 2 * wr->wheelsets ? first + l : 2 * wr->wheelsets - 1, k = number / 2, right = number % 2;
		const rs_wheelset *set = &wr->wheelset[k];
		const double *lie = rail ? rail + 8 * k : (const double[8]){0.0}, *own = lie + 2 * right;
		RS_AT(wheels->side, l) = right ? 1.0 : -1.0;
		for (int i = 0; i < RS_COLUMNS; i++) {
			RS_AT(to->q[i], l) = q[set->first + i];
			RS_AT(to->u[i], l) = u[set->first + i];
		}
		EACH_AXIS(i) {
			RS_AT(to->w[i], l) = w[3 * k + i];
			RS_AT(to->offset[i], l) = set->offset[i];
		}
		RS_AT(to->spacing, l) = set->spacing;
		RS_AT(to->raised, l) = set->wheel[right].r0 + set->wheel[right].sink;
		for (int i = 0; i < 2; i++) {
			RS_AT(to->own[i], l) = own[i];
			RS_AT(to->slope[i], l) = own[4 + i];
		}
		RS_AT(to->level, l) = lie[3] - lie[1];
		RS_AT(to->level_slope, l) = lie[7] - lie[5];
	}
}

/* Functions by their series, and by the C library where an argument is large. */
RS_INLINE void sine_and_cosine(const rs_lane *x, rs_lane *sine, rs_lane *cosine)
{
	RS_EACH(l)
		rs_sine_cosine_series(RS_OF(*x, l), &RS_AT(*sine, l), &RS_AT(*cosine, l));
	RS_EACH(l)
		if (fabs(RS_OF(*x, l)) > RS_SMALL_ANGLE)
			rs_sine_cosine(RS_OF(*x, l), &RS_AT(*sine, l), &RS_AT(*cosine, l));
}

RS_INLINE void arcsine(const rs_lane *x, rs_lane *angle)
{
	RS_EACH(l)
		RS_AT(*angle, l) = rs_arcsine_series(RS_OF(*x, l));
	RS_EACH(l)
		if (fabs(RS_OF(*x, l)) > RS_SMALL_RATIO)
			RS_AT(*angle, l) = asin(RS_OF(*x, l));
}

/* Angle of (x, y). */
RS_INLINE void arctangent(const rs_lane *y, const rs_lane *x, rs_lane *angle)
{
	rs_lane ratio = *y / *x;
	RS_EACH(l)
		RS_AT(*angle, l) = rs_arctangent_series(RS_OF(ratio, l));
	RS_EACH(l)
		if (RS_OF(*x, l) <= 0.0 || fabs(RS_OF(ratio, l)) > RS_SMALL_RATIO)
			RS_AT(*angle, l) = atan2(RS_OF(*y, l), RS_OF(*x, l));
}

/* Velocities of the axle; close and turn without the rail's part. */
RS_INLINE void axle_motion(const given *x, double V, rs_wheels *wheels)
{
	rs_motion_lanes *m = &wheels->at;
	rs_lane sy, cy, sr, cr, place[3] = {x->offset[0] + x->q[X], x->offset[1] + x->q[Y], x->offset[2] + x->q[Z]};
	sine_and_cosine(&x->q[YAW], &sy, &cy);
	sine_and_cosine(&x->q[ROLL], &sr, &cr);
	wheels->forward[0] = cy;
	wheels->forward[1] = sy;
	wheels->forward[2] = RS_ZERO;
	m->a[0] = -sy * cr;
	m->a[1] = cy * cr;
	m->a[2] = sr;
	CROSS(m->v, x->w, place);
	m->v[0] += V;
	EACH_AXIS(i) {
		m->v[i] += x->u[i];
		m->turn[i] = x->u[ROLL] * wheels->forward[i] + (i == 2 ? x->u[YAW] : RS_ZERO);
		m->omega[i] = x->w[i] + m->turn[i] + x->u[SPIN] * m->a[i];
	}
	m->close[0] = RS_ZERO;
	m->close[1] = x->u[Y];
	m->close[2] = x->u[Z];
}

RS_INLINE void rail_axes(const given *x, double V, rs_wheels *wheels)
{
	rs_lane flat = 1.0 + x->slope[0] * x->slope[0], steep = flat + x->slope[1] * x->slope[1], level, length, k[3];
	rs_lane sine = x->level / x->spacing, square = 1.0 - sine * sine, cosine;
	RS_SQRT(level, flat);
	RS_SQRT(length, steep);
	RS_SQRT(cosine, square);
	rs_lane per_level = 1.0 / level, per_length = 1.0 / length, h[3] = {-x->slope[0] * per_level, per_level, RS_ZERO};
	wheels->e1[0] = per_length;
	wheels->e1[1] = x->slope[0] * per_length;
	wheels->e1[2] = x->slope[1] * per_length;
	CROSS(k, wheels->e1, h);
	EACH_AXIS(i) {
		wheels->e2[i] = cosine * h[i] + sine * k[i];
		wheels->e3[i] = cosine * k[i] - sine * h[i];
	}
	wheels->turn_rate = V * x->level_slope / (x->spacing * cosine);
	wheels->D[0] = RS_ZERO;
	wheels->D[1] = x->offset[1] + x->q[Y] - 0.5 * x->spacing * wheels->side - x->own[0];
	wheels->D[2] = x->offset[2] + x->q[Z] - x->own[1];
}

RS_INLINE void place_on_rail(const given *x, rs_wheels *wheels)
{
	const rs_lane *axle = wheels->at.a;
	rs_lane rise = DOT(axle, wheels->e3), back = -DOT(axle, wheels->e1), along = DOT(axle, wheels->e2), angle;
	wheels->place[0] = wheels->side * DOT(wheels->e2, wheels->D) + 0.5 * x->spacing;
	wheels->place[2] = DOT(wheels->e3, wheels->D) + x->raised;
	arcsine(&rise, &angle);
	wheels->place[1] = wheels->side * angle;
	arctangent(&back, &along, &angle);
	wheels->place[3] = wheels->side * angle;
}

/* The rail's own motion under the wheel, and the wheel's axes. */
RS_INLINE void move_against_rail(const given *x, double V, rs_wheels *wheels)
{
	rs_motion_lanes *m = &wheels->at;
	rs_lane rail_turn[3], swept[3], out[3], square;
	EACH_AXIS(i)
		rail_turn[i] = wheels->turn_rate * wheels->e1[i];
	CROSS(swept, rail_turn, wheels->D);
	m->close[1] -= V * x->slope[0];
	m->close[2] -= V * x->slope[1];
	EACH_AXIS(i) {
		m->close[i] -= swept[i];
		m->turn[i] -= rail_turn[i];
	}
	CROSS(out, m->a, wheels->e3);
	square = DOT(out, out);
	RS_SQRT(wheels->length, square);
	rs_lane inverse = 1.0 / wheels->length;
	EACH_AXIS(i)
		m->f[i] = out[i] * inverse;
	CROSS(m->d, m->f, m->a);
}

RS_CLONES void rs_wheel_motion(const rs_wheel_rail *wr, const double *q, const double *u, double V, const double *w, const double *rail,
                               int first, rs_wheels *wheels)
{
	given x;
	gather(wr, q, u, w, rail, first, &x, wheels);
	axle_motion(&x, V, wheels);
	rail_axes(&x, V, wheels);
	place_on_rail(&x, wheels);
	move_against_rail(&x, V, wheels);
}
