/* SPDX-License-Identifier: BSD-3-Clause */
/* FASTSIM: Kalker's simplified theory with three flexibilities and a parabolic bound.
 *
 *   L1 = 8a/(3 C11 G)    L2 = 8a/(3 C22 G)    L3 = pi a sqrt(a/b)/(4 C23 G)
 *   dpx/dx = xi/L1 - phi y/L3    dpy/dx = eta/L2 + phi x/L3    |p| <= mu p0 (1 - (x/a)^2 - (y/b)^2)
 *
 * p is the traction on the wheel, 0 at the leading edge; p0 = 2N/(pi a b). Going against x from the leading
 * edge, a step that would pass the bound is shortened to it without change of direction. With
 * X = x/a, Y = y/b and p in units of mu p0 these become, in the numbers of creep.h,
 *
 *   dpx/dX = (3 pi/16) u1 - 2 (b/a) u3 Y    dpy/dX = (3 pi/16) u2 + 2 u3 X    |p| <= 1 - X^2 - Y^2
 *   h = (2/pi) int (px, py, sqrt(a/b) X py - sqrt(b/a) Y px) dX dY
 *
 * The strip at Y has the half length L = sqrt(1 - Y^2); with X = L t and p = L^2 P the bound is 1 - t^2 on every
 * strip. Strips are of equal width, a strip has cells of equal length, P is taken at their middles.
 * Slopes are those of this very algorithm; they jump by the weight of a cell where a cell begins to slip.
 *
 * J.J. Kalker, A fast algorithm for the simplified theory of rolling contact, Veh. Syst. Dyn. 11
 * (1982) 1-13; J.J. Kalker 1990, section 3.3.
 */
#include <string.h>

#include "../creep.h"
#include "masks.h"

#if defined(__GNUC__)
#define BLOCK 5 /* strips side by side: the square root of one hides behind the others */
typedef float single_lane __attribute__((vector_size(4 * RS_LANES), may_alias));
/* 1/sqrt(m) in single precision and one Newton step: 1e-14, exactly 1 for 1. For 1 <= m < 1e36. */
#define INVERSE_ROOT(to, m) \
	do { \
		single_lane s_ = __builtin_convertvector(m, single_lane); \
		for (int l_ = 0; l_ < RS_LANES; l_++) \
			((float *)&s_)[l_] = 1.0f / sqrtf(((float *)&s_)[l_]); \
		rs_lane r_ = __builtin_convertvector(s_, rs_lane); \
		(to) = r_ * (1.5 - 0.5 * (m) * r_ * r_); \
	} while (0)
#else
#define BLOCK 1
#define INVERSE_ROOT(to, m) ((to) = 1.0 / sqrt(m))
#endif

#if defined(__clang__)
#define UNROLL _Pragma("unroll")
#elif defined(__GNUC__)
#define UNROLL _Pragma("GCC unroll 5")
#else
#define UNROLL
#endif

typedef struct {
	rs_lane x, y;            /* P, or its slope with respect to one of the u */
	rs_lane step_x, step_y;  /* what a whole cell adds to it without spin's part in y */
	rs_lane sum_x, sum_y, sum_ty;
} traction;

typedef struct {
	rs_lane cx, cy, sx, sy;  /* dpx/dX = cx - sx Y, dpy/dX = cy + sy X */
} rates;

/* The leading edge, half a cell ahead: the first step is half a cell long. */
RS_INLINE void start(traction *p, const rates *rate, double Y, double L, double dt)
{
	p->step_x = (rate->cx - rate->sx * Y) * (dt / L);
	p->step_y = rate->cy * (dt / L);
	p->x = 0.5 * p->step_x;
	p->y = 0.5 * p->step_y;
	p->sum_x = p->sum_y = p->sum_ty = RS_ZERO;
}

/* Shortens P to the bound, and turns its slopes along: dP -> s (dP - n (n dP)) where it slips. */
RS_INLINE void bound(traction *p, int tangents, double inverse_square)
{
	rs_lane beyond = (p->x * p->x + p->y * p->y) * inverse_square - 1.0, m, s;
	mask_lane slips = NOT_NEGATIVE(beyond);
	m = 1.0 + KEEP(beyond, slips);
	INVERSE_ROOT(s, m);
	rs_lane turn = KEEP(s * s * inverse_square, slips);
	UNROLL
	for (int k = 1; k <= tangents; k++) {
		rs_lane along = (p[0].x * p[k].x + p[0].y * p[k].y) * turn;
		p[k].x = s * (p[k].x - along * p[0].x);
		p[k].y = s * (p[k].y - along * p[0].y);
	}
	p->x *= s;
	p->y *= s;
}

/* One cell of one strip; t its middle. */
RS_INLINE void step(traction *p, int tangents, const rs_lane *spin, double inverse_square, double t)
{
	UNROLL
	for (int k = 0; k <= tangents; k++) {
		p[k].x -= p[k].step_x;
		p[k].y -= p[k].step_y + spin[k];
	}
	bound(p, tangents, inverse_square);
	UNROLL
	for (int k = 0; k <= tangents; k++) {
		p[k].sum_x += p[k].x;
		p[k].sum_y += p[k].y;
		p[k].sum_ty += t * p[k].y;
	}
}

/* What one strip adds to h, or to a column of dh/du. */
RS_INLINE void collect(const rs_creep_input *in, const traction *p, double Y, double L, double weight,
                       rs_lane *h0, rs_lane *h1, rs_lane *h2)
{
	*h0 += weight * p->sum_x;
	*h1 += weight * p->sum_y;
	*h2 += weight * (L * in->root * p->sum_ty - Y / in->root * p->sum_x);
}

/* Strips first .. first + block - 1; rate[0] drives the traction, rate[1..tangents] its slopes. */
RS_INLINE void strips_together(const rs_creep_input *in, int tangents, int block, int first, const rates *rate,
                               rs_creep_value *out)
{
	double dt = 2.0 / in->cells, dY = 2.0 / in->strips, Y[BLOCK], L[BLOCK];
	traction p[BLOCK][4];
	UNROLL
	for (int j = 0; j < block; j++) {
		Y[j] = -1.0 + (first + j + 0.5) * dY;
		L[j] = sqrt(1.0 - Y[j] * Y[j]);
		UNROLL
		for (int k = 0; k <= tangents; k++)
			start(&p[j][k], &rate[k], Y[j], L[j], dt);
	}
	for (int i = 0; i < in->cells; i++) {
		double t = 1.0 - (i + 0.5) * dt, g = 1.0 - t * t, part = i ? dt * (t + 0.5 * dt) : 0.5 * dt * (1.0 - 0.25 * dt);
		rs_lane spin[4];
		UNROLL
		for (int k = 0; k <= tangents; k++)
			spin[k] = part * rate[k].sy;
		UNROLL
		for (int j = 0; j < block; j++)
			step(p[j], tangents, spin, 1.0 / (g * g), t);
	}
	UNROLL
	for (int j = 0; j < block; j++) {
		double weight = 2.0 / RS_PI * L[j] * L[j] * L[j] * dt * dY;
		collect(in, &p[j][0], Y[j], L[j], weight, &out->h[0], &out->h[1], &out->h[2]);
		UNROLL
		for (int k = 0; k < tangents; k++)
			collect(in, &p[j][k + 1], Y[j], L[j], weight, &out->d[0][k], &out->d[1][k], &out->d[2][k]);
	}
}

RS_CLONES void rs_creep_fastsim(const rs_creep_input *in, int slopes, rs_creep_value *out)
{
	rs_lane across = 2.0 / (in->root * in->root);
	double straight = 3.0 * RS_PI / 16.0;
	rates rate[4] = {
		{straight * in->u[0], straight * in->u[1], across * in->u[2], 2.0 * in->u[2]},
		{RS_ZERO + straight, RS_ZERO, RS_ZERO, RS_ZERO},
		{RS_ZERO, RS_ZERO + straight, RS_ZERO, RS_ZERO},
		{RS_ZERO, RS_ZERO, across, RS_ZERO + 2.0},
	};
	int strip = 0;
	memset(out, 0, sizeof *out);
	if (slopes) {
		for (; strip < in->strips; strip++)
			strips_together(in, 3, 1, strip, rate, out);
		return;
	}
	for (; strip + BLOCK <= in->strips; strip += BLOCK)
		strips_together(in, 0, BLOCK, strip, rate, out);
	for (; strip < in->strips; strip++)
		strips_together(in, 0, 1, strip, rate, out);
}
