/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels of elements with a scalar force law, on real lanes. */
#include "lanes.h"
#include "laws.h"

RS_NAME(kernel_type) RS_NAME(axis);
RS_NAME(kernel_type) RS_NAME(line);

#include "generated/axis.h"
#include "generated/line.h"
