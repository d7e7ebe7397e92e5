/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels of bodies, on real lanes. */
#include "lanes.h"

RS_NAME(kernel_type) RS_NAME(rigid_body);
RS_NAME(kernel_type) RS_NAME(wheelset);
RS_NAME(kernel_type) RS_NAME(wheelset_with_axleboxes);

#include "generated/rigid_body.h"
#include "generated/wheelset.h"
#include "generated/wheelset_with_axleboxes.h"
