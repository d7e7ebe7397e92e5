/* SPDX-License-Identifier: BSD-3-Clause */
/* Inputs of kernels from the state. An element reads of each of its bodies (x y z), (x y z yaw)', (roll pitch)', the sines and
 * the cosines; each of these stands together in the state, so it is read in one go, and four lanes of it are transposed. */
#include <stdlib.h>
#include <string.h>

#include "lanes.h"
#include "model.h"

/* Where in the state part (q u a sin cos) of coordinate c of an instance is. */
static int source_of(const rs_group *group, const rs_kernel_info *info, int instance, int c, int part, int n)
{
	int k = group->index[instance * info->coordinates + c];
	return k >= 0 ? part * n + k : 5 * n + (part == 4 ? RS_SPARE : 0) + c;
}

/* 1 where coordinate c follows the run's last one in every lane of a block. */
static int continues(const rs_group *group, const rs_kernel_info *info, int block, const rs_run *run, int c, int part, int n)
{
	int lanes = rs_kernel_lanes();
	if (run->length == RS_RUN)
		return 0;
	for (int lane = 0; lane < lanes; lane++)
		if (source_of(group, info, block * lanes + lane, c, part, n) != run->source[lane] + run->length)
			return 0;
	return 1;
}

static void find_block_runs(rs_group *group, const rs_kernel_info *info, int block, int n, int *runs)
{
	int lanes = rs_kernel_lanes();
	for (int part = 0; part < 5; part++) {
		rs_run *run = NULL;
		for (int c = 0; c < info->coordinates; c++) {
			int slot = info->slots[5 * c + part];
			if (slot < 0) {
				run = NULL;
				continue;
			}
			if (!run || !continues(group, info, block, run, c, part, n)) {
				run = group->run + (*runs)++;
				run->length = 0;
				for (int lane = 0; lane < lanes; lane++)
					run->source[lane] = source_of(group, info, block * lanes + lane, c, part, n);
			}
			run->slot[run->length++] = (short)slot;
			for (int k = run->length; k < RS_RUN; k++)
				run->slot[k] = run->slot[0];
		}
	}
	group->first_run[block + 1] = *runs;
}

int rs_group_find_runs(rs_group *group, const rs_kernel_info *info, int stride)
{
	int runs = 0;
	group->run = malloc(5 * (size_t)group->blocks * (size_t)info->coordinates * sizeof *group->run);
	group->first_run = calloc((size_t)group->blocks + 1, sizeof *group->first_run);
	if (!group->run || !group->first_run)
		return RS_NO_MEMORY;
	for (int block = 0; block < group->blocks; block++)
		find_block_runs(group, info, block, stride, &runs);
	return RS_OK;
}

static RS_ALWAYS_INLINE void copy_one(const double *state, const rs_run *run, double *in)
{
	double *to = in + run->slot[0] * RS_LANES;
	for (int lane = 0; lane < RS_LANES; lane++)
		to[lane] = state[run->source[lane]];
}

#if defined(__GNUC__) && !defined(__clang__)
typedef double four __attribute__((vector_size(32), may_alias, aligned(8)));
typedef long long four_places __attribute__((vector_size(32)));

/* Four numbers of each of four lanes, transposed: to[k] is number k of the lanes. */
static RS_ALWAYS_INLINE void transpose(const double *state, const int *source, four *to)
{
	const four_places low = {0, 1, 4, 5}, high = {2, 3, 6, 7}, even = {0, 4, 2, 6}, odd = {1, 5, 3, 7};
	four x[4];
	for (int lane = 0; lane < 4; lane++)
		x[lane] = *(const four *)(state + source[lane]);
	four low02 = __builtin_shuffle(x[0], x[2], low), low13 = __builtin_shuffle(x[1], x[3], low);
	four high02 = __builtin_shuffle(x[0], x[2], high), high13 = __builtin_shuffle(x[1], x[3], high);
	to[0] = __builtin_shuffle(low02, low13, even);
	to[1] = __builtin_shuffle(low02, low13, odd);
	to[2] = __builtin_shuffle(high02, high13, even);
	to[3] = __builtin_shuffle(high02, high13, odd);
}

/* A shorter run reads what follows it; the first input is stored last, over what went to its slot. */
static RS_ALWAYS_INLINE void copy_run(const double *state, const rs_run *run, int half, int wide, double *in)
{
	double *to[RS_RUN];
	four left[RS_RUN], right[RS_RUN];
	for (int k = 0; k < RS_RUN; k++)
		to[k] = in + run->slot[k] * RS_LANES;
	transpose(state, run->source, left);
	if (half) {
		for (int k = RS_RUN - 1; k >= 0; k--)
			*(four *)to[k] = left[k];
		return;
	}
	transpose(state, run->source + 4, right);
	for (int k = RS_RUN - 1; k >= 0; k--)
		if (wide) /* one store, for what kernels load in one go */
			*(rs_lane *)to[k] = __builtin_shufflevector(left[k], right[k], 0, 1, 2, 3, 4, 5, 6, 7);
		else {
			*(four *)to[k] = left[k];
			*(four *)(to[k] + 4) = right[k];
		}
}
#else
static RS_ALWAYS_INLINE void copy_run(const double *state, const rs_run *run, int half, int wide, double *in)
{
	(void)half;
	(void)wide;
	for (int k = 0; k < run->length; k++)
		for (int lane = 0; lane < RS_LANES; lane++)
			in[run->slot[k] * RS_LANES + lane] = state[run->source[lane] + k];
}
#endif

static RS_ALWAYS_INLINE void copy_runs(const double *restrict state, const rs_run *restrict run, const rs_run *end, int half, int wide, double *restrict in)
{
	for (; run < end; run++)
		if (run->length == 1)
			copy_one(state, run, in);
		else
			copy_run(state, run, half, wide, in);
}

/* Of a block with at most half its lanes filled the rest stays as it is. */
static RS_ALWAYS_INLINE void gather_block(const rs_model *model, const rs_group *group, const rs_kernel_info *info, int block, int wide)
{
	double *restrict in = group->in + (size_t)block * (size_t)(info->inputs * RS_LANES);
	const rs_run *run = group->run + group->first_run[block], *end = group->run + group->first_run[block + 1];
	if (2 * (group->count - block * RS_LANES) <= RS_LANES)
		copy_runs(model->state, run, end, 1, wide, in);
	else
		copy_runs(model->state, run, end, 0, wide, in);
}

#if RS_LEVELS
RS_CLONES static void gather_halves(const rs_model *model, const rs_group *group, const rs_kernel_info *info, int block)
{
	gather_block(model, group, info, block, 0);
}
#endif

RS_WIDEST static void gather_whole(const rs_model *model, const rs_group *group, const rs_kernel_info *info, int block)
{
	gather_block(model, group, info, block, 1);
}

void rs_group_gather(const rs_model *model, const rs_group *group, const rs_kernel_info *info, int block)
{
#if RS_LEVELS
	if (!RS_TAKES_WIDEST) {
		gather_halves(model, group, info, block);
		return;
	}
#endif
	gather_whole(model, group, info, block);
}
