/* SPDX-License-Identifier: BSD-3-Clause */
/* FaStrip: exact two-dimensional rolling on every strip, FASTSIM for the direction of slip, elliptic bound.
 *
 * Tractions in units of mu p0, p0 = 3N/(2 pi a b), X = x/a, Y = y/b; the strip at Y has the half length
 * L = sqrt(1 - Y^2), X = L t. Strip theory, scaled so that its linear limit is Kalker's for C11, C22, C23 and C33:
 *
 *   xi' = -4 u1/(3 pi) + 16 sqrt(a/b) C33/(3 pi C23) u3 Y    eta' = -4 u2/(3 pi)    psi = -u3
 *   e = (xi'^2 + eta'^2)/(sqrt(eta'^2 + (1 - psi^2) xi'^2) - eta' psi)    tau = e/L
 *   adhesion, t > 2 tau - 1:  p = (xi' D, eta' D + psi L sqrt(1 - t^2))
 *   D = 2 sqrt(1 - t)/(sqrt(1 + t) + sqrt(1 + t - 2 tau))
 *   slip behind it:  p = n L sqrt(1 - t^2), n the direction FASTSIM finds there
 *   h = (3/(2 pi)) int (px, py, sqrt(a/b) X py - sqrt(b/a) Y px) dX dY
 *
 * D is the difference of the two semi-ellipses of Carter's solution over tau, free of cancellation; adhesion and the
 * weights of the cells in slip are integrated exactly, so h is continuous in u. Strips at Y = cos((j + 1/2) pi/n).
 *
 * Ours, where the law as implemented in CONTACT (E. Vollebregt) jumps:
 * - With |psi| > 1 strip theory may pass the bound at the leading edge, the more the larger R = (psi^2 - 1) L (1 + |1 - e/L|)/d,
 *   d the denominator of e; and with d < 0 it has no solution. Towards |psi| = 1 its solution goes to full slip if eta' psi >= 0,
 *   to full adhesion without creepage. So it has the weight w = S(2 (1 - R)) S(2 r), S(z) = z^2 (3 - 2 z) within 0..1,
 *   r = (max(d, 0) + max(1 - psi^2, 0)/2)/(|(xi', eta')| + 1/2), and FASTSIM's tractions 1 - w.
 * - Where a strip slips fully, slip is against the creepage (one flexibility), where it sticks against linear theory (three):
 *   C11, C22 and 32 C23/(3 pi sqrt(a/b)) count with w (1 - tau^4), their mean with the rest. tau is 1 from e = L on. The
 *   power was chosen on the exact solutions of docs/creep_forces.md.
 *
 * After M.Sh. Sichani, R. Enblom, M. Berg, An alternative to FASTSIM for tangential solution of the wheel-rail contact,
 * Veh. Syst. Dyn. 54(6) (2016), and J.J. Kalker's strip theory with slip and spin (1967).
 */
#include <string.h>

#include "../creep.h"
#include "masks.h"

#define KNOWN_CELLS 64 /* cells kept in a table; beyond, each strip computes them again */

typedef struct {
	double t, step, middle, bound;     /* middle of the cell; way from the last one, and its middle; sqrt(1 - t^2) */
	double from, to;                   /* int sqrt(1 - t^2) from -1 to both ends */
	double moment_from, moment_to;     /* int t sqrt(1 - t^2) likewise */
} cell;

/* A value and its slopes with respect to u. */
typedef struct {
	rs_lane v, d[3];
} number;

typedef struct {
	number xi, eta, psi;                          /* primed creepages of the strip */
	number tau, weight;
	number area, moment;                          /* of sqrt(1 - t^2), from the trailing edge to the end of slip */
	number force, arm;                            /* int D, int t D over the adhesion */
	number rate_x, rate_y, rate_t;                /* FASTSIM: dpx/dX = rate_x, dpy/dX = rate_y + rate_t t */
} strip;

typedef struct {
	number px, py;                                /* FASTSIM */
	number slip_x, slip_y, slip_ty, own_x, own_y, own_ty;
} sums;

static double area_to(double t)
{
	double angle = acos(t < -1.0 ? 1.0 : t > 1.0 ? -1.0 : -t);
	return 0.5 * (angle - sin(angle) * cos(angle));
}

static cell cell_at(int i, int cells)
{
	double dt = 2.0 / cells, t = 1.0 - (i + 0.5) * dt, low = t - 0.5 * dt, high = t + 0.5 * dt;
	double l = fmax(0.0, 1.0 - low * low), h = fmax(0.0, 1.0 - high * high), step = i ? dt : 0.5 * dt;
	return (cell){t, step, t + 0.5 * step, sqrt(1.0 - t * t), area_to(low), area_to(high),
	              -l * sqrt(l) / 3.0, -h * sqrt(h) / 3.0};
}

/* A(tau) = int sqrt(1 - t^2) from t = -1 to 2 tau - 1 for tau up to 1/2, over tau^(3/2): polynomial in 4 tau - 1,
 * good to 1e-14. */
RS_INLINE void segment(const rs_lane *tau, rs_lane *to)
{
	static const double C[] = {
		2.456739397217513, -0.2210074806885136, -0.01241578373414067, -0.0015524264543622683,
		-0.0002582086742973086, -5.0085197704449985e-05, -1.0707783690583908e-05, -2.448815711694343e-06,
		-5.884955334448827e-07, -1.4688831512690903e-07, -3.770516632765861e-08, -9.94229688317622e-09,
		-2.7916442952418907e-09, -7.588691652527231e-10, -1.0781570847585108e-10, -3.6333001732503716e-11,
		-5.788855706791884e-11, -1.1638370528432365e-11, 5.585441403363485e-12};
	rs_lane x = 4.0 * *tau - 1.0, g = RS_ZERO + C[sizeof C / sizeof *C - 1];
	for (int k = (int)(sizeof C / sizeof *C) - 2; k >= 0; k--)
		g = g * x + C[k];
	*to = g;
}

/* All integrals over one strip that follow from tau, by the chain rule. */
RS_INLINE void integrals(int tangents, strip *s)
{
	rs_lane tau = s->tau.v, rest = 1.0 - tau, root, over, both;
	mask_lane far = NOT_NEGATIVE(tau - 0.5);
	rs_lane small = SELECT(far, rest, tau), near, part;
	RS_SQRT(root, tau);
	RS_SQRT(over, rest);
	RS_SQRT(near, small);
	both = root * over;
	segment(&small, &part);
	part *= near; /* A/small */
	rs_lane area = small * part, ratio;
	area = SELECT(far, RS_PI / 2 - area, area);
	ratio = SELECT(far, area / tau, part);
	s->area.v = area;
	s->moment.v = -8.0 / 3.0 * both * both * both;
	s->force.v = RS_PI - RS_PI / 2 * tau - ratio;
	s->arm.v = 8.0 / 3.0 * root * rest * over - RS_PI / 2 * rest * rest;
	rs_lane slope_force = -RS_PI / 2 - 4.0 * over / root + ratio / tau;
	rs_lane slope_arm = 4.0 / 3.0 * over * (rest / root - 3.0 * root) + RS_PI * rest;
	for (int k = 0; k < tangents; k++) {
		s->area.d[k] = 4.0 * both * s->tau.d[k];
		s->moment.d[k] = 4.0 * both * (2.0 * tau - 1.0) * s->tau.d[k];
		s->force.d[k] = slope_force * s->tau.d[k];
		s->arm.d[k] = slope_arm * s->tau.d[k];
	}
}

#define LEAST_TAU 1e-30          /* slopes go with 1/sqrt(tau) times a creepage */
#define LEAST_DENOMINATOR 1e-200 /* below it both creepages are zero, or |psi| > 1 and all slips */

#define SMALL 0.5 /* creepages, of what makes the whole strip slip, that count as few beside the spin */

/* S and its slope. */
RS_INLINE void smooth(const rs_lane *of, rs_lane *to, rs_lane *slope)
{
	rs_lane z = *of;
	mask_lane inside = NOT_NEGATIVE(z) & NOT_NEGATIVE(1.0 - z);
	z = KEEP(z, inside) + KEEP(RS_ZERO + 1.0, NOT_NEGATIVE(z - 1.0) & ~inside);
	*to = z * z * (3.0 - 2.0 * z);
	*slope = 6.0 * z * (1.0 - z);
}

/* Where slip begins, and how much strip theory counts. */
RS_INLINE void adhesion(int tangents, double L, strip *s)
{
	rs_lane xi = s->xi.v, eta = s->eta.v, psi = s->psi.v, left = 1.0 - psi * psi, root, q = xi * xi + eta * eta;
	rs_lane square = eta * eta + left * xi * xi, den, e, B, R, z, size;
	mask_lane real = NOT_NEGATIVE(square), below = NOT_NEGATIVE(left), some, short_;
	square = KEEP(square, real);
	RS_SQRT(root, square);
	den = root - eta * psi;
	RS_SQRT(size, q);
	mask_lane solved = NOT_NEGATIVE(den);
	rs_lane over = 1.0 / (size + SMALL), r = (KEEP(den, solved) + SMALL * KEEP(left, below)) * over, twice = 2.0 * r, fade, fade_slope;
	smooth(&twice, &fade, &fade_slope);
	some = real & NOT_NEGATIVE(den - LEAST_DENOMINATOR);
	den = SELECT(some, den, RS_ZERO + 1.0);
	e = KEEP(q / den, some) * (1.0 / L) + LEAST_TAU;
	short_ = NOT_NEGATIVE(1.0 - e);
	s->tau.v = SELECT(short_, e, RS_ZERO + 1.0);
	rs_lane beyond = e - 1.0, sign = 1.0 - 2.0 * KEEP(RS_ZERO + 1.0, short_), C = 1.0 + sign * beyond;
	B = -left * L / den;
	R = B * C;
	/* without a solution: all sticks under spin alone below 1, all is FASTSIM's above */
	z = KEEP(2.0 * (1.0 - R), some) + KEEP(RS_ZERO + 1.0, below & ~some);
	rs_lane holds, slope;
	smooth(&z, &holds, &slope);
	slope = KEEP(-2.0 * slope * fade, some);
	s->weight.v = holds * fade;
	rs_lane along = over * r / (size + 1e-200);
	rs_lane half = KEEP(0.5 / (root + 1e-200), real);
	for (int k = 0; k < tangents; k++) {
		rs_lane dx = s->xi.d[k], dy = s->eta.d[k], ds = s->psi.d[k];
		rs_lane droot = half * (2.0 * eta * dy + 2.0 * xi * (left * dx - psi * xi * ds));
		rs_lane dden = droot - dy * psi - eta * ds;
		rs_lane de = KEEP((2.0 * (xi * dx + eta * dy) - q / den * dden) / den, some) * (1.0 / L);
		rs_lane dB = (2.0 * psi * ds * L - B * dden) / den;
		s->tau.d[k] = KEEP(de, short_);
		rs_lane dr = (KEEP(dden, solved) - 2.0 * SMALL * KEEP(psi * ds, below)) * over - along * (xi * dx + eta * dy);
		s->weight.d[k] = slope * KEEP(dB * C + B * sign * de, some) + 2.0 * holds * fade_slope * dr;
	}
}

/* FASTSIM's rates in the units above: (pi/4) times the coefficients that act, times the creepages. */
RS_INLINE void rates(const rs_creep_input *in, int tangents, double Y, double L, strip *s)
{
	rs_lane own[3] = {in->c11, in->c22, 32.0 / (3.0 * RS_PI) * in->c23 / in->root};
	rs_lane mean = (own[0] + own[1] + own[2]) * (1.0 / 3.0), c[3];
	rs_lane cube = s->tau.v * s->tau.v * s->tau.v, left = 1.0 - cube * s->tau.v, part = s->weight.v * left;
	rs_lane creep[3] = {in->u[0] / in->c11, in->u[1] / in->c22, in->u[2] / in->c23};
	rs_lane per[3] = {1.0 / in->c11, 1.0 / in->c22, 1.0 / in->c23};
	for (int j = 0; j < 3; j++)
		c[j] = RS_PI / 4 * (mean + part * (own[j] - mean));
	s->rate_x.v = c[0] * creep[0] - c[2] * creep[2] * Y / in->root;
	s->rate_y.v = c[1] * creep[1];
	s->rate_t.v = c[2] * creep[2] * in->root * L;
	for (int k = 0; k < tangents; k++) {
		rs_lane dpart = s->weight.d[k] * left - 4.0 * s->weight.v * cube * s->tau.d[k], d[3];
		for (int j = 0; j < 3; j++)
			d[j] = RS_PI / 4 * dpart * (own[j] - mean) * creep[j];
		d[k] += c[k] * per[k];
		s->rate_x.d[k] = d[0] - d[2] * Y / in->root;
		s->rate_y.d[k] = d[1];
		s->rate_t.d[k] = d[2] * in->root * L;
	}
}

/* One cell: FASTSIM's traction, its share of slip behind the adhesion, its share of FASTSIM alone. */
RS_INLINE void step(int tangents, const cell *c, const strip *s, sums *p)
{
	rs_lane x = p->px.v - c->step * (s->rate_x.v), y = p->py.v - c->step * (s->rate_y.v + c->middle * s->rate_t.v);
	/* 1e-40: at no creepage the direction has no slope, and what is in slip, LEAST_TAU^(3/2), no weight */
	rs_lane square = x * x + y * y + 1e-40, size, inverse, nx, ny;
	RS_SQRT(size, square);
	inverse = 1.0 / size;
	nx = x * inverse;
	ny = y * inverse;
	mask_lane slips = NOT_NEGATIVE(size - c->bound);
	mask_lane begun = NOT_NEGATIVE(s->area.v - c->from), whole = NOT_NEGATIVE(s->area.v - c->to);
	mask_lane broken = begun & ~whole;
	rs_lane share = KEEP(RS_ZERO + (c->to - c->from), whole) + KEEP(s->area.v - c->from, broken);
	rs_lane turn = KEEP(RS_ZERO + (c->moment_to - c->moment_from), whole) + KEEP(s->moment.v - c->moment_from, broken);
	double all = (c->to - c->from) / c->bound, all_turn = (c->moment_to - c->moment_from) / c->bound;
	for (int k = 0; k < tangents; k++) {
		rs_lane dx = p->px.d[k] - c->step * s->rate_x.d[k];
		rs_lane dy = p->py.d[k] - c->step * (s->rate_y.d[k] + c->middle * s->rate_t.d[k]);
		rs_lane along = nx * dx + ny * dy, tx = inverse * (dx - along * nx), ty = inverse * (dy - along * ny);
		rs_lane dshare = KEEP(s->area.d[k], broken), dturn = KEEP(s->moment.d[k], broken);
		p->slip_x.d[k] += share * tx + dshare * nx;
		p->slip_y.d[k] += share * ty + dshare * ny;
		p->slip_ty.d[k] += turn * ty + dturn * ny;
		p->px.d[k] = SELECT(slips, c->bound * tx, dx);
		p->py.d[k] = SELECT(slips, c->bound * ty, dy);
		p->own_x.d[k] += all * p->px.d[k];
		p->own_y.d[k] += all * p->py.d[k];
		p->own_ty.d[k] += all_turn * p->py.d[k];
	}
	p->slip_x.v += share * nx;
	p->slip_y.v += share * ny;
	p->slip_ty.v += turn * ny;
	p->px.v = SELECT(slips, c->bound * nx, x);
	p->py.v = SELECT(slips, c->bound * ny, y);
	p->own_x.v += all * p->px.v;
	p->own_y.v += all * p->py.v;
	p->own_ty.v += all_turn * p->py.v;
}

/* to += factor (strip theory and its slip, weighed against FASTSIM): creepage force + spin L area + slip. */
RS_INLINE void mix(int tangents, double L, const strip *s, const number *creepage, const number *force, int spin,
                   double total, const number *taken, const number *slip, const number *own, number *to)
{
	const number *w = &s->weight;
	double with = spin ? L : 0.0;
	rs_lane rest = total - taken->v;
	rs_lane theory = creepage->v * force->v + with * s->psi.v * rest + L * slip->v, alone = L * own->v;
	to->v = alone + w->v * (theory - alone);
	for (int k = 0; k < tangents; k++) {
		rs_lane d = creepage->d[k] * force->v + creepage->v * force->d[k] + L * slip->d[k];
		d += with * (s->psi.d[k] * rest - s->psi.v * taken->d[k]);
		to->d[k] = L * own->d[k] + w->v * (d - L * own->d[k]) + w->d[k] * (theory - alone);
	}
}

RS_INLINE void one_strip(const rs_creep_input *in, int tangents, int j, const cell *table, rs_creep_value *out)
{
	double angle = (j + 0.5) * RS_PI / in->strips, Y = cos(angle), L = sin(angle);
	double weight = 1.5 / RS_PI * RS_PI / in->strips * L * L;
	rs_lane spin = 16.0 / (3.0 * RS_PI) * Y * in->root * in->c33 / in->c23;
	strip s;
	sums p;
	number x, y, ty;
	memset(&s, 0, sizeof s);
	memset(&p, 0, sizeof p);
	s.xi.v = -4.0 / (3.0 * RS_PI) * in->u[0] + spin * in->u[2];
	s.eta.v = -4.0 / (3.0 * RS_PI) * in->u[1];
	s.psi.v = -in->u[2];
	s.xi.d[0] = s.eta.d[1] = RS_ZERO - 4.0 / (3.0 * RS_PI);
	s.xi.d[2] = spin;
	s.psi.d[2] = RS_ZERO - 1.0;
	adhesion(tangents, L, &s);
	integrals(tangents, &s);
	rates(in, tangents, Y, L, &s);
	for (int i = 0; i < in->cells; i++) {
		cell other;
		if (i >= KNOWN_CELLS)
			other = cell_at(i, in->cells);
		step(tangents, i < KNOWN_CELLS ? &table[i] : &other, &s, &p);
	}
	mix(tangents, L, &s, &s.xi, &s.force, 0, 0.0, &s.area, &p.slip_x, &p.own_x, &x);
	mix(tangents, L, &s, &s.eta, &s.force, 1, RS_PI / 2, &s.area, &p.slip_y, &p.own_y, &y);
	mix(tangents, L, &s, &s.eta, &s.arm, 1, 0.0, &s.moment, &p.slip_ty, &p.own_ty, &ty);
	out->h[0] += weight * x.v;
	out->h[1] += weight * y.v;
	out->h[2] += weight * (L * in->root * ty.v - Y / in->root * x.v);
	for (int k = 0; k < tangents; k++) {
		out->d[0][k] += weight * x.d[k];
		out->d[1][k] += weight * y.d[k];
		out->d[2][k] += weight * (L * in->root * ty.d[k] - Y / in->root * x.d[k]);
	}
}

RS_CLONES void rs_creep_fastrip(const rs_creep_input *in, int slopes, rs_creep_value *out)
{
	cell table[KNOWN_CELLS];
	memset(out, 0, sizeof *out);
	for (int i = 0; i < KNOWN_CELLS && i < in->cells; i++)
		table[i] = cell_at(i, in->cells);
	for (int j = 0; j < in->strips; j++)
		if (slopes)
			one_strip(in, 3, j, table, out);
		else
			one_strip(in, 0, j, table, out);
}
