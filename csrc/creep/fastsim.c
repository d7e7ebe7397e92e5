/* SPDX-License-Identifier: BSD-3-Clause */
/* FASTSIM: Kalker's simplified theory with three flexibilities and a parabolic bound.
 *
 *   L1 = 8a/(3 C11 G)    L2 = 8a/(3 C22 G)    L3 = pi a sqrt(a/b)/(4 C23 G)
 *   dpx/dx = xi/L1 - phi y/L3    dpy/dx = eta/L2 + phi x/L3    |p| <= mu p0 (1 - (x/a)^2 - (y/b)^2)
 *
 * p is the traction on the wheel, 0 at the leading edge; p0 = 2N/(pi a b). Going against x from the leading
 * edge, a step that would pass the bound is shortened to it without change of direction. With
 * X = x/a, Y = y/b and p in units of mu p0 these become, in the numbers of creep.h,
 *
 *   dpx/dX = (3 pi/16) u1 - 2 (b/a) u3 Y    dpy/dX = (3 pi/16) u2 + 2 u3 X    |p| <= 1 - X^2 - Y^2
 *   h = (2/pi) int (px, py, sqrt(a/b) X py - sqrt(b/a) Y px) dX dY
 *
 * The strip at Y has the half length L = sqrt(1 - Y^2); with X = L t and p = L^2 P the bound is 1 - t^2 on every
 * strip. Strips are of equal width, a strip has cells of equal length, P is taken at their middles.
 * Slopes are those of this very algorithm; they jump by the weight of a cell where a cell begins to slip.
 *
 * J.J. Kalker, A fast algorithm for the simplified theory of rolling contact, Veh. Syst. Dyn. 11
 * (1982) 1-13; J.J. Kalker 1990, section 3.3.
 */
#include <string.h>

#include "../creep.h"

enum { PAIRS = 2, MOST = 2 * PAIRS }; /* strips side by side without slopes: as many as hide the latency and fit the registers */

#if defined(__clang__)
#define UNROLL _Pragma("unroll")
#elif defined(__GNUC__)
#define UNROLL _Pragma("GCC unroll 5")
#else
#define UNROLL
#endif

#if RS_LEVELS
#include <immintrin.h>
#pragma GCC push_options
#pragma GCC target("avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx2,fma")
#define WIDE 8
#include "fastsim_strips.h"
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#define WIDE 4
#include "fastsim_strips.h"
#pragma GCC pop_options
#endif

#if defined(__GNUC__)
#define WIDE 2
#include "fastsim_strips.h"
#define ANYWHERE fastsim_2
#else
#define WIDE 1
#include "fastsim_strips.h"
#define ANYWHERE fastsim_1
#endif

void rs_creep_fastsim(const rs_creep_input *in, int slopes, rs_creep_value *out)
{
	memset(out, 0, sizeof *out);
#if RS_LEVELS
	if (RS_TAKES_WIDEST)
		fastsim_8(in, slopes, out);
	else if (__builtin_cpu_supports("x86-64-v3"))
		fastsim_4(in, slopes, out);
	else
#endif
		ANYWHERE(in, slopes, out);
}
