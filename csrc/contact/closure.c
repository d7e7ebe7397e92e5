/* SPDX-License-Identifier: BSD-3-Clause */
/* Rigid contact of one zone: the drop at which its least gap is zero. The least gap falls by cos(roll) - r' sin(roll) for a
 * drop of one, r' the slope of the wheel there. */
#include <math.h>

#include "posture.h"

#define CLOSED 1e-12 /* m */
enum { LOWERINGS = 4 };

static int in_zone(const rs_posture *p, int k, rs_zone zone)
{
	return p->across[k] >= zone.low && p->across[k] < zone.high;
}

/* Where a zone ends between its sample k and the one beside it: the gap there, if it is less than at k. */
static double gap_at_cut(const rs_posture *p, int k, rs_zone zone, int side, double *place)
{
	double cut = p->across[k + side] < zone.low ? zone.low : zone.high;
	double t = (cut - p->across[k]) / (p->across[k + side] - p->across[k]);
	*place = k + side * t;
	return p->gap[k] + t * (p->gap[k + side] - p->gap[k]);
}

/* Least gap of a zone and its place (sample number and fraction), infinite where none of it is over the rail; whether it lies
 * at the end of a profile, where no contact can be computed. */
static double least_gap(const rs_posture *p, rs_zone zone, double *place, int *end)
{
	double least = INFINITY;
	int last = p->from->rail_count - 1, at = -1;
	for (int k = 0; k <= last; k++)
		if (p->gap[k] < least && in_zone(p, k, zone)) {
			least = p->gap[k];
			at = k;
		}
	*place = at;
	*end = at <= 0 || at >= last || !isfinite(p->gap[at - 1]) || !isfinite(p->gap[at + 1]);
	if (*end)
		return least;
	for (int side = -1; side <= 1; side += 2)
		if (!in_zone(p, at + side, zone)) {
			double there = gap_at_cut(p, at, zone, side, place);
			if (there < least)
				return there;
		}
	/* vertex of the parabola through three samples */
	double before = p->gap[at - 1] - least, after = p->gap[at + 1] - least, bend = before + after;
	double t = bend > 0.0 ? 0.5 * (before - after) / bend : 0.0;
	*place = at + t;
	return least - 0.25 * (before - after) * t;
}

double rs_close_zone(rs_posture *p, rs_zone zone)
{
	double place, across = NAN, slope = 0.0, Y, Z;
	int end = 0;
	p->drop = 0.0;
	for (int k = 0; k < LOWERINGS; k++) {
		rs_gaps(p);
		double least = least_gap(p, zone, &place, &end);
		if (!isfinite(least))
			return 0.0;
		rs_rail_at(p->from, place, &Y, &Z);
		rs_gap_at(p, Y, Z, &across, &slope);
		if (fabs(least) < CLOSED)
			break;
		p->drop += least / (p->cosine - slope * p->sine);
	}
	p->touch_across = across;
	p->touch_slope = slope;
	double cosine = 1.0 / sqrt(1.0 + slope * slope);
	return end ? -cosine : cosine;
}
