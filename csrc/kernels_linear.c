/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels of elements and contacts whose law is linear, on real lanes. */
#include "lanes.h"

#include "generated/bushing.h"
#include "generated/wheel_rail.h"

RS_KERNEL(bushing)
RS_KERNEL(wheel_rail)
