/* SPDX-License-Identifier: BSD-3-Clause */
/* A wheel held over its rail at one shift and roll, while a contact table is built. */
#ifndef RS_POSTURE_H
#define RS_POSTURE_H

#include "contact_table.h"
#include "strips.h"

typedef struct {
	const rs_surfaces *from;
	double y, drop;                /* m */
	double sine, cosine;           /* of the roll */
	double touch_across, touch_slope; /* where the last zone closed touches: place on the wheel, its slope */
	int touch_point;                  /* and the nearest rail point */
	int first, last;               /* rail points among which a patch is looked for */
	double gap_drop;               /* m, drop at which the gaps were taken */
	double *across, *gap, *slope;  /* of each rail point: place Y' on the wheel, gap, slope r' of the wheel */
} rs_posture;

typedef struct {
	double low, high;              /* m, places on the wheel */
} rs_zone;

/* surfaces.c */
void rs_rail_at(const rs_surfaces *from, double place, double *Y, double *Z);
double rs_gap_at(const rs_posture *p, double Y, double Z, double *across, double *slope);
void rs_gaps(rs_posture *p);
double rs_wheel_radius(const rs_surfaces *from, double across);

/* closure.c: moves the posture to the drop at which the zone touches; rs_gaps was called at the drop where it is, or near it.
 * Returns the cosine of the slope there, negative where that is at the end of a profile, 0 where none of the zone is over the rail. */
double rs_close_zone(rs_posture *p, rs_zone zone);

/* patch.c: points that overlap when lowered by depth (m) from where the gaps were taken, the only ones that less depth needs. */
void rs_limit_search(rs_posture *p, double depth);

/* patch.c: fields of a zone lowered by depth (m, vertical) from where it touches; normal (m): the same along the normal;
 * length: half lengths of the strips over sqrt(normal), a guess (zeros: none) and what was found. */
int rs_patch_fields(const rs_posture *p, const rs_influence *influence, double modulus, rs_zone zone, double depth, double normal,
                    double *length, double *field);

#endif
