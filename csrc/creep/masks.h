/* SPDX-License-Identifier: BSD-3-Clause */
/* Choices lane by lane without branches. A mask has all bits of a lane set, or none. */
#ifndef RS_MASKS_H
#define RS_MASKS_H

#if defined(__GNUC__)
typedef long long mask_lane __attribute__((vector_size(8 * RS_LANES), may_alias));
/* All bits of a lane where it is not below zero, none where it is. */
#define NOT_NEGATIVE(d) (~((mask_lane)(d) >> 63))
#define KEEP(x, mask) ((rs_lane)((mask_lane)(x) & (mask)))
#else
typedef int mask_lane;
#define NOT_NEGATIVE(d) (-((d) >= 0.0))
#define KEEP(x, mask) ((mask) ? (x) : 0.0)
#endif

/* One of two, to the last bit. */
#define SELECT(mask, x, y) (KEEP(x, mask) + KEEP(y, ~(mask)))

#endif
