/* SPDX-License-Identifier: BSD-3-Clause */
/* What a gyroscope and two accelerometers on a body read, as railsym/simulation/markers.py has it for channels:
 *
 *     second = a + alpha x r + omega x (omega x r) + w x V + dw x p + w x (w x p) + 2 w x p' + dV,   reading = R^T (second - gravity)
 */
#include <math.h>

#include "tilt.h"

static void cross(const double *a, const double *b, double *to)
{
	to[0] = a[1] * b[2] - a[2] * b[1];
	to[1] = a[2] * b[0] - a[0] * b[2];
	to[2] = a[0] * b[1] - a[1] * b[0];
}

static void add(double *to, double factor, const double *what)
{
	for (int i = 0; i < 3; i++)
		to[i] += factor * what[i];
}

/* Rz(yaw) Rx(roll) Ry(pitch), and the axes about which roll and pitch turn, in the frame. */
static void attitude(const double *q, double turn[3][3], double *across, double *axle)
{
	double cz = cos(q[3]), sz = sin(q[3]), cx = cos(q[4]), sx = sin(q[4]), cy = cos(q[5]), sy = sin(q[5]);
	const double rows[3][3] = {{cz * cy - sz * sx * sy, -sz * cx, cz * sy + sz * sx * cy},
	                           {sz * cy + cz * sx * sy, cz * cx, sz * sy - cz * sx * cy},
	                           {-cx * sy, sx, cx * cy}};
	for (int i = 0; i < 3; i++)
		for (int k = 0; k < 3; k++)
			turn[i][k] = rows[i][k];
	across[0] = cz, across[1] = sz, across[2] = 0.0;
	axle[0] = -sz * cx, axle[1] = cz * cx, axle[2] = sx;
}

static void turning(const double *u, const double *a, const double *across, const double *axle, double *omega, double *alpha)
{
	double first[3] = {0.0, 0.0, u[3]}, second[3], part[3];
	for (int i = 0; i < 3; i++) {
		second[i] = first[i] + across[i] * u[4];
		omega[i] = second[i] + axle[i] * u[5];
		alpha[i] = across[i] * a[4] + axle[i] * a[5] + (i == 2 ? a[3] : 0.0);
	}
	cross(first, across, part);
	add(alpha, u[4], part);
	cross(second, axle, part);
	add(alpha, u[5], part);
}

void rs_tilt_motion(const double *q, const double *u, const double *a, const double *offset, const double *arm, const rs_tilt_frame *frame,
                    double *out)
{
	double turn[3][3], across[3], axle[3], omega[3], alpha[3], part[3], other[3];
	attitude(q, turn, across, axle);
	turning(u, a, across, axle, omega, alpha);
	out[0] = out[1] = 0.0;
	for (int i = 0; i < 3; i++) {
		out[0] += turn[i][0] * (omega[i] + frame->w[i]);
		out[1] += turn[i][2] * (omega[i] + frame->w[i]);
	}
	const double along[3] = {frame->V, 0.0, 0.0}, ahead[3] = {frame->dV, 0.0, 0.0};
	for (int point = 0; point < 2; point++) {
		double lever[3], place[3], rate[3], second[3];
		for (int i = 0; i < 3; i++)
			lever[i] = turn[i][0] * arm[3 * point] + turn[i][1] * arm[3 * point + 1] + turn[i][2] * arm[3 * point + 2];
		cross(omega, lever, rate);
		cross(alpha, lever, second);
		cross(omega, rate, part);
		for (int i = 0; i < 3; i++) {
			second[i] += a[i] + part[i] + ahead[i] - frame->gravity[i];
			place[i] = offset[i] + q[i] + lever[i];
			rate[i] += u[i];
		}
		cross(frame->w, along, part);
		add(second, 1.0, part);
		cross(frame->dw, place, part);
		add(second, 1.0, part);
		cross(frame->w, place, other);
		cross(frame->w, other, part);
		add(second, 1.0, part);
		cross(frame->w, rate, part);
		add(second, 2.0, part);
		out[2 + point] = turn[0][1] * second[0] + turn[1][1] * second[1] + turn[2][1] * second[2];
	}
}
