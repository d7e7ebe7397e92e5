/* SPDX-License-Identifier: BSD-3-Clause */
/* Wheel-rail forces in motion: from the state of the wheelsets and the lie of the rails to rows of the residual
 * and blocks of the pencil. docs/wheel_rail_forces.md derives what csrc/wheel_rail/ computes.
 *
 * Wheelsets are counted from 0; wheel 2 k is the left one of wheelset k, wheel 2 k + 1 the right one.
 * Coordinates of a wheelset: x y z yaw roll spin, in the track frame, as in derive/bodies.py.
 *
 * rs_wheel_rail_create
 *   Given     wheelsets  n > 0
 *             wheelset   n, copied: first coordinate (the six follow each other), design place, rails' spacing, wheels.
 *                        The shapes its wheels point to are kept, not copied, and only read.
 *             creep      copied with its coefficients: law, grid, material, Kalker's coefficients over ln(a/b)
 *   Returned  the object with all its work memory, or NULL (no memory, n <= 0, unknown law or kind of contact, a grid
 *             below 1 x 1, no pieces, the law of exact theory without its table); free with rs_wheel_rail_free
 * rs_wheel_rail_rows   forces of all wheels
 *   Given     q u      all coordinates of the model and their rates, unchanged; only those of the wheelsets are read
 *             V        m/s, speed of the track frames along their x; > 0; the creepages are slips over V
 *             w        3 n, rad/s, angular velocity of each wheelset's track frame, in its axes
 *             rail     8 n, or NULL (rails as designed), as rs_track_rails_at gives it: left y, left z, right y, right z, m,
 *                      deviation of each rail's head from its design place at the wheelset, + right and + down; then
 *                      their derivatives d/ds along the track in this order
 *             seed     cq, cu (read only with blocks)
 *   Returned  rows     6 n, set, not added to: what the wheels add to the residual r, that is minus the generalised
 *                      forces on x y z yaw roll spin of each wheelset
 *             blocks   36 n, set, row by row: cq d(rows)/dq + cu d(rows)/du of each wheelset; or NULL: skipped.
 *                      A wheelset's rows depend on its own coordinates only.
 *   Status    RS_OK, RS_OUT_OF_TABLE (rs_wheel_rail_failure says where), RS_BAD_SPEED (V not > 0),
 *             RS_NOT_FINITE (rs_wheel_rail_failure says which wheel); rows and blocks are not touched unless RS_OK
 *   Notes     No allocation. One thread at a time an object. Same machine, same input: same bytes.
 *             Loads and forces are continuous; slopes jump where a patch lifts off against its damping, and inside
 *             FASTSIM and FaStrip where a cell begins to slip.
 * rs_wheel_rail_failure  after a status other than RS_OK
 *   Returned  wheel      its number, -1 after RS_BAD_SPEED, and where the last rs_wheel_rail_rows met nothing
 *             variable   0 y, 1 roll, 2 drop (with a table: penetration), 3 yaw: of the wheel's place against its rail as in
 *                        contact/contact_table.h; 4 ln(a/b); -1: its forces
 *             value      of the variable
 *             place      RS_PLACE_SIZE, the whole place
 * rs_wheel_rail_outputs  of the last rs_wheel_rail_rows, which must have returned RS_OK
 *   Returned  wheel    2 n x RS_WHEEL_OUTPUTS, see below
 *             patch    2 n x RS_ZONES x RS_PATCH_OUTPUTS, in the place of its zone; zeros where a zone carries no load
 *
 * Of a wheel (RS_WHEEL_...), forces in the track frame:
 *   Y N    lateral force of the wheel on the rail, + outwards, as when the flange pushes its rail; sum of Y of a
 *          wheelset, + to the right, is Y right - Y left
 *   Q N    vertical force of the wheel on the rail, + down
 *   X N    longitudinal force of the rail on the wheel, + forward
 *   TGAMMA N   |Fx xi| + |Fy eta| summed over the patches (energy per metre; without spin)
 *   PATCHES    number of patches that carry load
 * Of a patch (RS_PATCH_...): load N; xi, eta -, phi 1/m; Fx, Fy N, Mz N m on the wheel in the contact plane (x of
 *   the rolling direction, z into the rail); x, across, radius m, angle rad, a, b m as in contact/contact_table.h.
 */
#ifndef RS_WHEEL_RAIL_H
#define RS_WHEEL_RAIL_H

#include "railsym.h"

#endif
