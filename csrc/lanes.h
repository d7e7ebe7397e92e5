/* SPDX-License-Identifier: BSD-3-Clause */
/* What a generated kernel computes on: eight elements of one type at once, four of them (the including file defines RS_HALF), or
 * one complex number (RS_COMPLEX).
 *
 * Kernels are compiled for several processors and the best one is chosen when the library is
 * loaded, so that one wheel serves every machine. Eight at once need AVX-512: GCC lowers vectors of 64 bytes badly to
 * shorter ones, so other processors take twice four. Compilers without vector types or clones get one lane and one version.
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
#define RS_WIDTH 1
#define RS_STRIDE 2
#define RS_NAME(x) rs_##x##_complex
#define RS_SQRT(to, from) ((to) = csqrt(from))
#define RS_REAL(x) creal(x)
#define RS_TANH(x) ctanh(x)
#else
typedef double rs_scalar;
#if defined(__GNUC__)
#define RS_LANES 8
#ifdef RS_HALF
#define RS_WIDTH (RS_LANES / 2)
#define RS_NAME(x) rs_##x##_half
#define RS_KERNEL_LEVELS RS_CLONES
#else
#define RS_WIDTH RS_LANES
#define RS_NAME(x) rs_##x##_lanes
#define RS_KERNEL_LEVELS RS_WIDEST
#endif
typedef double rs_lane __attribute__((vector_size(8 * RS_WIDTH), may_alias));
#else
#define RS_LANES 1
#define RS_WIDTH 1
#define RS_NAME(x) rs_##x##_lanes
#define RS_KERNEL_LEVELS
typedef double rs_lane;
#endif
#define RS_STRIDE RS_LANES
#define RS_SQRT(to, from) \
	for (int lane_ = 0; lane_ < RS_WIDTH; lane_++) \
		((double *)&(to))[lane_] = sqrt(((const double *)&(from))[lane_])
#define RS_REAL(x) (x)
#define RS_TANH(x) tanh(x)
#endif

/* The residual of one kernel and, unless pencil is NULL, its pencil. Inputs and outputs are RS_STRIDE numbers apart. */
typedef void rs_kernel_function(const double *restrict in, const rs_law *const *laws, const double *seed, double *restrict residual,
                                double *restrict pencil);

#define RS_IN(k) (*(const rs_lane *)(in + RS_STRIDE * (k)))
#define RS_OUT(to, k) (*(rs_lane *)((to) + RS_STRIDE * (k)))

/* Head of a generated kernel. */
#define RS_BODY(name) \
	static RS_ALWAYS_INLINE void RS_NAME(name##_body)(const double *restrict in, const rs_law *const *laws, const double *seed, \
	                                                  double *restrict residual, double *restrict pencil)

/* Two functions of a generated kernel: residual and pencil, and the residual by itself, which keeps nothing for a pencil. */
#define RS_KERNEL(name) \
	rs_kernel_function RS_NAME(name), RS_NAME(name##_rows); \
	RS_KERNEL_LEVELS void RS_NAME(name)(const double *restrict in, const rs_law *const *laws, const double *seed, \
	                                    double *restrict residual, double *restrict pencil) \
	{ \
		RS_NAME(name##_body)(in, laws, seed, residual, pencil); \
	} \
	RS_KERNEL_LEVELS void RS_NAME(name##_rows)(const double *restrict in, const rs_law *const *laws, const double *seed, \
	                                           double *restrict residual, double *restrict pencil) \
	{ \
		(void)pencil; \
		RS_NAME(name##_body)(in, laws, seed, residual, 0); \
	}

/* Spreads a number over a lane: vector types add a scalar to each element. */
static const rs_lane RS_ZERO = {0};

#endif
