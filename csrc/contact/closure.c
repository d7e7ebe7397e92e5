/* SPDX-License-Identifier: BSD-3-Clause */
/* Rigid contact of one zone: the drop at which its least gap is zero. The least gap falls by cos(roll) - r' sin(roll) for a
 * drop of one, r' the slope of the wheel there. The whole rail is searched once, at the drop where the posture starts; then a
 * window that goes along with the least gap. */
#include <math.h>

#include "posture.h"

#define CLOSED 1e-12 /* m */
enum { LOWERINGS = 12, BESIDE = 6, WINDOW = 2 * BESIDE + 1 };

typedef struct {
	int first, count;                    /* rail points */
	double across[WINDOW], gap[WINDOW];
} window;

static int in_zone(double across, rs_zone zone)
{
	return across >= zone.low && across < zone.high;
}

/* Rail point of least gap in a zone, -1 where none of it is over the rail. */
static int least_point(const double *across, const double *gap, int count, rs_zone zone)
{
	double least = INFINITY;
	int at = -1;
	for (int k = 0; k < count; k++)
		if (gap[k] < least && in_zone(across[k], zone)) {
			least = gap[k];
			at = k;
		}
	return at;
}

static void look(const rs_posture *p, int at, window *w)
{
	int last = p->from->rail_count - 1;
	w->first = at > BESIDE ? at - BESIDE : 0;
	w->count = (at + BESIDE < last ? at + BESIDE : last) - w->first + 1;
	for (int k = 0; k < w->count; k++) {
		double slope;
		w->gap[k] = rs_gap_at(p, p->from->rail_y[w->first + k], p->from->rail_z[w->first + k], &w->across[k], &slope);
	}
}

/* Place of the least gap (rail point and fraction): the vertex of the parabola through three points. */
static double vertex(const window *w, int k)
{
	double before = w->gap[k - 1] - w->gap[k], after = w->gap[k + 1] - w->gap[k], bend = before + after;
	return w->first + k + (bend > 0.0 ? 0.5 * (before - after) / bend : 0.0);
}

/* Gap at a place, with what there is to know of the wheel there. */
static double touch(rs_posture *p, double place)
{
	double Y, Z;
	rs_rail_at(p->from, place, &Y, &Z);
	return rs_gap_at(p, Y, Z, &p->touch_across, &p->touch_slope);
}

/* At the end of a profile no contact can be computed. */
static int at_end(const rs_posture *p, const window *w, int k)
{
	int point = w->first + k;
	return point == 0 || point == p->from->rail_count - 1 || !isfinite(w->gap[k - 1]) || !isfinite(w->gap[k + 1]);
}

double rs_close_zone(rs_posture *p, rs_zone zone)
{
	window w;
	int at = least_point(p->across, p->gap, p->from->rail_count, zone), end = 1;
	if (at < 0)
		return 0.0;
	for (int k = 0; k < LOWERINGS; k++) {
		look(p, at, &w);
		int here = least_point(w.across, w.gap, w.count, zone);
		if (here < 0)
			return 0.0;
		int edge = w.first + here;
		if (edge != at && (here == 0 || here == w.count - 1) && edge > 0 && edge < p->from->rail_count - 1) {
			at = edge; /* the least gap lies further on */
			continue;
		}
		at = edge;
		end = at_end(p, &w, here);
		if (!end && (w.gap[here - 1] < w.gap[here] || w.gap[here + 1] < w.gap[here]))
			return 0.0; /* the gap falls beyond the end of the zone: the neighbour's contact */
		double least = touch(p, end ? at : vertex(&w, here));
		if (!(least <= w.gap[here]))
			least = touch(p, at); /* an edge of the rail: no parabola */
		if (fabs(least) < CLOSED)
			break;
		p->drop += least / (p->cosine - p->touch_slope * p->sine);
	}
	p->touch_point = at;
	double cosine = 1.0 / sqrt(1.0 + p->touch_slope * p->touch_slope);
	return end ? -cosine : cosine;
}
