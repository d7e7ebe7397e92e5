/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact table of one wheel on one rail, looked at as a right-hand side.
 *
 * The wheel's place against its rail is four numbers: lateral shift y towards the field, roll (field
 * side down), drop of the wheelset's centre below the height r0 over the top of rail, and yaw (about
 * z, down). For the left wheel y, roll and yaw change sign, and so do the lateral parts of what comes
 * back; x, heights, loads and radii do not.
 *
 * The wheel is cut into at most RS_ZONES zones (tread, flange), each with one patch of contact. With
 *
 *   eta = y - r0 roll                       shift of the wheel at the height of its contact
 *   P   = drop - c(eta, roll) + yaw^2/2 t (r t - Y'),  t = -dc/d(eta)              penetration, vertical
 *   p   = s(eta, roll) P,  tau = sqrt(p/p_max)                                    normal penetration
 *
 * (c: drop at which a zone touches; s, r, Y': cosine of the contact angle, radius and place on the wheel
 * there; the term with yaw: the outline of a yawed wheel, to the second order), a zone carries load K p^(3/2), and K, the place of the contact,
 * its angle, and a/p^(1/2), b/p^(1/2) are tabled over (eta, roll, tau) from the elastic contact of
 * strips.c. Between the nodes all of them are quadratic splines (contact_spline.c): continuous with continuous slopes. Each zone has its own nodes of eta, over the range
 * where it can touch before the wheel is beyond the deepest penetration; outside it the zone is in the air.
 */
#ifndef RS_CONTACT_TABLE_H
#define RS_CONTACT_TABLE_H

#include "../railsym.h"

enum { RS_FIELDS = 8, RS_CLOSURE = 4 };
enum { RS_STIFFNESS, RS_ACROSS, RS_RADIUS, RS_ANGLE, RS_LENGTH, RS_WIDTH }; /* fields of a zone */

typedef struct {
	double start, step, inverse; /* inverse: 1/step */
	int count;              /* nodes, one more at each end than the range that may be read */
} rs_axis;

typedef struct {
	rs_axis shift;
	double *closure;        /* shift x roll x RS_CLOSURE, coefficients of splines: c, s, radius and place on the wheel of rigid contact */
	double *field;          /* shift x roll x level x RS_FIELDS, coefficients of splines; a stiffness that is not a number: off the rail */
} rs_zone_table;

struct rs_contact_table {
	rs_axis shift, roll;    /* shift: the whole range that may be read */
	int levels;             /* nodes of tau: one before 0, 0, 1/m ... 1, one beyond: m + 3 */
	int zones;
	double deepest;         /* p_max, m */
	double inverse_root;    /* 1/sqrt(p_max) */
	double wheel_radius;    /* r0, m */
	double spacing;         /* lateral place of the tape circle, m */
	rs_zone_table zone[RS_ZONES];
};

/* As rs_contact_lookup, the values [0] only, the same to rounding; slopes are not touched. */
int rs_contact_lookup_values(const rs_contact_table *table, const double *place, rs_patch *patch, int *count, int *beyond);

rs_axis rs_axis_of(double start, double step, int count);
rs_contact_table *rs_contact_table_allocate(const double *shape);
/* Values at the nodes to what is read (contact_spline.c). RS_OK, RS_NO_MEMORY. */
int rs_contact_table_filter(rs_contact_table *table);
int rs_zone_table_allocate(rs_contact_table *table, int zone);

#endif
