/* SPDX-License-Identifier: BSD-3-Clause */
/* What a state needs to begin a step: accelerations from M a = -r(q, u, 0), for every Maxwell
 * element the rate w of its damper from c w + C(w) = k (e - s), and for every actuator with a lag that of what it follows. */
#include <math.h>
#include <string.h>

#include "integrator.h"
#include "lanes.h"
#include "laws.h"

static double damper_force(const rs_law *law, double w, double *slope)
{
	double value;
	RS_NAME(curve)(law->damping_curve, w, &value, slope);
	*slope += law->damping;
	return law->damping * w + value;
}

/* Newton inside a bracket: the force of a damper grows with its rate. */
static int damper_rate(const rs_law *law, double force, double *rate)
{
	double low = -INFINITY, high = INFINITY, w = 0.0;
	if (!isfinite(force))
		return RS_NOT_FINITE;
	for (int k = 0; k < 80; k++) {
		double slope, wrong = damper_force(law, w, &slope) - force;
		if (fabs(wrong) <= 1e-12 * (fabs(force) + 1e-6)) {
			*rate = w;
			return RS_OK;
		}
		if (wrong > 0.0)
			high = w;
		else
			low = w;
		double move = slope > 0.0 ? -wrong / slope : (wrong > 0.0 ? -1.0 : 1.0);
		int outside = w + move <= low || w + move >= high;
		w = outside && isfinite(low) && isfinite(high) ? 0.5 * (low + high) : w + move;
	}
	return RS_NOT_CONVERGED;
}

/* Rate of what an actuator follows: the root of its own equation. */
static double followed(const rs_law *law, double s)
{
	RS_NAME(law_value) at = {0};
	RS_NAME(follow)(law, 1.0, s, 0.0, &at);
	return -at.g / at.g_w;
}

/* 1 where a law has the command and fault that it had when it was last asked. */
static int as_before(const rs_law *law)
{
	if (!law->seen)
		return 0;
	int same = law->seen[RS_FOLLOWED_COMMAND] == law->command && law->seen[RS_FOLLOWED_FAULT] == law->fault;
	law->seen[RS_FOLLOWED_COMMAND] = law->command;
	law->seen[RS_FOLLOWED_FAULT] = law->fault;
	return same;
}

void rs_integrator_follow(rs_integrator *it)
{
	for (int kernel = 0; kernel < rs_kernel_count(); kernel++) {
		const rs_group *group = it->system->model->groups + kernel;
		int size = rs_kernel_describe(kernel)->coordinates, internal = it->system->scatter[kernel].internal;
		for (int k = 0; internal >= 0 && k < group->count; k++) {
			int own = group->index[k * size + internal];
			if (own >= 0 && group->laws[k]->kind != RS_LAW_MAXWELL && !as_before(group->laws[k]))
				it->u[own] = it->before[own] = followed(group->laws[k], it->q[own]);
		}
	}
}

static int start_internal(rs_integrator *it, int kernel)
{
	const rs_scatter *scatter = it->system->scatter + kernel;
	const rs_group *group = it->system->model->groups + kernel;
	int lanes = rs_kernel_lanes(), size = rs_kernel_describe(kernel)->coordinates, status = RS_OK;
	for (int k = 0; scatter->internal >= 0 && k < group->count && !status; k++) {
		int own = group->index[k * size + scatter->internal];
		if (own < 0)
			continue;
		const rs_law *law = group->laws[k];
		double g = scatter->kept[(size_t)(k / lanes) * (size_t)(RS_KEPT * lanes) + RS_KEPT_G * lanes + k % lanes], slope;
		if (law->kind == RS_LAW_MAXWELL)
			status = damper_rate(law, damper_force(law, 0.0, &slope) - g, it->u + own);
		else
			it->u[own] = followed(law, it->q[own]);
		if (status)
			it->report.coordinate = own;
	}
	return status;
}

static int solve_accelerations(rs_integrator *it)
{
	static const double mass[3] = {0.0, 0.0, 1.0};
	int worst = 0, status = rs_integrator_evaluate(it, mass, 0, 0);
	it->factored = 0.0;
	it->report.pencils++;
	if (!status && rs_system_not_finite(it->system) >= 0) {
		it->report.coordinate = rs_system_not_finite(it->system);
		status = RS_NOT_FINITE;
	}
	if (!status && (status = rs_block_lu_factor(it->system->lu, &worst)))
		it->report.coordinate = it->system->coordinate[RS_BLOCK * worst];
	if (status)
		return status;
	/* with the mass as pencil internal coordinates are eliminated by nothing: d of theirs is not used */
	rs_system_solve(it->system, it->d);
	memcpy(it->a, it->d, (size_t)it->second * sizeof(double));
	return RS_OK;
}

int rs_integrator_begin(rs_integrator *it, double time)
{
	(void)RS_NAME(law); /* the lanes of laws.h are not needed here */
	int status = rs_integrator_move(it, time);
	if (status)
		return status;
	if (it->travel)
		rs_travel_begin(it->travel);
	for (int k = it->second; k < it->n; k++)
		it->u[k] = 0.0;
	rs_integrator_place(it, it->q, it->u, NULL);
	status = solve_accelerations(it);
	for (int kernel = 0; kernel < rs_kernel_count() && !status; kernel++)
		status = start_internal(it, kernel);
	memcpy(it->v, it->u, (size_t)it->n * sizeof(double));
	memcpy(it->before, it->a, (size_t)it->second * sizeof(double));
	memcpy(it->before + it->second, it->u + it->second, (size_t)(it->n - it->second) * sizeof(double));
	it->before_step = it->largest = it->seen = 0.0;
	return status;
}
