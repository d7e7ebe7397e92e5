/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels of elements and contacts whose law is linear, on half the lanes. */
#define RS_HALF
#include "kernels_linear.c"
