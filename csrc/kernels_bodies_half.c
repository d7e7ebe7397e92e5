/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels of bodies, on half the lanes. */
#define RS_HALF
#include "kernels_bodies.c"
