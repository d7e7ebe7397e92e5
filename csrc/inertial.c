/* SPDX-License-Identifier: BSD-3-Clause */
/* What an inertial unit on a body feels: angular velocity, and acceleration less gravity, in the body's axes.
 *
 *     R = Rz(yaw) Rx(roll) Ry(pitch),   l = R arm,   p = design place + x + l
 *     omega, alpha of the body against its track frame, w and dw = w' of the frame, V and dV along its x:
 *     turning = R^T (w + omega)
 *     force   = R^T (x'' + alpha x l + omega x (omega x l) + (dV, 0, 0) + w x (V, 0, 0)
 *                    + dw x p + w x (w x p) + 2 w x (x' + omega x l) - gravity)
 */
#include <math.h>
#include <string.h>

#include "integrator.h"

static void add_cross(double *to, const double *a, const double *b, double factor)
{
	to[0] += factor * (a[1] * b[2] - a[2] * b[1]);
	to[1] += factor * (a[2] * b[0] - a[0] * b[2]);
	to[2] += factor * (a[0] * b[1] - a[1] * b[0]);
}

/* R by rows; axes of roll and pitch, turned by what comes before them. */
static void attitude(const double *angle, double *R, double *across, double *axle)
{
	double sz = sin(angle[0]), cz = cos(angle[0]), sx = sin(angle[1]), cx = cos(angle[1]), sy = sin(angle[2]), cy = cos(angle[2]);
	double rows[9] = {cz * cy - sz * sx * sy, -sz * cx, cz * sy + sz * sx * cy, sz * cy + cz * sx * sy, cz * cx,
	                  sz * sy - cz * sx * cy, -cx * sy, sx, cx * cy};
	memcpy(R, rows, sizeof rows);
	memcpy(across, (double[3]){cz, sz, 0.0}, 3 * sizeof *across);
	memcpy(axle, (double[3]){-sz * cx, cz * cx, sx}, 3 * sizeof *axle);
}

/* Angular velocity and acceleration against the track frame from the rates of the angles and theirs. */
static void turning(const double *u, const double *a, const double *across, const double *axle, double *omega, double *alpha)
{
	double first[3] = {0.0, 0.0, u[0]}, second[3];
	for (int k = 0; k < 3; k++)
		second[k] = first[k] + across[k] * u[1];
	for (int k = 0; k < 3; k++) {
		omega[k] = second[k] + axle[k] * u[2];
		alpha[k] = (k == 2 ? a[0] : 0.0) + across[k] * a[1] + axle[k] * a[2];
	}
	add_cross(alpha, first, across, u[1]);
	add_cross(alpha, second, axle, u[2]);
}

static void into_body(const double *R, const double *from, double *to)
{
	for (int k = 0; k < 3; k++)
		to[k] = R[k] * from[0] + R[3 + k] * from[1] + R[6 + k] * from[2];
}

/* q, u, a: x y z yaw roll pitch. frame: V, w, dV, dw, gravity (11 numbers). */
static void feel(const double *q, const double *u, const double *a, const double *frame, const double *design, const double *arm,
                 double *felt)
{
	double R[9], across[3], axle[3], omega[3], alpha[3], lever[3], place[3], spin[3], rate[3], force[3], total[3];
	const double *w = frame + 1, *dw = frame + 5, *gravity = frame + 8, along[3] = {frame[0], 0.0, 0.0};
	attitude(q + 3, R, across, axle);
	turning(u + 3, a + 3, across, axle, omega, alpha);
	for (int k = 0; k < 3; k++) {
		lever[k] = R[3 * k] * arm[0] + R[3 * k + 1] * arm[1] + R[3 * k + 2] * arm[2];
		place[k] = design[k] + q[k] + lever[k];
		total[k] = w[k] + omega[k];
		rate[k] = u[k];
		force[k] = a[k] - gravity[k];
		spin[k] = 0.0;
	}
	add_cross(spin, omega, lever, 1.0);
	for (int k = 0; k < 3; k++)
		rate[k] += spin[k];
	force[0] += frame[4];
	add_cross(force, alpha, lever, 1.0);
	add_cross(force, omega, spin, 1.0);
	add_cross(force, w, along, 1.0);
	add_cross(force, dw, place, 1.0);
	memset(spin, 0, sizeof spin);
	add_cross(spin, w, place, 1.0);
	add_cross(force, w, spin, 1.0);
	add_cross(force, w, rate, 2.0);
	into_body(R, force, felt);
	into_body(R, total, felt + 3);
}

/* Number of an input of one instance in its group; others of the lane follow rs_kernel_lanes() apart. */
static const double *input_of(const rs_group *group, const rs_kernel_info *info, int instance, const char *name)
{
	int lanes = rs_kernel_lanes(), slot = rs_kernel_slot(info, name);
	return group->in + (size_t)(instance / lanes) * (size_t)(info->inputs * lanes) + slot * lanes + instance % lanes;
}

int rs_integrator_inertial(rs_integrator *it, int kernel, int instance, const double *arm, double *felt)
{
	const rs_kernel_info *info = rs_kernel_describe(kernel);
	const rs_group *group = it->system->model->groups + kernel;
	if (!info || rs_kernel_slot(info, "dV") < 0 || instance < 0 || instance >= group->count)
		return RS_BAD_INDEX;
	int status = rs_integrator_move(it, it->report.time), lanes = rs_kernel_lanes();
	if (status)
		return status;
	double state[18], frame[11], design[3];
	const double *motion = input_of(group, info, instance, "V"), *place = input_of(group, info, instance, "offset0");
	const double *from[3] = {it->q, it->sample_u, it->sample_a};
	const int *index = group->index + instance * info->coordinates;
	int spins = info->slots[5 * 5 + 3] < 0; /* the sixth coordinate's sine is no input */
	rs_integrator_at_end(it, it->sample_u, it->sample_a);
	for (int part = 0; part < 3; part++)
		for (int c = 0; c < 6; c++)
			state[6 * part + c] = c == 5 && spins ? 0.0 : from[part][index[c]];
	for (int k = 0; k < 11; k++)
		frame[k] = motion[k * lanes];
	for (int k = 0; k < 3; k++)
		design[k] = place[k * lanes];
	feel(state, state + 6, state + 12, frame, design, arm, felt);
	return RS_OK;
}
