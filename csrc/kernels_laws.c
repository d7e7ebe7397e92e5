/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels of elements with a scalar force law, on real lanes. */
#include "lanes.h"
#include "laws.h"

#include "generated/axis.h"
#include "generated/line.h"

RS_KERNEL(axis)
RS_KERNEL(line)
