/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels of elements and contacts whose law is linear, on real lanes. */
#include "lanes.h"

RS_NAME(kernel_type) RS_NAME(bushing);
RS_NAME(kernel_type) RS_NAME(wheel_rail);

#include "generated/bushing.h"
#include "generated/wheel_rail.h"
