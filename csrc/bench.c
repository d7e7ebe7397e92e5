/* SPDX-License-Identifier: BSD-3-Clause */
/* The virtual bench: one element law driven by imposed motion.
 *
 * Maxwell law, state s:  0 = g(e, v, s, w),  w = ds/dt, stepped by TR-BDF2 (Bank et al. 1985,
 * IEEE Trans. Electron Devices 32; L-stable, second order), gamma = 2 - sqrt 2:
 *   s1 = s0 + gamma h/2 (w0 + w1)                                       at t0 + gamma h
 *   s2 = s1/(gamma (2 - gamma)) - s0 (1 - gamma)^2/(gamma (2 - gamma)) + beta h w2,
 *        beta = (1 - gamma)/(2 - gamma)                                 at t0 + h
 * g grows with s, so each stage has one root: Newton, kept inside a bracket.
 * The derivative z = ds/ds(0), y = dw/ds(0) goes along, for Newton on the period map.
 */
#include <stddef.h>

#include "lanes.h"
#include "laws.h"

#define GAMMA 0.58578643762690495
#define BETA ((1.0 - GAMMA) / (2.0 - GAMMA))

enum { NEWTON_STEPS = 60, PERIODS = 200 };

typedef struct {
	double s, w, z, y;  /* m, m/s, 1, 1/s */
	double f;           /* N */
} bench_state;

static RS_NAME(law_value) value_of(const rs_law *law, double e, double v, double s, double w)
{
	RS_NAME(law_value) out = {0};
	RS_NAME(one_law)(law, e, v, s, w, &out);
	return out;
}

/* Root of g with s = base + a w (a = 0: s given, w wanted). size: a length of the problem. */
static int solve(const rs_law *law, double e, double v, double base, double a, double size, bench_state *now)
{
	double low = -INFINITY, high = INFINITY, w = now->w;
	double small = (a > 0.0 ? 1e-12 : 1e-9) * size, before = INFINITY;
	for (int k = 0; k < NEWTON_STEPS; k++) {
		RS_NAME(law_value) at = value_of(law, e, v, base + a * w, w);
		double slope = at.g_w + a * at.g_s;
		if (!isfinite(at.g))
			return RS_NOT_FINITE;
		if (!(slope > 0.0))
			return RS_NOT_CONVERGED;
		if (at.g > 0.0)
			high = w;
		else
			low = w;
		double move = -at.g / slope;
		/* A step quadratically small is the last one, also where roundoff takes it out of the bracket. */
		if (fabs(move) * (a > 0.0 ? a : 1.0) <= small) {
			now->w = w + move;
			now->s = base + a * now->w;
			return RS_OK;
		}
		int slow = fabs(move) > 0.5 * before || w + move <= low || w + move >= high;
		if (slow && isfinite(low) && isfinite(high))
			move = 0.5 * (low + high) - w;
		before = fabs(move);
		w += move;
	}
	return RS_NOT_CONVERGED;
}

/* Derivative of a solved stage: g_s z + g_w y = 0 with z = base + a y. */
static void differentiate(const rs_law *law, double e, double v, double base, double a, bench_state *now)
{
	RS_NAME(law_value) at = value_of(law, e, v, now->s, now->w);
	now->y = -at.g_s * base / (at.g_w + a * at.g_s);
	now->z = base + a * now->y;
	now->f = at.f;
}

static int step(const rs_law *law, double h, const double e[2], const double v[2], double size, bench_state *now)
{
	bench_state old = *now;
	double a = 0.5 * GAMMA * h, scale = 1.0 / (GAMMA * (2.0 - GAMMA)), back = (1.0 - GAMMA) * (1.0 - GAMMA) * scale;
	int status = solve(law, e[0], v[0], old.s + a * old.w, a, size, now);
	if (status)
		return status;
	differentiate(law, e[0], v[0], old.z + a * old.y, a, now);
	bench_state middle = *now;
	status = solve(law, e[1], v[1], scale * middle.s - back * old.s, BETA * h, size, now);
	if (!status)
		differentiate(law, e[1], v[1], scale * middle.z - back * old.z, BETA * h, now);
	return status;
}

/* Cubic of e and its rates at the ends; v straight between its values. */
static double hermite(double x, double h, double e0, double v0, double e1, double v1)
{
	double y = 1.0 - x;
	return y * y * ((1.0 + 2.0 * x) * e0 + x * h * v0) + x * x * ((3.0 - 2.0 * x) * e1 - y * h * v1);
}

static int interval(const rs_law *law, double h, double e0, double v0, double e1, double v1, int substeps,
                    double size, bench_state *now)
{
	for (int k = 0; k < substeps; k++) {
		double x1 = (k + GAMMA) / substeps, x2 = (k + 1.0) / substeps;
		double e[2] = {hermite(x1, h, e0, v0, e1, v1), hermite(x2, h, e0, v0, e1, v1)};
		double v[2] = {v0 + x1 * (v1 - v0), v0 + x2 * (v1 - v0)};
		int status = step(law, h / substeps, e, v, size, now);
		if (status)
			return status;
	}
	return RS_OK;
}

static double largest(const double *x, int n)
{
	double found = 0.0;
	for (int k = 0; k < n; k++)
		found = fabs(x[k]) > found ? fabs(x[k]) : found;
	return found;
}

/* State at the first sample. Where the force does not grow with speed, w is not told by s: it
 * begins with v, and the L-stable steps forget that. */
static void start(const rs_law *law, double e, double v, double s, double speed, bench_state *now)
{
	*now = (bench_state){.s = s, .w = v, .z = 1.0};
	if (solve(law, e, v, s, 0.0, speed, now)) {
		now->w = v;
		now->f = value_of(law, e, v, s, v).f;
	} else
		differentiate(law, e, v, 1.0, 0.0, now);
	now->s = s;
	now->z = 1.0;
}

int rs_bench_run(const rs_law *law, int n, const double *time, const double *e, const double *v, int substeps,
                 double s0, double *f, double *s, int *failed)
{
	(void)RS_NAME(law); /* the lanes of laws.h are not needed here */
	bench_state now = {.s = s0};
	double size = largest(e, n) + fabs(s0) + 1e-9;
	int status = RS_OK;
	for (*failed = 0; *failed < n; ++*failed) {
		int k = *failed;
		if (law->kind != RS_LAW_MAXWELL)
			now.f = value_of(law, e[k], v[k], 0.0, 0.0).f;
		else if (k == 0)
			start(law, e[0], v[0], s0, largest(v, n) + 1e-9, &now);
		else
			status = interval(law, time[k] - time[k - 1], e[k - 1], v[k - 1], e[k], v[k], substeps, size, &now);
		if (status)
			return status;
		if (!isfinite(now.f))
			return RS_NOT_FINITE;
		f[k] = now.f;
		s[k] = now.s;
		now.z = now.y = 0.0;
	}
	return RS_OK;
}

/* One turn from s0; where it ends and d(end)/d(s0). */
static int turn(const rs_law *law, int n, double h, const double *e, const double *v, int substeps, double size,
                double s0, double *f, double *s, bench_state *now)
{
	int status = RS_OK;
	start(law, e[0], v[0], s0, largest(v, n) + 1e-9, now);
	for (int k = 0; k < n && !status; k++) {
		int next = k + 1 < n ? k + 1 : 0;
		f[k] = now->f;
		s[k] = now->s;
		status = interval(law, h, e[k], v[k], e[next], v[next], substeps, size, now);
	}
	return status;
}

int rs_bench_cycles(const rs_law *law, int tests, int n, const double *period, const double *e, const double *v,
                    int substeps, double *f, double *s, int *failed)
{
	for (*failed = 0; *failed < tests; ++*failed) {
		size_t row = (size_t)*failed * (size_t)n;
		double h = period[*failed] / n, size = largest(e + row, n) + 1e-9, s0 = s[row];
		if (law->kind != RS_LAW_MAXWELL) {
			for (int k = 0; k < n; k++)
				f[row + k] = value_of(law, e[row + k], v[row + k], 0.0, 0.0).f;
			continue;
		}
		int left = PERIODS;
		double before = INFINITY;
		for (; left > 0; left--) {
			bench_state end;
			int status = turn(law, n, h, e + row, v + row, substeps, size, s0, f + row, s + row, &end);
			if (status)
				return status;
			double gap = end.s - s0;
			if (fabs(gap) <= 1e-8 * size)
				break;
			/* Newton on the period map, which contracts: 0 <= z < 1. Where curves have corners it may go to and fro: then
			 * the map itself, which always comes nearer. */
			int newton = end.z >= 0.0 && end.z < 0.999 && fabs(gap) < 0.5 * before;
			s0 += newton ? gap / (1.0 - end.z) : gap;
			before = newton || before == INFINITY ? fabs(gap) : INFINITY;
		}
		if (!left)
			return RS_NOT_CONVERGED;
	}
	return RS_OK;
}
