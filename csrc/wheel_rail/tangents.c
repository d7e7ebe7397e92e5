/* SPDX-License-Identifier: BSD-3-Clause */
/* Tangents of motion.c, column by column, one wheelset after the other: they are wanted for new factors only. */
#include <string.h>

#include "motion.h"
#include "vectors.h"

enum { X, Y, Z, YAW, ROLL, SPIN };

static const double UP_TO_DOWN[3] = {0.0, 0.0, 1.0};

typedef struct {
	double e1[3];
	double turn_rate;     /* of the rail about e1, rad/s */
	double length;        /* |axle x e3|, the cosine of the roll against the rail */
} rail_head;

/* Of the axle's axes and velocities, which both wheels share. */
static void axle_tangents(const double *u, const double *w, const double *seed, rs_axle_state *axle, rs_motion *to)
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

static void take(const rs_lane *lanes, int count, int l, double *to)
{
	for (int k = 0; k < count; k++)
		to[k] = RS_OF(lanes[k], l);
}

static void wheel_tangents(const rail_head *head, double cq, rs_wheel_state *wheel)
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
			to->f[i] = (out[i] - along * m->f[i]) / head->length;
		CROSS(to->d, to->f, m->a);
		ADD_CROSS(to->d, m->f, to->a);
		place[1] = wheel->side * DOT(to->a, wheel->e3) / head->length;
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

void rs_axle_tangents(const rs_wheels *eights, int number, const double *u, const double *w, const double *seed, rs_axle_state *axle)
{
	rs_motion to[RS_COLUMNS];
	axle_tangents(u, w, seed, axle, to);
	for (int k = 0; k < 2; k++) {
		rs_wheel_state *wheel = &axle->wheel[k];
		const rs_wheels *wheels = eights + (number + k) / RS_LANES;
		rail_head head;
		int l = (number + k) % RS_LANES;
		wheel->side = RS_OF(wheels->side, l);
		take((const rs_lane *)&wheels->at, RS_MOTION_SIZE, l, (double *)&wheel->at);
		take(wheels->e2, 3, l, wheel->e2);
		take(wheels->e3, 3, l, wheel->e3);
		take(wheels->e1, 3, l, head.e1);
		head.turn_rate = RS_OF(wheels->turn_rate, l);
		head.length = RS_OF(wheels->length, l);
		memcpy(wheel->to, to, sizeof to);
		wheel_tangents(&head, seed[0], wheel);
	}
}
