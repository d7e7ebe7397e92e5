/* SPDX-License-Identifier: BSD-3-Clause */
/* Making, running and sampling an integrator; integrator.h holds the contracts. */
#include "integrator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* On cache lines: loops over them take whole lines at a time. */
static double *zeros(int count)
{
	size_t bytes = ((size_t)count * sizeof(double) + 63) / 64 * 64;
	double *found = aligned_alloc(64, bytes);
	if (found)
		memset(found, 0, bytes);
	return found;
}

static int allocate(rs_integrator *it)
{
	double **array[] = {&it->q, &it->u, &it->a, &it->v, &it->before, &it->d, &it->sample_u, &it->sample_a};
	for (size_t k = 0; k < sizeof array / sizeof *array; k++)
		if (!(*array[k] = zeros(it->n)))
			return 0;
	return 1;
}

rs_integrator *rs_integrator_create(rs_model *model, int second, int blocks, const int *block, double step,
                                    double rho, double tolerance)
{
	if (!(step > 0.0) || !isfinite(step) || !(rho >= 0.0 && rho <= 1.0) || !(tolerance > 0.0))
		return NULL;
	rs_integrator *it = calloc(1, sizeof *it);
	if (!it)
		return NULL;
	it->n = model->coordinates;
	it->second = second;
	it->step = step;
	it->am = 0.5 * (3.0 - rho) / (1.0 + rho);
	it->af = 1.0 / (1.0 + rho);
	it->gamma = 0.5 + it->am - it->af;
	it->tolerance = tolerance;
	it->report.coordinate = -1;
	it->system = rs_system_create(model, second, blocks, block);
	if (!it->system || !allocate(it)) {
		rs_integrator_free(it);
		return NULL;
	}
	return it;
}

void rs_integrator_free(rs_integrator *it)
{
	if (!it)
		return;
	rs_system_free(it->system);
	double *array[] = {it->q, it->u, it->a, it->v, it->before, it->d, it->sample_u, it->sample_a, it->kink, it->wheel_rows};
	for (size_t k = 0; k < sizeof array / sizeof *array; k++)
		free(array[k]);
	free(it->channel);
	free(it->wheelset);
	free(it);
}

void rs_integrator_place(rs_integrator *it, const double *q, const double *u, const double *a)
{
	size_t n = (size_t)it->n, stride = (size_t)it->system->model->stride;
	double *state = it->system->model->state;
	memcpy(state, q, n * sizeof *q);
	memcpy(state + stride, u, n * sizeof *u);
	if (a)
		memcpy(state + 2 * stride, a, n * sizeof *a);
	else
		memset(state + 2 * stride, 0, n * sizeof *u);
}

int rs_integrator_move(rs_integrator *it, double time)
{
	if (!it->travel)
		return RS_OK;
	int status = rs_travel_set(it->travel, time);
	it->system->travel_acceleration = it->travel->dV;
	return status;
}


int rs_integrator_start(rs_integrator *it, double time, const double *q, const double *u)
{
	memcpy(it->q, q, (size_t)it->n * sizeof *q);
	memcpy(it->u, u, (size_t)it->n * sizeof *u);
	memset(&it->report, 0, sizeof it->report);
	it->report.coordinate = -1;
	it->report.time = it->start = time;
	it->next_kink = 0;
	return it->report.status = rs_integrator_begin(it, time);
}

int rs_integrator_restart(rs_integrator *it)
{
	return it->report.status = rs_integrator_begin(it, it->report.time);
}

int rs_integrator_set_step(rs_integrator *it, double step)
{
	if (!(step > 0.0) || !isfinite(step))
		return RS_BAD_SIZE;
	it->step = step;
	it->factored = 0.0;
	return RS_OK;
}

int rs_integrator_hold(rs_integrator *it, int count, const int *coordinate, const double *stiffness,
                       const double *damping, const double *mass)
{
	rs_system *system = it->system;
	rs_hold *hold = malloc((size_t)(count + 1) * sizeof *hold);
	if (!hold)
		return RS_NO_MEMORY;
	for (int k = 0; k < count; k++) {
		if (coordinate[k] < 0 || coordinate[k] >= it->second) {
			free(hold);
			return RS_BAD_INDEX;
		}
		int place = system->place[coordinate[k]], row = place % RS_BLOCK;
		int diagonal = system->lu->diagonal[place / RS_BLOCK] + RS_BLOCK * row + row;
		hold[k] = (rs_hold){place, diagonal, coordinate[k], stiffness[k], damping[k], mass[k]};
	}
	free(system->hold);
	system->hold = hold;
	system->holds = count;
	it->factored = 0.0;
	return RS_OK;
}

double *rs_integrator_force(rs_integrator *it)
{
	return it->system->force;
}

int rs_integrator_kinks(rs_integrator *it, int count, const double *time)
{
	double *kink = malloc((size_t)(count + 1) * sizeof *kink);
	if (!kink)
		return RS_NO_MEMORY;
	memcpy(kink, time, (size_t)count * sizeof *kink);
	free(it->kink);
	it->kink = kink;
	it->kinks = count;
	it->next_kink = 0;
	/* one at the present time was met at the end of the step before */
	while (it->next_kink < count && kink[it->next_kink] <= it->report.time + 1e-6 * it->step)
		it->next_kink++;
	return RS_OK;
}

static int check_channel(const rs_integrator *it, const rs_channel *channel)
{
	int number = channel->number;
	if (channel->kind <= RS_CHANNEL_ACCELERATION)
		return channel->kind >= 0 && number >= 0 && number < it->n;
	if (channel->kind == RS_CHANNEL_WHEEL)
		return number >= 0 && number < 2 * it->wheelsets * RS_WHEEL_OUTPUTS;
	if (channel->kind == RS_CHANNEL_PATCH)
		return number >= 0 && number < 2 * it->wheelsets * RS_ZONES * RS_PATCH_OUTPUTS;
	int law = channel->kind == RS_CHANNEL_LAW;
	const rs_kernel_info *info = law || channel->kind == RS_CHANNEL_ELEMENT ? rs_kernel_describe(number) : NULL;
	const rs_group *group = it->system->model->groups + number;
	return info && channel->instance >= 0 && channel->instance < group->count && channel->row >= 0
	       && channel->row < (law ? RS_SEEN : info->coordinates) && (!law || group->laws[channel->instance]->seen);
}

int rs_integrator_channels(rs_integrator *it, int count, const rs_channel *channel)
{
	rs_channel *kept = malloc((size_t)(count + 1) * sizeof *kept);
	rs_capture *capture = calloc((size_t)count + 1, sizeof *capture);
	int captures = 0, fine = kept && capture;
	for (int k = 0; fine && k < count; k++) {
		fine = check_channel(it, channel + k);
		if (channel[k].kind == RS_CHANNEL_ELEMENT)
			capture[captures++] = (rs_capture){channel[k].number, channel[k].instance, channel[k].row, 0.0};
	}
	if (!fine) {
		int status = kept && capture ? RS_BAD_INDEX : RS_NO_MEMORY;
		free(kept);
		free(capture);
		return status;
	}
	memcpy(kept, channel, (size_t)count * sizeof *kept);
	free(it->channel);
	free(it->system->capture);
	it->channel = kept;
	it->channels = count;
	it->system->capture = capture;
	it->system->captures = captures;
	it->looks = 0;
	for (int k = 0; k < count; k++)
		it->looks |= kept[k].kind > RS_CHANNEL_ACCELERATION;
	return RS_OK;
}

void rs_integrator_controller(rs_integrator *it, rs_controller controller, void *context, int every)
{
	it->controller = controller;
	it->context = context;
	it->every = every > 0 ? every : 1;
}

void rs_integrator_travel(rs_integrator *it, rs_travel *travel)
{
	it->travel = travel;
	it->factored = 0.0;
}

/* The scheme's accelerations, and rates of internal states, belong (am - af) h before the end of the step. */
void rs_integrator_at_end(const rs_integrator *it, double *u, double *a)
{
	double ahead = it->am - it->af;
	memcpy(u, it->u, (size_t)it->second * sizeof *u);
	for (int k = 0; k < it->second; k++)
		a[k] = it->a[k] + ahead * (it->a[k] - it->before[k]);
	for (int k = it->second; k < it->n; k++) {
		u[k] = it->u[k] + ahead * (it->u[k] - it->before[k]);
		a[k] = 0.0;
	}
}

int rs_integrator_look(rs_integrator *it)
{
	rs_integrator_at_end(it, it->sample_u, it->sample_a);
	int status = rs_integrator_move(it, it->report.time);
	rs_integrator_place(it, it->q, it->sample_u, it->sample_a);
	return status ? status : rs_integrator_evaluate(it, NULL, 1, 0);
}

int rs_integrator_sample(rs_integrator *it, double *row)
{
	int status = RS_OK, captured = 0;
	rs_integrator_at_end(it, it->sample_u, it->sample_a);
	if (it->looks) {
		it->system->capturing = 1;
		status = rs_integrator_look(it);
		if (!status && it->wheels)
			rs_wheel_rail_outputs(it->wheels, it->wheel_output, it->patch_output);
	}
	for (int k = 0; k < it->channels; k++) {
		const rs_channel *channel = it->channel + k;
		const double *from[] = {it->q, it->sample_u, it->sample_a};
		if (channel->kind <= RS_CHANNEL_ACCELERATION)
			row[k] = from[channel->kind][channel->number];
		else if (channel->kind == RS_CHANNEL_WHEEL)
			row[k] = it->wheel_output[channel->number];
		else if (channel->kind == RS_CHANNEL_PATCH)
			row[k] = it->patch_output[channel->number];
		else if (channel->kind == RS_CHANNEL_LAW)
			row[k] = it->system->model->groups[channel->number].laws[channel->instance]->seen[channel->row];
		else
			row[k] = it->system->capture[captured++].value;
	}
	return status;
}

void rs_integrator_watcher(rs_integrator *it, rs_controller watcher, void *context)
{
	it->watcher = watcher;
	it->watched = context;
}

static int controlled(rs_integrator *it)
{
	int due = it->controller && it->report.steps % it->every == 0;
	if (!due && !it->watcher)
		return RS_OK;
	rs_integrator_at_end(it, it->sample_u, it->sample_a);
	if (it->watcher && it->watcher(it->watched, it->report.time, it->q, it->sample_u, it->sample_a))
		return RS_STOPPED;
	if (!due)
		return RS_OK;
	if (it->controller(it->context, it->report.time, it->q, it->sample_u, it->sample_a))
		return RS_STOPPED;
	rs_integrator_follow(it);
	return RS_OK;
}

int rs_integrator_run(rs_integrator *it, int steps, int every, double *samples, int *sampled)
{
	int status = RS_OK;
	*sampled = 0;
	it->report.coordinate = -1;
	for (int k = 0; k < steps && !status; k++) {
		status = controlled(it);
		if (!status)
			status = rs_integrator_one_step(it);
		if (!status && it->report.steps % every == 0) {
			status = rs_integrator_sample(it, samples + (size_t)*sampled * (size_t)it->channels);
			++*sampled;
		}
	}
	return it->report.status = status;
}

void rs_integrator_state(const rs_integrator *it, double *q, double *u, double *a)
{
	memcpy(q, it->q, (size_t)it->n * sizeof *q);
	rs_integrator_at_end(it, u, a);
}

const rs_run_report *rs_integrator_report(const rs_integrator *it)
{
	return &it->report;
}

int rs_integrator_residual(rs_integrator *it, double time, const double *q, const double *u, const double *a, double *r)
{
	int status = rs_integrator_move(it, time);
	rs_integrator_place(it, q, u, a);
	if (!status)
		status = rs_integrator_evaluate(it, NULL, 0, 0);
	if (status)
		return status;
	for (int k = 0; k < it->second; k++)
		r[k] = it->system->r[it->system->place[k]];
	int lanes = rs_kernel_lanes();
	for (int kernel = 0; kernel < rs_kernel_count(); kernel++) {
		const rs_scatter *scatter = it->system->scatter + kernel;
		const rs_group *group = it->system->model->groups + kernel;
		int size = rs_kernel_describe(kernel)->coordinates;
		for (int k = 0; scatter->internal >= 0 && k < group->count; k++) {
			int own = group->index[k * size + scatter->internal];
			if (own >= 0)
				r[own] = scatter->kept[(size_t)(k / lanes) * (size_t)(RS_KEPT * lanes) + RS_KEPT_G * lanes + k % lanes];
		}
	}
	return rs_system_not_finite(it->system) >= 0 ? RS_NOT_FINITE : RS_OK;
}

int rs_integrator_solve(rs_integrator *it, const double *q, const double *u, const double *a,
                        const double *seed, const double *b, double *x)
{
	int worst = 0;
	it->factored = 0.0;
	rs_integrator_place(it, q, u, a);
	int status = rs_integrator_evaluate(it, seed, 1, 0);
	if (!status)
		status = rs_block_lu_factor(it->system->lu, &worst);
	if (status)
		return status;
	rs_system_load(it->system, b);
	rs_system_solve(it->system, x);
	return RS_OK;
}

int rs_integrator_fill(const rs_integrator *it, int *operations, int *values)
{
	const rs_block_lu *lu = it->system->lu;
	*operations = 0;
	for (int k = 0; k < lu->blocks; k++) {
		int degree = lu->first[k + 1] - lu->first[k];
		*operations += 1 + degree + degree * degree;
	}
	*values = lu->values_size;
	return RS_OK;
}
