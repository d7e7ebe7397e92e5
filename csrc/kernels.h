/* SPDX-License-Identifier: BSD-3-Clause */
/* The kernel table: what assemble.c calls. */
#ifndef RS_KERNEL_TABLE_H
#define RS_KERNEL_TABLE_H

#include "railsym.h"

#define RS_MAX_COORDINATES 16
#define RS_MAX_ENTRIES 192

/* Lanes and outputs by address: a lane is rs_kernel_lanes() doubles, aligned to its size. */
void rs_kernel_call(int kernel, const void *in, const rs_law *const *laws, const double *seed,
                    void *r, void *S);

#endif
