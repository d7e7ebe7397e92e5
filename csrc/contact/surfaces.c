/* SPDX-License-Identifier: BSD-3-Clause */
/* Gap between a wheel and a rail. With the wheelset's centre at the height zc = -r0 + drop, a point (Y, Z) of the rail lies in
 * the wheelset's axes at
 *
 *   Y' = cos(roll) (Y - y) + sin(roll) (Z - zc)        Z' = -sin(roll) (Y - y) + cos(roll) (Z - zc)
 *
 * and is g = Z' - r(Y') below the wheel, whose radius there is r.
 */
#include <math.h>

#include "posture.h"

#define EDGE 0.98 /* cosine of the turn of the rail from one sample to the next, 11 degrees: less is no curve but an edge */

/* Radius of the wheel and its slope, cubic between samples; 0 where the wheel ends. */
static int wheel_at(const rs_surfaces *f, double across, double *radius, double *slope)
{
	double inverse = 1.0 / f->wheel_step, t = (across - f->wheel_start) * inverse;
	if (!(t >= 0.0 && t < f->wheel_count - 1))
		return 0;
	int k = (int)t;
	t -= k;
	double h = f->wheel_step, r0 = f->wheel_radius_at[k], rise = f->wheel_radius_at[k + 1] - r0;
	double m0 = h * f->wheel_slope_at[k], m1 = h * f->wheel_slope_at[k + 1];
	double c2 = 3.0 * rise - 2.0 * m0 - m1, c3 = m0 + m1 - 2.0 * rise;
	*radius = r0 + t * (m0 + t * (c2 + t * c3));
	*slope = (m0 + t * (2.0 * c2 + t * 3.0 * c3)) * inverse;
	return 1;
}

/* Gap, place on the wheel and slope of the wheel there; an infinite gap where the wheel ends. */
double rs_gap_at(const rs_posture *p, double Y, double Z, double *across, double *slope)
{
	double away = Y - p->y, below = Z + p->from->wheel_radius - p->drop, radius;
	*across = p->cosine * away + p->sine * below;
	if (!wheel_at(p->from, *across, &radius, slope)) {
		*slope = 0.0;
		return INFINITY;
	}
	return p->cosine * below - p->sine * away - radius;
}

void rs_gaps(rs_posture *p)
{
	p->gap_drop = p->drop;
	for (int k = 0; k < p->from->rail_count; k++)
		p->gap[k] = rs_gap_at(p, p->from->rail_y[k], p->from->rail_z[k], &p->across[k], &p->slope[k]);
}

/* Point of the rail at a sample number with its fraction: cubic in arc length, straight where the rail has an edge. */
void rs_rail_at(const rs_surfaces *f, double place, double *Y, double *Z)
{
	int k = (int)place;
	k = k < 0 ? 0 : k > f->rail_count - 2 ? f->rail_count - 2 : k;
	double t = place - k, h = f->rail_step, along = t, p = 0.0, q = 0.0;
	if (f->rail_cosine[k] * f->rail_cosine[k + 1] + f->rail_sine[k] * f->rail_sine[k + 1] > EDGE) {
		along = t * t * (3.0 - 2.0 * t);
		p = t * (1.0 - t) * (1.0 - t) * h;
		q = t * t * (t - 1.0) * h;
	}
	*Y = f->rail_y[k] + along * (f->rail_y[k + 1] - f->rail_y[k]) + p * f->rail_cosine[k] + q * f->rail_cosine[k + 1];
	*Z = f->rail_z[k] + along * (f->rail_z[k + 1] - f->rail_z[k]) + p * f->rail_sine[k] + q * f->rail_sine[k + 1];
}

double rs_wheel_radius(const rs_surfaces *from, double across)
{
	double radius, slope;
	return wheel_at(from, across, &radius, &slope) ? radius : NAN;
}
