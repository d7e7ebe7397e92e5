/* SPDX-License-Identifier: BSD-3-Clause */
/* All wheels of a vehicle: look up, batch the patches in lanes of eight, sum up each wheelset.
 *
 *   rows of x y z: -F    yaw: -ez M    roll: -forward M    spin: -axle M
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../contact/contact_table.h"
#include "motion.h"
#include "vectors.h"

static rs_lookup *lookup_of(int kind, int tangents)
{
	switch (kind) {
	case RS_CONTACT_CONES:
		return rs_contact_cones_lookup;
	case RS_CONTACT_TABLE:
		return tangents ? rs_contact_lookup : rs_contact_lookup_values;
	default:
		return NULL;
	}
}

static int fit(int wheelsets, const rs_wheelset *wheelset, const rs_creep_settings *creep)
{
	if (wheelsets <= 0 || creep->strips < 1 || creep->cells < 1 || creep->pieces < 1 || !rs_creep_law_at(creep->law) ||
	    (creep->law == RS_CREEP_EXACT && !creep->table))
		return 0;
	for (int k = 0; k < 2 * wheelsets; k++)
		if (!lookup_of(wheelset[k / 2].wheel[k % 2].kind, 1) || !wheelset[k / 2].wheel[k % 2].shape)
			return 0;
	return 1;
}

rs_wheel_rail *rs_wheel_rail_create(int wheelsets, const rs_wheelset *wheelset, const rs_creep_settings *creep)
{
	if (!fit(wheelsets, wheelset, creep))
		return NULL;
	rs_wheel_rail *wr = calloc(1, sizeof *wr);
	if (!wr)
		return NULL;
	size_t n = (size_t)wheelsets, coefficients = 16 * (size_t)creep->pieces;
	wr->wheelset = malloc(n * sizeof *wr->wheelset);
	wr->axle = calloc(n, sizeof *wr->axle);
	wr->wheels = aligned_alloc(sizeof(rs_lane), (2 * n + RS_LANES - 1) / RS_LANES * sizeof *wr->wheels);
	wr->found = aligned_alloc(sizeof(rs_lane), (2 * n * RS_ZONES + RS_LANES - 1) / RS_LANES * sizeof *wr->found);
	wr->coefficients = malloc(coefficients * sizeof *wr->coefficients);
	if (!wr->wheelset || !wr->axle || !wr->wheels || !wr->found || !wr->coefficients) {
		rs_wheel_rail_free(wr);
		return NULL;
	}
	wr->wheelsets = wheelsets;
	wr->creep = *creep;
	wr->law = rs_creep_law_at(creep->law);
	wr->failed_wheel = wr->failed_variable = -1;
	memcpy(wr->wheelset, wheelset, n * sizeof *wheelset);
	memcpy(wr->coefficients, creep->c, coefficients * sizeof *creep->c);
	wr->creep.c = wr->coefficients;
	return wr;
}

void rs_wheel_rail_free(rs_wheel_rail *wr)
{
	if (!wr)
		return;
	free(wr->wheelset);
	free(wr->axle);
	free(wr->wheels);
	free(wr->found);
	free(wr->coefficients);
	free(wr);
}

static int fail(rs_wheel_rail *wr, int status, int wheel, int variable, double value)
{
	wr->failed_wheel = wheel;
	wr->failed_variable = variable;
	wr->failed_value = value;
	return status;
}

static int look_up(rs_wheel_rail *wr, int number, int tangents)
{
	rs_wheel_state *wheel = &wr->axle[number / 2].wheel[number % 2];
	const rs_wheel *given = &wr->wheelset[number / 2].wheel[number % 2];
	int beyond = 0;
	wheel->count = 0;
	for (int k = 0; k < RS_PLACE_SIZE; k++)
		if (!isfinite(wheel->place[k]))
			return fail(wr, RS_NOT_FINITE, number, k, wheel->place[k]);
	int status = lookup_of(given->kind, tangents)(given->shape, wheel->place, wheel->patch, &wheel->count, &beyond);
	if (status != RS_OK)
		return fail(wr, status, number, beyond, wheel->place[beyond]);
	for (int k = 0; k < wheel->count; k++) {
		double ratio = log(wheel->patch[k].a[0] / wheel->patch[k].b[0]);
		if (!rs_kalker_covers(&wr->creep, ratio))
			return fail(wr, RS_OUT_OF_TABLE, number, RS_PLACE_SIZE, ratio);
		wheel->log_ratio[k] = ratio;
	}
	return RS_OK;
}

static void clear(rs_axle_state *axle, int tangents)
{
	for (int k = 0; k < 2; k++) {
		rs_wheel_state *wheel = &axle->wheel[k];
		EACH_AXIS(i)
			wheel->force[i] = wheel->moment[i] = 0.0;
		if (!tangents)
			continue;
		memset(wheel->force_to, 0, sizeof wheel->force_to);
		memset(wheel->moment_to, 0, sizeof wheel->moment_to);
	}
}

/* The patches of all wheels, eight at a time, in the order of the wheels. */
static void all_patches(rs_wheel_rail *wr, double V, int tangents)
{
	rs_batch batch;
	batch.count = wr->batches = 0;
	for (int number = 0; number < 2 * wr->wheelsets; number++) {
		const rs_wheel_state *wheel = &wr->axle[number / 2].wheel[number % 2];
		for (int k = 0; k < wheel->count; k++) {
			batch.wheel[batch.count] = number;
			batch.patch[batch.count++] = k;
			if (batch.count < RS_LANES)
				continue;
			rs_patch_forces(wr, V, tangents, &batch, &wr->found[wr->batches++]);
			batch.count = 0;
		}
	}
	if (batch.count)
		rs_patch_forces(wr, V, tangents, &batch, &wr->found[wr->batches++]);
}

static int rows_are_finite(rs_wheel_rail *wr)
{
	for (int number = 0; number < 2 * wr->wheelsets; number++) {
		const rs_wheel_state *wheel = &wr->axle[number / 2].wheel[number % 2];
		double sum = 0.0;
		EACH_AXIS(i)
			sum += wheel->force[i] + wheel->moment[i];
		if (!isfinite(sum)) {
			fail(wr, RS_NOT_FINITE, number, -1, sum);
			return 0;
		}
	}
	return 1;
}

/* Left and right in one sum each, so that mirrored motion has mirrored rows to the last bit. */
static void axle_rows(const rs_axle_state *axle, double *moment, double *rows)
{
	const rs_wheel_state *left = &axle->wheel[0], *right = &axle->wheel[1];
	EACH_AXIS(i) {
		moment[i] = left->moment[i] + right->moment[i];
		rows[i] = -(left->force[i] + right->force[i]);
	}
	rows[3] = -moment[2];
	rows[4] = -DOT(axle->forward, moment);
	rows[5] = -DOT(axle->axle, moment);
}

static void axle_block(const rs_axle_state *axle, const double *moment, double *block)
{
	const rs_wheel_state *left = &axle->wheel[0], *right = &axle->wheel[1];
	for (int k = 0; k < RS_COLUMNS; k++) {
		double to[3];
		EACH_AXIS(i) {
			to[i] = left->moment_to[k][i] + right->moment_to[k][i];
			block[RS_COLUMNS * i + k] = -(left->force_to[k][i] + right->force_to[k][i]);
		}
		block[RS_COLUMNS * 3 + k] = -to[2];
		block[RS_COLUMNS * 4 + k] = -DOT(axle->forward, to) - DOT(axle->forward_to[k], moment);
		block[RS_COLUMNS * 5 + k] = -DOT(axle->axle, to) - DOT(axle->axle_to[k], moment);
	}
}

/* The axle's directions and its wheels' places out of their lanes. */
static void take_motion(rs_wheel_rail *wr, int k)
{
	rs_axle_state *axle = &wr->axle[k];
	for (int side = 0; side < 2; side++) {
		const rs_wheels *from = &wr->wheels[(2 * k + side) / RS_LANES];
		int l = (2 * k + side) % RS_LANES;
		for (int i = 0; i < RS_PLACE_SIZE; i++)
			axle->wheel[side].place[i] = RS_OF(from->place[i], l);
		EACH_AXIS(i) {
			axle->forward[i] = RS_OF(from->forward[i], l);
			axle->axle[i] = RS_OF(from->at.a[i], l);
		}
	}
}

int rs_wheel_rail_rows(rs_wheel_rail *wr, const double *q, const double *u, double V, const double *w,
                       const double *rail, const double *seed, double *rows, double *blocks)
{
	wr->failed_wheel = wr->failed_variable = -1;
	if (!(V > 0.0))
		return fail(wr, RS_BAD_SPEED, -1, -1, V);
	for (int first = 0; first < 2 * wr->wheelsets; first += RS_LANES)
		rs_wheel_motion(wr, q, u, V, w, rail, first, &wr->wheels[first / RS_LANES]);
	for (int k = 0; k < wr->wheelsets; k++) {
		take_motion(wr, k);
		if (blocks)
			rs_axle_tangents(wr->wheels, 2 * k, u + wr->wheelset[k].first, w + 3 * k, seed, &wr->axle[k]);
		clear(&wr->axle[k], blocks != NULL);
		for (int side = 0; side < 2; side++) {
			int status = look_up(wr, 2 * k + side, blocks != NULL);
			if (status != RS_OK)
				return status;
		}
	}
	all_patches(wr, V, blocks != NULL);
	if (!rows_are_finite(wr))
		return RS_NOT_FINITE;
	for (int k = 0; k < wr->wheelsets; k++) {
		double moment[3];
		axle_rows(&wr->axle[k], moment, rows + 6 * k);
		if (blocks)
			axle_block(&wr->axle[k], moment, blocks + 36 * k);
	}
	return RS_OK;
}

void rs_wheel_rail_failure(const rs_wheel_rail *wr, int *wheel, int *variable, double *value, double *place)
{
	*wheel = wr->failed_wheel;
	*variable = wr->failed_variable;
	*value = wr->failed_value;
	for (int k = 0; k < RS_PLACE_SIZE; k++)
		place[k] = wr->failed_wheel < 0 ? 0.0 : wr->axle[wr->failed_wheel / 2].wheel[wr->failed_wheel % 2].place[k];
}

static void patch_outputs(const rs_found *found, int l, double *to)
{
	to[RS_PATCH_LOAD] = RS_OF(found->load, l);
	for (int j = 0; j < 3; j++) {
		to[RS_PATCH_XI + j] = RS_OF(found->creepage[j], l);
		to[RS_PATCH_FX + j] = RS_OF(found->creep[j], l);
	}
	for (int j = 0; j < 6; j++)
		to[RS_PATCH_X + j] = RS_OF(found->place[j], l);
}

void rs_wheel_rail_outputs(const rs_wheel_rail *wr, double *wheel, double *patch)
{
	memset(patch, 0, sizeof(double) * 2 * (size_t)wr->wheelsets * RS_ZONES * RS_PATCH_OUTPUTS);
	for (int number = 0; number < 2 * wr->wheelsets; number++) {
		const rs_wheel_state *from = &wr->axle[number / 2].wheel[number % 2];
		double *to = wheel + RS_WHEEL_OUTPUTS * number;
		to[RS_WHEEL_Y] = number % 2 ? -from->force[1] : from->force[1];
		to[RS_WHEEL_Q] = -from->force[2];
		to[RS_WHEEL_X] = from->force[0];
		to[RS_WHEEL_TGAMMA] = to[RS_WHEEL_PATCHES] = 0.0;
	}
	for (int k = 0; k < wr->batches; k++)
		for (int l = 0; l < wr->found[k].batch.count; l++) {
			const rs_batch *batch = &wr->found[k].batch;
			int number = batch->wheel[l], zone = wr->axle[number / 2].wheel[number % 2].patch[batch->patch[l]].zone;
			double *to = wheel + RS_WHEEL_OUTPUTS * number, *own = patch + RS_PATCH_OUTPUTS * (RS_ZONES * number + zone);
			patch_outputs(&wr->found[k], l, own);
			to[RS_WHEEL_PATCHES] += own[RS_PATCH_LOAD] > 0.0;
			to[RS_WHEEL_TGAMMA] += fabs(own[RS_PATCH_XI] * own[RS_PATCH_FX]) + fabs(own[RS_PATCH_XI + 1] * own[RS_PATCH_FX + 1]);
		}
}
