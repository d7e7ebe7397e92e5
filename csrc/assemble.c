/* SPDX-License-Identifier: BSD-3-Clause */
/* Residual and pencil of the whole model: gather coordinates into lanes (gather.c), call the kernels,
 * add their rows and entries where they belong. */
#include <math.h>
#include <string.h>

#include "lanes.h"
#include "model.h"

static void add_rows(const rs_kernel_info *info, const int *index, const double *rows, double *r)
{
	int lanes = rs_kernel_lanes();
	for (int lane = 0; lane < lanes; lane++)
		for (int c = 0; c < info->coordinates; c++) {
			int k = index[lane * info->coordinates + c];
			if (k >= 0)
				r[k] += rows[c * lanes + lane];
		}
}

static void add_entries(const rs_kernel_info *info, const int *index, const double *entries, int n, double *S)
{
	int lanes = rs_kernel_lanes();
	for (int lane = 0; lane < lanes; lane++) {
		const int *own = index + lane * info->coordinates;
		for (int e = 0; e < info->entries; e++) {
			int row = own[info->row[e]], column = own[info->column[e]];
			if (row >= 0 && column >= 0)
				S[(size_t)row * (size_t)n + (size_t)column] += entries[e * lanes + lane];
		}
	}
}

static void evaluate(rs_model *model, const double *q, const double *u, const double *a,
                     const double *seed, double *r, double *S)
{
	_Alignas(64) double rows[RS_MAX_COORDINATES * 8], entries[RS_MAX_ENTRIES * 8];
	int lanes = rs_kernel_lanes();
	size_t n = (size_t)model->coordinates;
	memcpy(model->state, q, n * sizeof *q);
	memcpy(model->state + model->stride, u, n * sizeof *u);
	memcpy(model->state + 2 * model->stride, a, n * sizeof *a);
	rs_model_trigonometry(model);
	for (int kernel = 0; kernel < rs_kernel_count(); kernel++) {
		const rs_kernel_info *info = rs_kernel_describe(kernel);
		rs_group *group = model->groups + kernel;
		for (int block = 0; block < group->blocks; block++) {
			double *in = group->in + (size_t)block * (size_t)(info->inputs * lanes);
			const int *index = group->index + block * lanes * info->coordinates;
			rs_group_gather(model, group, info, block);
			rs_kernel_call(kernel, group->count - block * lanes, in, group->laws + block * lanes, seed, rows, S ? entries : NULL);
			if (r)
				add_rows(info, index, rows, r);
			if (S)
				add_entries(info, index, entries, model->coordinates, S);
		}
	}
}

static int check_finite(const double *r, int n)
{
	for (int k = 0; k < n; k++)
		if (!isfinite(r[k]))
			return RS_NOT_FINITE;
	return RS_OK;
}

int rs_model_residual(rs_model *model, const double *q, const double *u, const double *a, double *r)
{
	static const double no_seed[3] = {0.0, 0.0, 0.0};
	memset(r, 0, (size_t)model->coordinates * sizeof *r);
	evaluate(model, q, u, a, no_seed, r, NULL);
	return check_finite(r, model->coordinates);
}

int rs_model_pencil(rs_model *model, const double *q, const double *u, const double *a,
                    const double *seed, double *r, double *S)
{
	size_t n = (size_t)model->coordinates;
	if (r)
		memset(r, 0, n * sizeof *r);
	memset(S, 0, n * n * sizeof *S);
	evaluate(model, q, u, a, seed, r, S);
	return r ? check_finite(r, model->coordinates) : RS_OK;
}
