/* SPDX-License-Identifier: BSD-3-Clause */
/* One step: predict, iterate with factors that are kept while they serve, accept.
 *
 * An iteration changes q_f by d, u_f by d/tau, a_m by d/tau^2. It has converged when what is left,
 * d c/(1 - c) with c the contraction seen with these factors, is below tolerance tau^2: the
 * acceleration left wrong is then below the tolerance. Newton with kept factors converges
 * linearly; one that contracts less than fourfold gets new factors, and a step that does not
 * converge with factors of its own state has failed.
 */
#include <math.h>
#include <string.h>

#include "integrator.h"

/* Contraction above which new factors are cheaper than more iterations; iterations with one set of factors; sets a step. */
static const double SLOW = 0.25;
enum { ITERATIONS = 4, FACTORS = 4 };

/* Positions on levers of 10 m are not known better. */
static const double ROUNDING = 4e-15;

typedef struct {
	double h, tau;
	double seed[3];
} scheme;

/* y'_n+1 is extrapolated along the last step; everything else follows. */
static void predict(rs_integrator *it, double h)
{
	double *q = it->system->model->state, *u = q + it->n, *a = u + it->n;
	double along = it->before_step > 0.0 ? h / it->before_step : 0.0;
	double am = it->am, af = it->af, old = h * (1.0 - it->gamma), new = h * it->gamma;
	for (int k = 0; k < it->second; k++) {
		double a1 = it->a[k] + along * (it->a[k] - it->before[k]);
		a[k] = it->a[k] + am * (a1 - it->a[k]);
		u[k] = it->u[k] + af * (old * it->a[k] + new * a1);
		double v1 = it->v[k] + (u[k] - it->v[k]) / am;
		q[k] = it->q[k] + af * (old * it->v[k] + new * v1);
	}
	for (int k = it->second; k < it->n; k++) {
		double w1 = it->u[k] + along * (it->u[k] - it->before[k]);
		u[k] = it->u[k] + am * (w1 - it->u[k]);
		q[k] = it->q[k] + af * (old * it->u[k] + new * w1);
		a[k] = 0.0;
	}
}

static void change(rs_integrator *it, const scheme *with)
{
	double *q = it->system->model->state, *u = q + it->n, *a = u + it->n;
	for (int k = 0; k < it->n; k++) {
		q[k] += it->d[k];
		u[k] += with->seed[1] * it->d[k];
	}
	for (int k = 0; k < it->second; k++)
		a[k] += with->seed[2] * it->d[k];
}

static void accept(rs_integrator *it, double h)
{
	const double *q = it->system->model->state, *u = q + it->n, *a = u + it->n;
	double to_end = 1.0 / it->af, to_new = 1.0 / it->am;
	for (int k = 0; k < it->second; k++) {
		it->before[k] = it->a[k];
		it->q[k] += to_end * (q[k] - it->q[k]);
		it->v[k] += to_new * (u[k] - it->v[k]);
		it->u[k] += to_end * (u[k] - it->u[k]);
		it->a[k] += to_new * (a[k] - it->a[k]);
	}
	for (int k = it->second; k < it->n; k++) {
		it->before[k] = it->u[k];
		it->q[k] += to_end * (q[k] - it->q[k]);
		it->u[k] += to_new * (u[k] - it->u[k]);
	}
	it->before_step = h;
}

/* Largest change; infinite where one is not a number. */
static double size_of(rs_integrator *it)
{
	double largest = 0.0, sum = 0.0;
	for (int k = 0; k < it->n; k++) {
		double size = fabs(it->d[k]);
		largest = size > largest ? size : largest;
		sum += size;
	}
	return isfinite(sum) ? largest : INFINITY;
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

/* Residual, and with fresh factors, at the present iterate. */
static int look(rs_integrator *it, const scheme *with, int fresh)
{
	int worst = 0, status = rs_integrator_evaluate(it, fresh ? with->seed : NULL, 1);
	if (status || !fresh) {
		it->report.residuals++;
		return status;
	}
	it->report.pencils++;
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
	int wrong = rs_system_not_finite(it->system);
	it->report.coordinate = worst_of(it);
	if (status == RS_NOT_FINITE && wrong >= 0)
		it->report.coordinate = wrong;
	it->factored = 0.0;
	return status;
}

/* Iterations with one set of factors: RS_OK, RS_NOT_CONVERGED (new factors, please), or worse. */
static int iterate(rs_integrator *it, const scheme *with)
{
	double before = INFINITY, allowed = it->tolerance * with->tau * with->tau;
	allowed = allowed > ROUNDING ? allowed : ROUNDING;
	for (int k = 0; k < ITERATIONS; k++) {
		int status = k ? look(it, with, 0) : RS_OK;
		if (status)
			return status;
		rs_system_solve(it->system, it->d);
		it->report.solves++;
		double size = it->report.change = size_of(it);
		if (!isfinite(size))
			return fail(it, RS_NOT_FINITE);
		change(it, with);
		if (k) {
			double seen = size / before, kept = 0.3 * it->contraction;
			it->contraction = it->contraction < 1.0 && kept > seen ? kept : seen;
		}
		double c = it->contraction;
		if (size <= allowed || (c < 1.0 && size * c <= allowed * (1.0 - c)))
			return RS_OK;
		if (k && c > SLOW)
			break;
		before = size;
	}
	return RS_NOT_CONVERGED;
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
	int status = rs_integrator_move(it, from + at * h);
	/* a change of tau in the last digit, from the difference of two times, is no reason for new factors */
	int fresh = fabs(it->factored - with.tau) > 1e-7 * with.tau;
	for (int set = 0; set < FACTORS && !status; set++) {
		status = look(it, &with, fresh);
		if (!status)
			status = iterate(it, &with);
		if (status != RS_NOT_CONVERGED)
			break;
		status = set + 1 < FACTORS ? RS_OK : fail(it, RS_NOT_CONVERGED);
		fresh = 1;
	}
	if (status) {
		it->factored = 0.0;
		return status;
	}
	accept(it, h);
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
