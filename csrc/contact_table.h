/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact table of one wheel on one rail, looked at as a right-hand side.
 *
 * The wheel's place against its rail is four numbers (rs_wheel_place): lateral shift y towards the
 * field, roll (field side down), drop of the wheelset's centre below the height r0 over the top of
 * rail, and yaw (about z, down). For the left wheel y, roll and yaw change sign, and so do the
 * lateral parts of what comes back; x, heights, loads and radii do not.
 *
 * The wheel is cut into at most RS_ZONES zones (tread, flange root, flange), each with one patch of
 * contact. Every quantity of a patch is a value and its four slopes over (y, roll, drop, yaw).
 *
 * rs_contact_lookup   patches of one wheel
 *   Given     table   never written to after it is made: any number of threads may read it
 *             place   RS_PLACE_SIZE: y m, roll rad, drop m, yaw rad
 *   Returned  patch   RS_ZONES; only those that carry load are written, in the order of the zones
 *             count   number of patches written, 0 when the wheel is in the air
 *             beyond  where the status is RS_OUT_OF_TABLE: 0 y, 1 roll, 2 drop
 *   Status    RS_OK, RS_OUT_OF_TABLE (nothing is written to patch), RS_NOT_FINITE (place)
 *   Notes     No allocation. Loads and forces are continuous in the place, with continuous slopes
 *             inside a zone's contact.
 */
#ifndef RS_CONTACT_TABLE_H
#define RS_CONTACT_TABLE_H

#include "railsym.h"

typedef struct {
	double load[5];      /* N, elastic normal force, > 0 */
	double x[5];         /* m, place of the contact ahead of the wheelset's centre, in the wheelset's axes */
	double across[5];    /* m, place of the contact from the wheelset's centre along the axle, + to the field */
	double radius[5];    /* m, rolling radius: distance of the contact below the axle */
	double angle[5];     /* rad, contact plane to the track plane, positive as at a flange */
	double a[5];         /* m, semi-axis along x */
	double b[5];         /* m, semi-axis across */
	int zone;            /* 0 tread ... RS_ZONES - 1 */
} rs_patch;

int rs_contact_lookup(const rs_contact_table *table, const double *place, rs_patch *patch, int *count, int *beyond);

#endif
