/* SPDX-License-Identifier: BSD-3-Clause */
/* One step: predict, iterate with factors that are kept while they serve, accept.
 *
 * An iteration changes q_f by d, u_f by d/tau, a_m by d/tau^2. It has converged when what is left,
 * d c/(1 - c) with c the contraction seen with these factors, is below tolerance tau^2: the
 * acceleration left wrong is then below the tolerance, or a thousandth of the largest one if that is less. Newton with kept factors converges
 * linearly; one that contracts less than fourfold gets new factors, and a step that does not
 * converge with factors of its own state has failed.
 */
#include <limits.h>
#include <math.h>
#include <string.h>

#include "dispatch.h"
#include "integrator.h"

/* Contraction above which new factors are cheaper than more iterations; iterations with one set of factors; sets a step. */
static const double SLOW = 0.25;

/* Contraction above which the next step begins with new slopes of the wheels. */
static const double RENEW = 0.01;

/* Tolerance against the largest acceleration, and its least value, m/s^2: far above what rounding of forces leaves. */
static const double FRACTION = 1e-3, LEAST_TOLERANCE = 1e-6;

/* A step of one iteration sees no contraction: factors serve less well from step to step, and rounding may look like quick
 * convergence. So what was seen last is taken to grow, until a second iteration looks again. */
static const double AGEING = 1.05, LEAST = 1e-4;
enum { ITERATIONS = 5, SETS = 8 };

/* Factors of an iteration: those there are, with new slopes of the wheels, all new. */
enum { KEPT = 0, WHEELS = 1, ALL = 2 };

/* The arrays of a loop do not overlap: restrict of a local pointer does not tell the compiler so. */
#if defined(__GNUC__) && !defined(__clang__)
#define RS_APART _Pragma("GCC ivdep")
#else
#define RS_APART
#endif

typedef struct {
	double h, tau;
	double seed[3];
} scheme;

/* Largest size among numbers, infinite where any is not a number. Sizes compare as their bits do, and those of what is no number are
 * the largest. */
static RS_ALWAYS_INLINE double largest_of(const double *x, int count)
{
	enum { WIDTH = 8 };
	long long most[WIDTH] = {0}, bits[WIDTH], all = 0;
	double size;
	int k = 0;
	for (; k + WIDTH <= count; k += WIDTH) {
		memcpy(bits, x + k, sizeof bits);
		for (int i = 0; i < WIDTH; i++) {
			bits[i] &= LLONG_MAX;
			most[i] = bits[i] > most[i] ? bits[i] : most[i];
		}
	}
	for (int i = 0; i < WIDTH; i++)
		all = most[i] > all ? most[i] : all;
	for (; k < count; k++) {
		memcpy(bits, x + k, sizeof *bits);
		bits[0] &= LLONG_MAX;
		all = bits[0] > all ? bits[0] : all;
	}
	memcpy(&size, &all, sizeof size);
	return isfinite(size) ? size : INFINITY;
}

/* y'_n+1 is extrapolated along the last step; everything else follows. */
RS_CLONES
static void predict(rs_integrator *it, double h)
{
	int n = it->n, second = it->second;
	double *restrict q = it->system->model->state, *restrict u = q + it->system->model->stride, *restrict a = u + it->system->model->stride;
	const double *restrict qn = it->q, *restrict un = it->u, *restrict an = it->a, *restrict vn = it->v, *restrict before = it->before;
	double along = it->before_step > 0.0 ? h / it->before_step : 0.0;
	double am = it->am, af = it->af, per_am = 1.0 / am, old = h * (1.0 - it->gamma), new = h * it->gamma;
	RS_APART
	for (int k = 0; k < second; k++) {
		double a1 = an[k] + along * (an[k] - before[k]);
		a[k] = an[k] + am * (a1 - an[k]);
		u[k] = un[k] + af * (old * an[k] + new * a1);
		double v1 = vn[k] + per_am * (u[k] - vn[k]);
		q[k] = qn[k] + af * (old * vn[k] + new * v1);
	}
	RS_APART
	for (int k = second; k < n; k++) {
		double w1 = un[k] + along * (un[k] - before[k]);
		u[k] = un[k] + am * (w1 - un[k]);
		q[k] = qn[k] + af * (old * un[k] + new * w1);
		a[k] = 0.0;
	}
}

RS_CLONES
static void change(rs_integrator *it, const scheme *with)
{
	int n = it->n, second = it->second;
	double *restrict q = it->system->model->state, *restrict u = q + it->system->model->stride, *restrict a = u + it->system->model->stride;
	const double *restrict d = it->d;
	double cu = with->seed[1], ca = with->seed[2];
	RS_APART
	for (int k = 0; k < n; k++) {
		q[k] += d[k];
		u[k] += cu * d[k];
	}
	RS_APART
	for (int k = 0; k < second; k++)
		a[k] += ca * d[k];
}

RS_CLONES
static void accept(rs_integrator *it, double h)
{
	int n = it->n, second = it->second;
	const double *restrict q = it->system->model->state, *restrict u = q + it->system->model->stride, *restrict a = u + it->system->model->stride;
	double *restrict qn = it->q, *restrict un = it->u, *restrict an = it->a, *restrict vn = it->v, *restrict before = it->before;
	double to_end = 1.0 / it->af, to_new = 1.0 / it->am;
	RS_APART
	for (int k = 0; k < second; k++) {
		before[k] = an[k];
		qn[k] += to_end * (q[k] - qn[k]);
		vn[k] += to_new * (u[k] - vn[k]);
		un[k] += to_end * (u[k] - un[k]);
		an[k] += to_new * (a[k] - an[k]);
	}
	RS_APART
	for (int k = second; k < n; k++) {
		before[k] = un[k];
		qn[k] += to_end * (q[k] - qn[k]);
		un[k] += to_new * (u[k] - un[k]);
	}
	it->largest = largest_of(an, second);
	it->before_step = h;
}

/* Largest change of a body's coordinate, infinite where any is not a number. What an internal state leaves wrong is a force, and
 * the change that it makes of the bodies is its measure. */
RS_CLONES
static double size_of(const rs_integrator *it)
{
	double bodies = largest_of(it->d, it->second), rest = largest_of(it->d + it->second, it->n - it->second);
	return isfinite(rest) ? bodies : INFINITY;
}

static int worst_of(const rs_integrator *it)
{
	int worst = 0;
	for (int k = 0; k < it->n; k++) {
		if (!isfinite(it->d[k]))
			return k;
		if (fabs(it->d[k]) > fabs(it->d[worst]))
			worst = k;
	}
	return worst;
}

/* Residual, and new factors unless they are kept, at the present iterate. */
static int look(rs_integrator *it, const scheme *with, int factors)
{
	int worst = 0, status = rs_integrator_evaluate(it, factors ? with->seed : NULL, 1, factors == WHEELS);
	long long *count[] = {&it->report.residuals, &it->report.wheel_factors, &it->report.pencils};
	++*count[factors];
	if (status || factors == KEPT)
		return status;
	it->factored = 0.0;
	if (rs_system_not_finite(it->system) >= 0) {
		it->report.coordinate = rs_system_not_finite(it->system);
		return RS_NOT_FINITE;
	}
	status = rs_block_lu_factor(it->system->lu, &worst);
	if (status)
		it->report.coordinate = it->system->coordinate[RS_BLOCK * worst];
	else
		it->factored = with->tau;
	it->contraction = 1.0;
	return status;
}

static int fail(rs_integrator *it, int status)
{
	it->report.coordinate = worst_of(it);
	it->factored = 0.0;
	/* the solution has spread what is not finite over all equations: look at the residual again */
	if (status == RS_NOT_FINITE && rs_integrator_evaluate(it, NULL, 1, 0) == RS_OK && rs_system_not_finite(it->system) >= 0)
		it->report.coordinate = rs_system_not_finite(it->system);
	return status;
}

/* Acceleration that may be left wrong: small motions are not to be lost in what large ones may have. */
static double tolerable(const rs_integrator *it)
{
	double relative = FRACTION * it->largest, least = it->tolerance < LEAST_TOLERANCE ? it->tolerance : LEAST_TOLERANCE;
	relative = relative > least ? relative : least;
	return relative < it->tolerance ? relative : it->tolerance;
}

/* Iterations with one set of factors: RS_OK, RS_NOT_CONVERGED (new factors, please), or worse. */
static int iterate(rs_integrator *it, const scheme *with)
{
	double before = INFINITY, allowed = tolerable(it) * with->tau * with->tau;
	for (int k = 0; k < ITERATIONS; k++) {
		int status = k ? look(it, with, KEPT) : RS_OK;
		if (status)
			return status;
		rs_system_solve(it->system, it->d);
		it->report.solves++;
		double size = it->report.change = size_of(it);
		if (!isfinite(size))
			return fail(it, RS_NOT_FINITE);
		change(it, with);
		it->contraction = k ? size / before : AGEING * it->contraction;
		it->seen = k ? it->contraction : it->seen;
		double c = it->contraction = it->contraction > LEAST ? it->contraction : LEAST;
		if (size <= allowed || (c < 1.0 && size * c <= allowed * (1.0 - c)))
			return RS_OK;
		if (k && c > SLOW)
			break;
		before = size;
	}
	return RS_NOT_CONVERGED;
}

/* Track and speed within a step. */
static int within(rs_integrator *it, double time, double end)
{
	if (!it->travel)
		return RS_OK;
	int status = rs_travel_within(it->travel, time, end, it->af);
	it->system->travel_acceleration = it->travel->dV;
	return status;
}

static int advance(rs_integrator *it, double from, double h)
{
	scheme with = {.h = h, .tau = it->gamma * h * it->af / it->am};
	with.seed[0] = 1.0;
	with.seed[1] = 1.0 / with.tau;
	with.seed[2] = with.seed[1] * with.seed[1];
	/* af = 1 asks for the end of the step, which may be a kink: this side of it */
	double at = it->af < 1.0 - 1e-6 ? it->af : 1.0 - 1e-6;
	predict(it, h);
	int status = within(it, from + at * h, from + h), ran = 0; /* the coordinate that changed most when it last failed */
	/* a change of tau in the last digit, from the difference of two times, is no reason for new factors */
	int factors = fabs(it->factored - with.tau) > 1e-7 * with.tau ? ALL : it->wheels && it->seen > RENEW ? WHEELS : KEPT;
	it->seen = 0.0;
	for (int set = 0; set < SETS && !status; set++) {
		status = look(it, &with, factors);
		if (!status)
			status = iterate(it, &with);
		if (set && (status == RS_SINGULAR || status == RS_NOT_FINITE)) {
			/* the iterate ran away from a state that was well behaved */
			it->report.coordinate = ran;
			status = RS_NOT_CONVERGED;
			break;
		}
		if (status != RS_NOT_CONVERGED)
			break;
		ran = worst_of(it);
		status = set + 1 < SETS ? RS_OK : fail(it, RS_NOT_CONVERGED);
		/* wheels first; where that does not help, everything */
		factors = it->wheels && factors == KEPT ? WHEELS : ALL;
	}
	if (status) {
		it->factored = 0.0;
		return status;
	}
	accept(it, h);
	if (it->travel)
		rs_travel_next(it->travel);
	it->report.time = from + h;
	return RS_OK;
}

int rs_integrator_one_step(rs_integrator *it)
{
	double begin = it->start + (double)it->report.steps * it->step, end = it->start + (double)(it->report.steps + 1) * it->step;
	double at = begin, small = 1e-6 * it->step;
	int status = RS_OK;
	while (it->next_kink < it->kinks && it->kink[it->next_kink] <= end + small && !status) {
		double kink = it->kink[it->next_kink];
		if (kink > at + small)
			status = advance(it, at, kink - at);
		if (!status && kink > begin - small)
			status = rs_integrator_begin(it, kink + small);
		if (!status) {
			at = kink > at + small ? kink : at;
			it->next_kink++;
		}
	}
	if (!status && end > at + small)
		status = advance(it, at, at == begin ? it->step : end - at);
	if (!status) {
		it->report.steps++;
		it->report.time = end;
	}
	return status;
}
