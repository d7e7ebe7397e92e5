/* SPDX-License-Identifier: BSD-3-Clause */
/* The C interface of railsym.
 *
 * Axes: x along the track in the direction of travel, y to the right, z down, right-handed
 * (EN 14363, EN 13848, CONTACT). Left wheel: side -1, right wheel: side +1; wheelsets are
 * numbered from the leading one. Rolling forward turns a wheelset at -V/r0 about y. Creepages
 * are velocities of the wheel against the rail over V; spin is positive about the normal that
 * points into the rail; forces are those on the wheel. SI units, angles in rad.
 *
 * Coordinates q of the whole model, their rates u = dq/dt and accelerations a: n each.
 * Residual r = inertia - gravity + element forces + contact forces; r = 0 is the motion.
 * Pencil S = cq dr/dq + cu dr/du + ca dr/da for seed = (cq, cu, ca): (1,0,0) is the stiffness
 * matrix, (0,1,0) the damping matrix, (0,0,1) the mass matrix. Internal states are coordinates
 * whose acceleration does not appear.
 *
 * rs_kernel_real       one kernel on rs_kernel_lanes() instances
 *   Given     kernel   number below rs_kernel_count()
 *             in       inputs x lanes, lane index fastest, as named by rs_kernel_describe
 *             laws     lanes pointers (or NULL where has_law is 0)
 *             seed     3, (cq, cu, ca)
 *   Returned  r        coordinates x lanes
 *             S        entries x lanes, or NULL: skipped
 *   Status    RS_OK, RS_BAD_INDEX
 * rs_kernel_complex    the same on one complex instance: numbers are (re, im) pairs; for
 *                      derivatives by the complex step (Squire and Trapp 1998, SIAM Rev. 40)
 *
 * rs_model_create      an empty model
 *   Given     coordinates  n > 0
 *             is_angle     n, 1 where sin and cos of the coordinate are wanted
 *   Returned  the model, or NULL (no memory, or n <= 0); free with rs_model_free
 * rs_model_add         instances of one kernel; at most one call a kernel
 *   Given     in       count x inputs: parameters in their slots; coordinate slots are ignored
 *             index    count x coordinates of the kernel: number of the model's coordinate, or
 *                      -1 for one that does not exist (held at zero)
 *             laws     count pointers, kept, not copied; NULL where has_law is 0
 *   Status    RS_OK, RS_BAD_INDEX (kernel, index out of range, or added before), RS_BAD_SIZE
 *             (count <= 0), RS_NO_MEMORY
 * rs_model_set_input   new values of one input slot for every instance of a kernel
 *   Given     values   count
 *   Status    RS_OK, RS_BAD_INDEX
 * rs_model_residual, rs_model_pencil
 *   Given     q u a    n each, unchanged
 *             seed     3
 *   Returned  r        n (pencil: may be NULL)
 *             S        n x n, row by row
 *   Status    RS_OK, RS_NOT_FINITE (r has a NaN or infinity; r and S are as computed)
 *   Notes     No allocation. A model is used by one thread at a time: its lanes are its
 *             work space. Same machine, same input: same bytes.
 *
 * rs_bench_run         one element law under imposed motion, from a given state
 *   Given     law      element law; a Maxwell law has the state s, others none
 *             n        samples, >= 1
 *             time     n, s, increasing
 *             e v      n, elongation (m) and its rate (m/s)
 *             substeps TR-BDF2 steps between two samples, >= 1; e cubic, v straight between
 *             s0       m, elongation of the Maxwell damper at the start
 *   Returned  f s      n, force (N, positive pulls the ends together), state (m)
 *             failed   number of the sample that failed, n when none did
 *   Status    RS_OK, RS_NOT_FINITE, RS_NOT_CONVERGED (or a force that does not grow with speed)
 *   Notes     No allocation. Samples before the failed one are as computed.
 * rs_bench_cycles      the periodic motion of one law in several tests
 *   Given     tests, n tests, points a cycle; period: tests, s
 *             e v      tests x n, one cycle each
 *             s        tests x n; the first of each row is the guess
 *   Returned  f s      tests x n; failed: number of the test, tests when none
 *   Status    as rs_bench_run; RS_NOT_CONVERGED also for no periodic motion in 200 cycles
 *
 * rs_creep_forces      tangential forces of rolling contacts
 *   Given     law       RS_CREEP_...
 *             strips, cells   grid of FASTSIM, FaStrip: strips across, cells along each; >= 1
 *             contacts  n >= 0
 *             in        15 x n: xi -, eta -, phi 1/m, a m (along x), b m, load N, friction -, shear modulus N/m^2,
 *                       Kalker weight -, C11, C22, C23, C33 -, Polach's kA, kS -
 *   Returned  force     3 x n: Fx N, Fy N, Mz N m on the wheel
 *             slopes    18 x n: d(force i)/d(xi, eta, phi, load, friction, weight) in row 6 i + j, at
 *                       constant a, b and coefficients; or NULL: skipped
 *   Status    RS_OK, RS_BAD_INDEX (law), RS_BAD_SIZE
 *   Notes     No load or no friction: no force, no slopes. a, b, modulus, weight and coefficients must be positive;
 *             that is not checked. No allocation, no state. One law a file in csrc/creep. RS_CREEP_EXACT needs a table:
 * rs_creep_forces_exact    the same with the law RS_CREEP_EXACT
 *   Given     table     kept by the caller; coefficients finite
 *             contacts, in   as rs_creep_forces
 *   Returned  force, slopes  as rs_creep_forces
 *   Status    RS_OK, RS_BAD_SIZE (contacts, or a table without pieces or with least >= largest)
 *
 * rs_wheel_rail_...    wheel-rail forces in motion: contract in wheel_rail.h
 * rs_contact_cones     contact in closed form, for rs_wheel_rail_...: csrc/wheel_rail/cones.c
 * rs_track_...         the track's frames and rails: contracts in track.h
 *
 * rs_rigid_contact     rigid contact of one wheel on one rail, as a right-hand side (csrc/contact/contact_table.h)
 *   Given     from     surfaces; rail points at one step of arc, from the gauge to the field side
 *             place    2 x n, n after n: lateral shift m, roll rad
 *   Returned  contact  4 x n likewise: drop m at which the wheel touches, place on the wheel m, slope of the wheel there,
 *                      1 inside both profiles and 0 at an end of one
 *   Status    RS_OK, RS_NO_MEMORY
 * rs_contact_table_build   a table from surfaces
 *   Given     shape    RS_TABLE_SHAPE: start, step, nodes of the shift (m) and of the roll (rad), levels of penetration + 3,
 *                      zones, largest normal penetration m, r0 m, place of the tape circle m
 *             cuts     zones + 1 places on the wheel, m, from +infinity down to -infinity: where zones part
 *             parts    zones; each interval of the shift is cut so for the nodes of that zone
 *             modulus  contact modulus E', N/m^2
 *   Returned  made     the table, or NULL; free with rs_contact_table_free
 *             failures nodes whose patch could not be computed; there the table ends
 *   Status    RS_OK, RS_BAD_SIZE, RS_NO_MEMORY
 * rs_contact_table_of_arrays   a table from what rs_contact_table_shape and rs_contact_table_arrays gave (copied); values: 1 where
 *                      the fields are values at the nodes, and not yet what is read
 *   Status    RS_OK, RS_BAD_SIZE, RS_NO_MEMORY
 * rs_contact_lookup    patches of one wheel
 *   Given     table    never written to after it is made: any number of threads may read it
 *             place    RS_PLACE_SIZE: lateral shift y m, roll rad, drop m, yaw rad, of a right-hand side
 *   Returned  patch    RS_ZONES; only those that carry load are written, in the order of the zones
 *             count    patches written, 0 where the wheel is in the air
 *             beyond   where the status is RS_OUT_OF_TABLE: 0 shift, 1 roll, 2 penetration
 *   Status    RS_OK, RS_OUT_OF_TABLE (count is 0), RS_NOT_FINITE (place)
 *   Notes     No allocation. Values are continuous in the place with continuous slopes; slopes are those of the interpolant.
 * rs_contact_lookup_many   the same n times; patch RS_ZONES x n; beyond n: -1 where all is well, RS_PLACE_SIZE where a place is not finite
 * rs_integrator_...    integration in time: contract in integrator.h; rs_travel_... track frames in motion: travel.h
 */
#ifndef RAILSYM_H
#define RAILSYM_H

#include "interface.h"
#include "tilt/tilt_interface.h"

#endif
