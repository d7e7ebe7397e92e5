/* SPDX-License-Identifier: BSD-3-Clause */
/* Rigid contact of one wheel on one rail at given shifts and rolls (closure.c), without a table. */
#include <math.h>
#include <stdlib.h>

#include "posture.h"

int rs_rigid_contact(const rs_surfaces *from, int n, const double *place, double *contact)
{
	static const rs_zone whole = {-INFINITY, INFINITY};
	double *room = malloc(3 * (size_t)from->rail_count * sizeof *room);
	if (!room)
		return RS_NO_MEMORY;
	rs_posture p = {.from = from, .across = room, .gap = room + from->rail_count, .slope = room + 2 * from->rail_count};
	for (int k = 0; k < n; k++, place += 2, contact += 4) {
		p.y = place[0];
		p.sine = sin(place[1]);
		p.cosine = cos(place[1]);
		rs_gaps(&p);
		double cosine = rs_close_zone(&p, whole);
		contact[0] = p.drop;
		contact[1] = p.touch_across;
		contact[2] = p.touch_slope;
		contact[3] = cosine > 0.0;
	}
	free(room);
	return RS_OK;
}
