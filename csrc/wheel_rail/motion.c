/* SPDX-License-Identifier: BSD-3-Clause */
/* Place of a wheel on its rail, and its motion against it.
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

static const double UP_TO_DOWN[3] = {0.0, 0.0, 1.0};

typedef struct {
	double e1[3];
	double D[3];          /* from the rail's head to the wheelset's centre */
	double turn_rate;     /* of the rail about e1, rad/s */
} rail_head;

RS_INLINE void axle_axes(const double *q, rs_axle_state *axle)
{
	double sy, cy, sr, cr;
	rs_sine_cosine(q[YAW], &sy, &cy);
	rs_sine_cosine(q[ROLL], &sr, &cr);
	double forward[3] = {cy, sy, 0.0}, along[3] = {-sy * cr, cy * cr, sr};
	memcpy(axle->forward, forward, sizeof forward);
	memcpy(axle->axle, along, sizeof along);
}

/* Velocities that both wheels share; close and turn without the rail's part. */
RS_INLINE void axle_velocities(const rs_wheelset *set, const double *q, const double *u, double V, const double *w,
                            const rs_axle_state *axle, rs_motion *m)
{
	double place[3] = {set->offset[0] + q[X], set->offset[1] + q[Y], set->offset[2] + q[Z]};
	CROSS(m->v, w, place);
	m->v[0] += V;
	EACH_AXIS(i) {
		m->v[i] += u[i];
		m->turn[i] = u[YAW] * UP_TO_DOWN[i] + u[ROLL] * axle->forward[i];
		m->omega[i] = w[i] + m->turn[i] + u[SPIN] * axle->axle[i];
		m->a[i] = axle->axle[i];
	}
	m->close[0] = 0.0;
	m->close[1] = u[Y];
	m->close[2] = u[Z];
}

/* Tangents of axle_axes and axle_velocities. */
RS_INLINE void axle_tangents(const double *u, const double *w, const double *seed, rs_axle_state *axle, rs_motion *to)
{
	double cq = seed[0], cu = seed[1], yawed[3], turned[3], rolled[3];
	memset(to, 0, RS_COLUMNS * sizeof *to);
	memset(axle->forward_to, 0, sizeof axle->forward_to);
	memset(axle->axle_to, 0, sizeof axle->axle_to);
	for (int k = 0; k < 3; k++) {
		double unit[3] = {k == 0, k == 1, k == 2};
		CROSS(to[k].v, w, unit);
		EACH_AXIS(i)
			to[k].v[i] = cq * to[k].v[i] + cu * unit[i];
		to[k].close[k] = k ? cu : 0.0;
	}
	CROSS(yawed, UP_TO_DOWN, axle->forward);
	CROSS(turned, UP_TO_DOWN, axle->axle);
	CROSS(rolled, axle->forward, axle->axle);
	EACH_AXIS(i) {
		axle->forward_to[YAW][i] = cq * yawed[i];
		axle->axle_to[YAW][i] = to[YAW].a[i] = cq * turned[i];
		axle->axle_to[ROLL][i] = to[ROLL].a[i] = cq * rolled[i];
		to[YAW].turn[i] = cu * UP_TO_DOWN[i] + cq * u[ROLL] * yawed[i];
		to[ROLL].turn[i] = cu * axle->forward[i];
		to[YAW].omega[i] = to[YAW].turn[i] + cq * u[SPIN] * turned[i];
		to[ROLL].omega[i] = to[ROLL].turn[i] + cq * u[SPIN] * rolled[i];
		to[SPIN].omega[i] = cu * axle->axle[i];
	}
}

RS_INLINE void rail_axes(const rs_wheelset *set, const double *q, double V, const double *rail, rs_wheel_state *wheel,
                      rail_head *head)
{
	const double *own = rail + (wheel->side > 0.0 ? 2 : 0), *slope = own + 4;
	double level = sqrt(1.0 + slope[0] * slope[0]), length = sqrt(level * level + slope[1] * slope[1]);
	double h[3] = {-slope[0] / level, 1.0 / level, 0.0}, k[3], spacing = set->spacing;
	double sine = (rail[3] - rail[1]) / spacing, cosine = sqrt(1.0 - sine * sine);
	head->e1[0] = 1.0 / length;
	head->e1[1] = slope[0] / length;
	head->e1[2] = slope[1] / length;
	CROSS(k, head->e1, h);
	EACH_AXIS(i) {
		wheel->e2[i] = cosine * h[i] + sine * k[i];
		wheel->e3[i] = cosine * k[i] - sine * h[i];
	}
	head->turn_rate = V * (rail[7] - rail[5]) / (spacing * cosine);
	head->D[0] = 0.0;
	head->D[1] = set->offset[1] + q[Y] - 0.5 * spacing * wheel->side - own[0];
	head->D[2] = set->offset[2] + q[Z] - own[1];
}

RS_INLINE void place_on_rail(const rs_wheelset *set, const rail_head *head, rs_wheel_state *wheel)
{
	const rs_wheel *given = &set->wheel[wheel->side > 0.0];
	const double *axle = wheel->at.a;
	wheel->place[0] = wheel->side * DOT(wheel->e2, head->D) + 0.5 * set->spacing;
	wheel->place[1] = wheel->side * rs_arcsine(DOT(axle, wheel->e3));
	wheel->place[2] = DOT(wheel->e3, head->D) + given->r0 + given->sink;
	wheel->place[3] = wheel->side * rs_arctangent(-DOT(axle, head->e1), DOT(axle, wheel->e2));
}

/* The rail's own motion under the wheel, and the wheel's axes. */
RS_INLINE double move_against_rail(double V, const double *slope, const rail_head *head, rs_wheel_state *wheel)
{
	rs_motion *m = &wheel->at;
	double rail_turn[3], swept[3], out[3];
	EACH_AXIS(i)
		rail_turn[i] = head->turn_rate * head->e1[i];
	CROSS(swept, rail_turn, head->D);
	m->close[1] -= V * slope[0];
	m->close[2] -= V * slope[1];
	EACH_AXIS(i) {
		m->close[i] -= swept[i];
		m->turn[i] -= rail_turn[i];
	}
	CROSS(out, m->a, wheel->e3);
	double length = sqrt(DOT(out, out));
	EACH_AXIS(i)
		m->f[i] = out[i] / length;
	CROSS(m->d, m->f, m->a);
	return length;
}

/* length: |axle x e3|, the cosine of the roll against the rail. */
RS_INLINE void wheel_tangents(const rail_head *head, double cq, double length, rs_wheel_state *wheel)
{
	const rs_motion *m = &wheel->at;
	double rail_turn[3], a1 = DOT(m->a, head->e1), a2 = DOT(m->a, wheel->e2);
	EACH_AXIS(i)
		rail_turn[i] = head->turn_rate * head->e1[i];
	for (int k = 0; k < RS_COLUMNS; k++) {
		rs_motion *to = &wheel->to[k];
		double out[3], *place = wheel->place_to[k];
		CROSS(out, to->a, wheel->e3);
		double along = DOT(m->f, out);
		EACH_AXIS(i)
			to->f[i] = (out[i] - along * m->f[i]) / length;
		CROSS(to->d, to->f, m->a);
		ADD_CROSS(to->d, m->f, to->a);
		place[1] = wheel->side * DOT(to->a, wheel->e3) / length;
		place[3] = wheel->side * (a1 * DOT(to->a, wheel->e2) - a2 * DOT(to->a, head->e1)) / (a1 * a1 + a2 * a2);
		place[0] = k == Y || k == Z ? wheel->side * cq * wheel->e2[k] : 0.0;
		place[2] = k == Y || k == Z ? cq * wheel->e3[k] : 0.0;
		if (k == Y || k == Z) {
			double unit[3] = {0.0, cq * (k == Y), cq * (k == Z)}, swept[3];
			CROSS(swept, rail_turn, unit);
			EACH_AXIS(i)
				to->close[i] -= swept[i];
		}
	}
}

RS_CLONES void rs_axle_motion(const rs_wheelset *set, const double *q, const double *u, double V, const double *w,
                                        const double *rail, const double *seed, rs_axle_state *axle)
{
	rs_motion shared, to[RS_COLUMNS];
	memset(&shared, 0, sizeof shared);
	axle_axes(q, axle);
	axle_velocities(set, q, u, V, w, axle, &shared);
	if (seed)
		axle_tangents(u, w, seed, axle, to);
	for (int k = 0; k < 2; k++) {
		rs_wheel_state *wheel = &axle->wheel[k];
		rail_head head;
		wheel->side = k ? 1.0 : -1.0;
		wheel->at = shared;
		rail_axes(set, q, V, rail, wheel, &head);
		place_on_rail(set, &head, wheel);
		double length = move_against_rail(V, rail + 4 + 2 * k, &head, wheel);
		if (!seed)
			continue;
		memcpy(wheel->to, to, sizeof to);
		wheel_tangents(&head, seed[0], length, wheel);
	}
}
