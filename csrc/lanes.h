/* SPDX-License-Identifier: BSD-3-Clause */
/* What a generated kernel computes on: eight elements of one type at once, or one complex
 * number. The including file defines RS_COMPLEX for the second.
 *
 * Kernels are compiled for several processors and the best one is chosen when the library is
 * loaded, so that one wheel serves every machine. Compilers without vector types or clones
 * get one lane and one version.
 */
#ifndef RS_LANES_H
#define RS_LANES_H

#include <math.h>

#include "dispatch.h"
#include "railsym.h"

#ifdef RS_COMPLEX
#include <complex.h>
typedef double complex rs_scalar;
typedef double complex rs_lane;
#define RS_LANES 1
#define RS_NAME(x) rs_##x##_complex
#define RS_KERNEL static
#define RS_SQRT(to, from) ((to) = csqrt(from))
#define RS_REAL(x) creal(x)
#define RS_TANH(x) ctanh(x)
#else
typedef double rs_scalar;
#if defined(__GNUC__)
#define RS_LANES 8
typedef double rs_lane __attribute__((vector_size(8 * RS_LANES), may_alias));
#else
#define RS_LANES 1
typedef double rs_lane;
#endif
#define RS_NAME(x) rs_##x##_lanes
#define RS_KERNEL RS_CLONES
#define RS_SQRT(to, from) \
	for (int lane_ = 0; lane_ < RS_LANES; lane_++) \
		((double *)&(to))[lane_] = sqrt(((const double *)&(from))[lane_])
#define RS_REAL(x) (x)
#define RS_TANH(x) tanh(x)
#endif

/* The residual of one kernel and, unless pencil is NULL, its pencil. */
typedef void RS_NAME(kernel_type)(const rs_lane *in, const rs_law *const *laws, const double *seed,
                             rs_lane *residual, rs_lane *pencil);

/* Spreads a number over a lane: vector types add a scalar to each element. */
static const rs_lane RS_ZERO = {0};

#endif
