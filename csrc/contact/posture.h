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

/* Half lengths of the strips (m) of the last patches of a zone, the last one first, and the roots of their normal penetrations:
 * the next deeper one is guessed from them. */
typedef struct {
	int known;
	double root[2], length[2][RS_STRIPS];
} rs_patch_guess;

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
 * guess: the patches before; this one is added. */
int rs_patch_fields(const rs_posture *p, const rs_influence *influence, double modulus, rs_zone zone, double depth, double normal,
                    rs_patch_guess *guess, double *field);

#endif
