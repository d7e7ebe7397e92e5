/* SPDX-License-Identifier: BSD-3-Clause */
/* A model: instances of kernels in lanes, and which coordinates each touches. */
#include "model.h"

#include <stdlib.h>
#include <string.h>

rs_model *rs_model_create(int coordinates, const unsigned char *is_angle)
{
	rs_model *model = coordinates > 0 ? calloc(1, sizeof *model) : NULL;
	if (!model)
		return NULL;
	model->coordinates = coordinates;
	model->groups = calloc((size_t)rs_kernel_count(), sizeof *model->groups);
	model->is_angle = malloc((size_t)coordinates);
	model->angle = malloc((size_t)coordinates * sizeof(int));
	model->stride = (coordinates + 7) / 8 * 8;
	size_t numbers = 5 * (size_t)model->stride + 2 * RS_SPARE;
	model->state = aligned_alloc(64, (numbers + 7) / 8 * 8 * sizeof(double));
	if (!model->groups || !model->is_angle || !model->angle || !model->state) {
		rs_model_free(model);
		return NULL;
	}
	memset(model->state, 0, numbers * sizeof(double));
	for (int k = 0; k < RS_SPARE; k++)
		model->state[5 * model->stride + RS_SPARE + k] = 1.0;
	memcpy(model->is_angle, is_angle, (size_t)coordinates);
	for (int k = 0; k < coordinates; k++)
		if (is_angle[k])
			model->angle[model->angles++] = k;
	return model;
}

static void free_group(rs_group *group)
{
	free(group->in);
	free(group->index);
	free((void *)group->laws);
	free(group->run);
	free(group->first_run);
}

void rs_model_free(rs_model *model)
{
	if (!model)
		return;
	for (int kernel = 0; model->groups && kernel < rs_kernel_count(); kernel++)
		free_group(model->groups + kernel);
	free(model->groups);
	free(model->is_angle);
	free(model->angle);
	free(model->state);
	free(model);
}

static int check_index(const rs_model *model, size_t size, const int *index)
{
	for (size_t k = 0; k < size; k++)
		if (index[k] < -1 || index[k] >= model->coordinates)
			return RS_BAD_INDEX;
	return RS_OK;
}

static int allocate_group(rs_group *group, const rs_kernel_info *info, int count)
{
	size_t lanes = (size_t)rs_kernel_lanes();
	group->count = count;
	group->blocks = (int)((count + lanes - 1) / lanes);
	size_t filled = (size_t)group->blocks * lanes;
	size_t bytes = filled * (size_t)info->inputs * sizeof(double);
	group->in = aligned_alloc(64, (bytes + 63) / 64 * 64);
	group->index = malloc(filled * (size_t)info->coordinates * sizeof(int));
	group->laws = malloc(filled * sizeof *group->laws);
	return group->in && group->index && group->laws ? RS_OK : RS_NO_MEMORY;
}

/* Unfilled lanes repeat the first instance, so that they compute numbers, and touch nothing. */
static void fill_group(rs_group *group, const rs_kernel_info *info, const double *in, const int *index,
                       const rs_law *const *laws)
{
	static const rs_law no_law = {0};
	int lanes = rs_kernel_lanes(), size = info->coordinates;
	for (int k = 0; k < group->blocks * lanes; k++) {
		int real = k < group->count, from = real ? k : 0;
		double *block = group->in + (size_t)(k / lanes) * (size_t)(info->inputs * lanes) + k % lanes;
		for (int slot = 0; slot < info->inputs; slot++)
			block[slot * lanes] = in[(size_t)from * (size_t)info->inputs + (size_t)slot];
		for (int c = 0; c < size; c++)
			group->index[k * size + c] = real ? index[k * size + c] : -1;
		group->laws[k] = laws && real ? laws[k] : &no_law;
	}
}

int rs_model_add(rs_model *model, int kernel, int count, const double *in, const int *index,
                 const rs_law *const *laws)
{
	const rs_kernel_info *info = rs_kernel_describe(kernel);
	if (!info || model->groups[kernel].count)
		return RS_BAD_INDEX;
	if (count <= 0 || (info->has_law && !laws))
		return RS_BAD_SIZE;
	if (check_index(model, (size_t)count * (size_t)info->coordinates, index) != RS_OK)
		return RS_BAD_INDEX;
	rs_group *group = model->groups + kernel;
	int status = allocate_group(group, info, count);
	if (status == RS_OK) {
		fill_group(group, info, in, index, laws);
		status = rs_group_find_runs(group, info, model->stride);
	}
	if (status != RS_OK) {
		free_group(group);
		memset(group, 0, sizeof *group);
	}
	return status;
}

int rs_model_set_input(rs_model *model, int kernel, int slot, const double *values)
{
	const rs_kernel_info *info = rs_kernel_describe(kernel);
	if (!info || slot < 0 || slot >= info->inputs)
		return RS_BAD_INDEX;
	rs_group *group = model->groups + kernel;
	int lanes = rs_kernel_lanes();
	for (int k = 0; k < group->blocks * lanes; k++) {
		size_t block = (size_t)(k / lanes) * (size_t)(info->inputs * lanes);
		group->in[block + (size_t)(slot * lanes + k % lanes)] = values[k < group->count ? k : 0];
	}
	return RS_OK;
}
