/* SPDX-License-Identifier: BSD-3-Clause */
/* The kernel table: what assemble.c calls. */
#ifndef RS_KERNEL_TABLE_H
#define RS_KERNEL_TABLE_H

#include "railsym.h"

#define RS_MAX_COORDINATES 16
#define RS_MAX_ENTRIES 192

/* Inputs and outputs lane by lane: a lane is rs_kernel_lanes() doubles, aligned to its size. Of them the first `used` are computed, others
 * may be. S may be NULL. */
void rs_kernel_call(int kernel, int used, const double *in, const rs_law *const *laws, const double *seed, double *r, double *S);

/* Slot of the input of that name, -1 for none. */
int rs_kernel_slot(const rs_kernel_info *info, const char *name);

#endif
