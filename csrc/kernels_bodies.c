/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels of bodies, on real lanes. */
#include "lanes.h"

#include "generated/rigid_body.h"
#include "generated/wheelset.h"
#include "generated/wheelset_with_axleboxes.h"

RS_KERNEL(rigid_body)
RS_KERNEL(wheelset)
RS_KERNEL(wheelset_with_axleboxes)
