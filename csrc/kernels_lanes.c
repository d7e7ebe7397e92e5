/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of kernels on real lanes, and their descriptions. */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "kernels.h"
#include "lanes.h"

#include "generated/kernels.h"

#define DECLARE(name, inputs, coordinates, entries, has_law) RS_NAME(kernel_type) RS_NAME(name);
RS_KERNELS(DECLARE)

#define DESCRIBE(name, inputs, coordinates, entries, has_law) \
	{#name, inputs, coordinates, entries, has_law, \
	 name##_row, name##_column, name##_slots, name##_inputs, name##_units},
static const rs_kernel_info kernel_info[] = {RS_KERNELS(DESCRIBE)};

#define FITS(name, inputs, coordinates, entries, has_law) \
	_Static_assert(coordinates <= RS_MAX_COORDINATES && entries <= RS_MAX_ENTRIES, #name);
RS_KERNELS(FITS)

enum { KERNELS = sizeof kernel_info / sizeof *kernel_info };

int rs_kernel_count(void)
{
	return KERNELS;
}

const rs_kernel_info *rs_kernel_describe(int kernel)
{
	return kernel < 0 || kernel >= KERNELS ? NULL : kernel_info + kernel;
}

int rs_kernel_lanes(void)
{
	return RS_LANES;
}

void rs_kernel_call(int kernel, const void *in, const rs_law *const *laws, const double *seed,
                    void *r, void *S)
{
#define ENTRY(name, inputs, coordinates, entries, has_law) RS_NAME(name),
	static RS_NAME(kernel_type) *const table[] = {RS_KERNELS(ENTRY)};
	table[kernel](in, laws, seed, r, S);
}

int rs_kernel_real(int kernel, const double *in, const rs_law *const *laws, const double *seed,
                   double *r, double *S)
{
	const rs_kernel_info *info = rs_kernel_describe(kernel);
	if (!info)
		return RS_BAD_INDEX;
	rs_lane lanes_r[RS_MAX_COORDINATES], lanes_S[RS_MAX_ENTRIES];
	rs_lane *lanes_in = aligned_alloc(sizeof(rs_lane), info->inputs * sizeof(rs_lane));
	if (!lanes_in)
		return RS_NO_MEMORY;
	memcpy(lanes_in, in, info->inputs * sizeof(rs_lane));
	rs_kernel_call(kernel, lanes_in, laws, seed, lanes_r, S ? lanes_S : NULL);
	memcpy(r, lanes_r, info->coordinates * sizeof(rs_lane));
	if (S)
		memcpy(S, lanes_S, info->entries * sizeof(rs_lane));
	free(lanes_in);
	return RS_OK;
}
