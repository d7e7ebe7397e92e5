/* SPDX-License-Identifier: BSD-3-Clause */
/* Shen, Hedrick and Elkins: Kalker's linear forces, their resultant saturated.
 *
 *   u = |(u1, u2 + u3)|    R(u) = 1 - u/3 + u^2/27 for u < 3, else 1/u    (h0, h1) = R(u) linear forces
 *   m = linear moment (kalker_linear.c)    v^2 = u^2 + (m/M)^2, M = 3 pi/16    h2 = R(v) m
 *
 * Z.Y. Shen, J.K. Hedrick, J.A. Elkins, A comparison of alternative creep force models for rail vehicle
 * dynamic analysis, IAVSD 1983. The paper gives the forces; the moment is ours: reduced by the
 * same function, of a number that grows with the moment too, since forces of lateral creepage and spin can cancel
 * and their moments add. It never exceeds that of a circular contact turning on the spot, M mu N a.
 * R and its slope are continuous at 3.
 */
#include "../creep.h"

#define LARGEST_MOMENT (3.0 * RS_PI / 16.0)

/* R(u), and R'/u, which is 0 where u is: it is multiplied by terms in u^2. */
RS_INLINE void saturation(const rs_lane *square, rs_lane *R, rs_lane *slope_over_u)
{
	rs_lane u;
	RS_SQRT(u, *square);
	RS_EACH(l) {
		double x = RS_OF(u, l), inverse = 1.0 / (x > 0.0 ? x : INFINITY);
		RS_AT(*R, l) = x < 3.0 ? 1.0 - x / 3.0 + x * x / 27.0 : inverse;
		RS_AT(*slope_over_u, l) = x < 3.0 ? (x > 0.0 ? 2.0 / 27.0 : 0.0) - inverse / 3.0 : -inverse * inverse * inverse;
	}
}

RS_CLONES void rs_creep_shen_hedrick_elkins(const rs_creep_input *in, int slopes, rs_creep_value *out)
{
	rs_lane x = in->u[0], y = in->u[1] + in->u[2], square = x * x + y * y, R, slope, of_moment, moment_slope;
	rs_lane of_lateral = in->c23 / in->c22, of_spin = -in->c33 / in->c23;
	rs_lane moment = of_lateral * in->u[1] + of_spin * in->u[2];
	rs_lane turned = moment / (LARGEST_MOMENT * LARGEST_MOMENT), both = square + moment * turned;
	saturation(&square, &R, &slope);
	saturation(&both, &of_moment, &moment_slope);
	out->h[0] = -R * x;
	out->h[1] = -R * y;
	out->h[2] = of_moment * moment;
	if (!slopes)
		return;
	rs_lane R_x = slope * x, R_y = slope * y, direct = of_moment + moment_slope * moment * turned, side = moment_slope * moment;
	out->d[0][0] = -R - R_x * x;
	out->d[0][1] = out->d[0][2] = -R_y * x;
	out->d[1][0] = -R_x * y;
	out->d[1][1] = out->d[1][2] = -R - R_y * y;
	out->d[2][0] = side * x;
	out->d[2][1] = direct * of_lateral + side * y;
	out->d[2][2] = direct * of_spin + side * y;
}
