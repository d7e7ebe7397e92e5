/* SPDX-License-Identifier: BSD-3-Clause */
/* The generated kernels on one complex number: derivatives by the complex step. */
#define RS_COMPLEX
#include <stddef.h>

#include "lanes.h"
#include "laws.h"

#include "generated/axis.h"
#include "generated/bushing.h"
#include "generated/line.h"
#include "generated/rigid_body.h"
#include "generated/wheel_rail.h"
#include "generated/wheelset.h"
#include "generated/wheelset_with_axleboxes.h"

#include "generated/kernels.h"

int rs_kernel_complex(int kernel, const double *in, const rs_law *law, const double *seed,
                      double *r, double *S)
{
#define ENTRY(name, inputs, coordinates, entries, has_law) RS_NAME(name##_body),
	static rs_kernel_function *const table[] = {RS_KERNELS(ENTRY)};
	if (kernel < 0 || kernel >= rs_kernel_count())
		return RS_BAD_INDEX;
	table[kernel](in, &law, seed, r, S);
	return RS_OK;
}
