/* SPDX-License-Identifier: BSD-3-Clause */
/* The track in a step of the integrator: frame and rails at an arc length.
 *
 * The frame at s has x along the track, y to the right, z down, both in the canted plane, and lies at
 * o(s), o' = P e_x, with the attitude P = Rz(heading) Ry(slope) Rx(cant angle): frame to inertial.
 * heading' = curvature, + to the right. Between two joints curvature, sin(cant angle) and sin(slope)
 * are polynomials of s; heading is integrated exactly and the place to rounding.
 *
 * What a body's kernel takes, with V the speed of travel and dV its rate:
 *     w = V turning,  dw = dV turning + V^2 turning_rate,  gravity in the frame = g (third row of P).
 *
 * rs_track_frame_at    the frame at s
 *   Given     track    not written to by any function below: any number of threads may read it
 *             s        m, arc length, within rs_track_limits
 *   Returned  frame
 *   Status    RS_OK, RS_OUT_OF_TRACK, RS_NOT_FINITE (s); frame is then as it was
 *   Notes     At a joint the piece after it holds (the last joint: before it).
 * rs_track_straight_at where the track around s is straight: no curvature, constant cant and gradient
 *   Given     s        m, within rs_track_limits
 *   Returned  from, to  m, ends of the piece: over from <= s < to attitude and turning (zero) of the frame are the same to the
 *                      last bit; both INFINITY where it is not straight
 * rs_track_rails_at    deviation of the rails from their design place
 *   Returned  rails    RS_TRACK_RAILS: left y, left z, right y, right z, m, along the axes of the track frame
 *                      (y to the right, z down), then their derivatives d/ds in this order
 *   Status    as rs_track_frame_at
 *   Notes     Twice continuously differentiable in s. Zero where there is no irregularity.
 * rs_track_pose_of     a second frame seen from a first one, for elements between two bodies
 *   Given     first, second   frames of one track, from rs_track_frame_at
 *             V               m/s
 *             offset1 offset2 3 each, m, design place of body 1 in frame 1, of body 2 in frame 2 (x is 0 for
 *                             a body that lies at the arc length of its frame)
 *   Returned  pose
 *   Notes     The difference of places is taken in doubled precision: no cancellation at large s.
 * rs_track_limits      lowest and highest s that can be asked for, m
 * rs_track_kinks       places where curvature or its first derivative, the cant or its first two, the gradient
 *                      or its first two derivatives, or the slope of a rail's deviation jump; increasing.
 *                      Returned: their number; *kinks points into the track
 * rs_track_jumps       those of them where the turning itself jumps (only on a track made with rounding = 0);
 *                      a body that passes one receives a velocity step that no integrator sees: refuse it
 * rs_track_next_kink   the first kink behind s (> s), INFINITY when there is none
 *
 * rs_track_frames, rs_track_rails, rs_track_poses   the same at n places
 *   Given     s, s1, s2   n, m
 *             V           n, m/s
 *             offset1 offset2   3 x n by rows of 3, m
 *   Returned  frames, rails (n x RS_TRACK_RAILS), poses: n each
 *             failed      number of the place that failed, n when none did; those before it are as computed
 *   Status    of the place that failed
 *
 * rs_track_create      a track; free with rs_track_free
 *   Given     pieces  n > 0
 *             joint   n + 1, m, increasing: ends of the pieces
 *             piece   n, copied; heading and place are the integrals of the others
 *             kink    kinks, m, increasing; jump: jumps, m, increasing
 *   Returned  the track, or NULL (no memory, or n <= 0)
 * rs_track_add_rails   a layer of rail deviations, summed with the others; only before the track is shared
 *   Given     start   m, step: m, > 0, count >= 2: uniform cubic B-spline over start + k step, 0 <= k < count
 *             coefficients  (count + 2) x 4, first that of k = -1: left y, left z, right y, right z, m
 *             after   4, m, deviation behind the last k (before the first one it is zero)
 *   Status    RS_OK, RS_BAD_SIZE, RS_NO_MEMORY
 */
#ifndef RS_TRACK_H
#define RS_TRACK_H

#include "railsym.h"

#endif
