/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels of elements with a scalar force law, on half the lanes. */
#define RS_HALF
#include "kernels_laws.c"
