/* SPDX-License-Identifier: BSD-3-Clause */
/* Evaluation of a system: kernels, elimination of internal coordinates eight elements at a time,
 * rows and entries straight to their places in the blocks. system_create.c finds the places. */
#include <math.h>
#include <string.h>

#include "dispatch.h"
#include "lanes.h"
#include "system.h"

enum { LANES = RS_LANES };

static RS_ALWAYS_INLINE double *lane(double *of, int k)
{
	return of + k * LANES;
}

/* Eliminates the internal coordinate of a block of lanes from its pencil; keeps c/p, w, 1/p. */
RS_CLONES
static void eliminate_entries(const rs_kernel_info *info, double *restrict entries, double *restrict kept)
{
	int last = info->coordinates - 1;
	double *inverse = lane(kept, RS_KEPT_INVERSE);
	for (int e = 0; e < info->entries; e++) {
		const double *from = entries + e * LANES;
		int row = info->row[e], column = info->column[e];
		if (row == last && column == last)
			for (int i = 0; i < LANES; i++)
				inverse[i] = from[i] != 0.0 ? 1.0 / from[i] : 0.0; /* 0: this lane has no such coordinate */
		else if (row == last)
			memcpy(lane(kept, RS_KEPT_ROW + column), from, (size_t)LANES * sizeof *from);
		else if (column == last)
			memcpy(lane(kept, row), from, (size_t)LANES * sizeof *from);
	}
	for (int c = 0; c < last; c++)
		for (int i = 0; i < LANES; i++)
			kept[c * LANES + i] *= inverse[i];
	for (int e = 0; e < info->entries; e++) {
		int row = info->row[e], column = info->column[e];
		if (row == last || column == last)
			continue;
		double *to = entries + e * LANES;
		const double *c = kept + row * LANES, *w = kept + (RS_KEPT_ROW + column) * LANES;
		for (int i = 0; i < LANES; i++)
			to[i] -= c[i] * w[i];
	}
}

static RS_ALWAYS_INLINE void eliminate_rows(int last, double *restrict rows, double *restrict kept, int inner)
{
	double *g = lane(kept, RS_KEPT_G);
	memcpy(g, rows + last * LANES, (size_t)LANES * sizeof *g);
	for (int c = 0; inner && c < last; c++)
		for (int i = 0; i < LANES; i++)
			rows[c * LANES + i] -= kept[c * LANES + i] * g[i];
}

static RS_ALWAYS_INLINE void add(double *to, const int *place, const double *values, int count)
{
	for (int k = 0; k < count; k++)
		to[place[k]] += values[k];
}

static void capture(rs_system *system, int kernel, int block, const double *rows, int *next)
{
	for (; *next < system->captures; ++*next) {
		rs_capture *wanted = system->capture + *next;
		if (wanted->kernel != kernel || wanted->instance / LANES != block)
			return;
		wanted->value = rows[wanted->row * LANES + wanted->instance % LANES];
	}
}

/* Residual of one body from the rows of all groups: the first ones each from one place a term, the others one by one. */
static RS_ALWAYS_INLINE void sum_block(const rs_row_sums *sums, int block, int lead, int size, double *restrict to)
{
	double sum[RS_BLOCK] = {0.0};
	const int *row = sums->row + RS_BLOCK * sums->first[block], *end = sums->row + RS_BLOCK * sums->first[block + 1];
	for (; row < end; row += RS_BLOCK) {
		const double *from = sums->values + row[0];
		for (int i = 0; i < lead; i++)
			sum[i] += from[i * LANES];
		for (int i = lead; i < size; i++)
			sum[i] += sums->values[row[i]];
	}
	for (int i = 0; i < RS_BLOCK; i++)
		to[i] = sum[i];
}

static void sum_rows(const rs_system *system)
{
	const rs_row_sums *sums = &system->sums;
	for (int block = 0; RS_BLOCK * block < system->size; block++) {
		double *to = system->r + RS_BLOCK * block;
		if (sums->lead[block] == 6)
			sum_block(sums, block, 6, 6, to);
		else if (sums->lead[block] == 5)
			sum_block(sums, block, 5, RS_BLOCK, to);
		else
			sum_block(sums, block, 0, RS_BLOCK, to);
	}
}

static void evaluate_group(rs_system *system, int kernel, const double *seed, int inner, int *next)
{
	_Alignas(64) double entries[RS_MAX_ENTRIES * LANES];
	const rs_kernel_info *info = rs_kernel_describe(kernel);
	const rs_group *group = system->model->groups + kernel;
	rs_scatter *scatter = system->scatter + kernel;
	int coordinates = info->coordinates * LANES;
	for (int block = 0; block < group->blocks; block++) {
		double *rows = scatter->values + block * coordinates;
		double *in = group->in + (size_t)block * (size_t)(info->inputs * LANES);
		rs_group_gather(system->model, group, info, block);
		rs_kernel_call(kernel, group->count - block * LANES, in, group->laws + block * LANES, seed, rows, seed ? entries : NULL);
		if (system->capturing)
			capture(system, kernel, block, rows, next);
		if (scatter->internal >= 0 && scatter->inner[block]) {
			double *kept = scatter->kept + (size_t)block * (size_t)(RS_KEPT * LANES);
			if (seed && inner)
				eliminate_entries(info, entries, kept);
			eliminate_rows(scatter->internal, rows, kept, inner);
		}
		if (seed)
			add(system->lu->values, scatter->entry + (size_t)block * (size_t)(info->entries * LANES), entries,
			    info->entries * LANES);
	}
}

/* Holds and applied forces. */
static void add_own(rs_system *system, const double *seed)
{
	const double *q = system->model->state, *u = q + system->model->stride;
	for (int k = 0; k < system->second; k++)
		if (system->force[k] != 0.0)
			system->r[system->place[k]] -= system->force[k];
	for (int k = 0; k < system->holds; k++) {
		const rs_hold *hold = system->hold + k;
		system->r[hold->place] += hold->stiffness * q[hold->coordinate] + hold->damping * u[hold->coordinate]
		                          - hold->mass * system->travel_acceleration;
		if (seed)
			system->lu->values[hold->diagonal] += seed[0] * hold->stiffness + seed[1] * hold->damping;
	}
}

void rs_system_evaluate(rs_system *system, const double *seed, int inner)
{
	int next = 0;
	if (seed)
		memset(system->lu->values, 0, (size_t)system->lu->values_size * sizeof(double));
	rs_model_trigonometry(system->model);
	for (int kernel = 0; kernel < rs_kernel_count(); kernel++)
		if (system->model->groups[kernel].count)
			evaluate_group(system, kernel, seed, inner, &next);
	sum_rows(system);
	add_own(system, seed);
	system->capturing = 0;
}

void rs_system_load(rs_system *system, const double *b)
{
	int lanes = rs_kernel_lanes();
	memset(system->r, 0, (size_t)system->size * sizeof(double));
	for (int k = 0; k < system->second; k++)
		system->r[system->place[k]] = -b[k];
	for (int kernel = 0; kernel < rs_kernel_count(); kernel++) {
		const rs_scatter *scatter = system->scatter + kernel;
		const rs_group *group = system->model->groups + kernel;
		int size = rs_kernel_describe(kernel)->coordinates;
		for (int k = 0; scatter->internal >= 0 && k < group->count; k++) {
			double *kept = scatter->kept + (size_t)(k / lanes) * (size_t)(RS_KEPT * lanes) + k % lanes;
			const int *row = scatter->row + k / lanes * size * lanes + k % lanes;
			int own = group->index[k * size + scatter->internal];
			if (own < 0)
				continue;
			kept[RS_KEPT_G * lanes] = -b[own];
			for (int c = 0; c < scatter->internal; c++)
				system->r[row[c * lanes]] += kept[c * lanes] * b[own];
		}
	}
}

/* ds = -(g + w dq)/p of one kernel's internal coordinates. */
RS_CLONES
static void recover(const rs_system *system, int kernel, const double *x, double *d)
{
	const rs_scatter *scatter = system->scatter + kernel;
	const rs_group *group = system->model->groups + kernel;
	int size = rs_kernel_describe(kernel)->coordinates;
	for (int block = 0; block < group->blocks; block++) {
		const double *kept = scatter->kept + (size_t)block * (size_t)(RS_KEPT * LANES);
		const int *row = scatter->row + block * size * LANES;
		double sum[LANES];
		if (!scatter->inner[block])
			continue;
		for (int i = 0; i < LANES; i++)
			sum[i] = kept[RS_KEPT_G * LANES + i];
		for (int c = 0; c < scatter->internal; c++)
			for (int i = 0; i < LANES; i++)
				sum[i] += kept[(RS_KEPT_ROW + c) * LANES + i] * x[row[c * LANES + i]];
		for (int i = 0; i < LANES; i++) {
			int own = group->index[(block * LANES + i) * size + scatter->internal];
			if (own >= 0)
				d[own] = -sum[i] * kept[RS_KEPT_INVERSE * LANES + i];
		}
	}
}

void rs_system_solve(rs_system *system, double *d)
{
	double *x = system->r;
	for (int k = 0; k < system->size; k++)
		x[k] = -x[k];
	memset(x + system->size, 0, RS_BLOCK * sizeof *x);
	rs_block_lu_solve(system->lu, x);
	for (int k = 0; k < system->second; k++)
		d[k] = x[system->place[k]];
	for (int kernel = 0; kernel < rs_kernel_count(); kernel++)
		if (system->scatter[kernel].internal >= 0)
			recover(system, kernel, x, d);
}

int rs_system_not_finite(const rs_system *system)
{
	const double *q = system->model->state, *u = q + system->model->stride;
	int found = -1;
	for (int k = 0; k < system->second && found < 0; k++)
		if (!isfinite(system->r[system->place[k]]))
			found = k;
	for (int k = 0; k < system->n && found >= 0; k++)
		if (!isfinite(q[k]) || !isfinite(u[k]))
			return k;
	return found;
}
