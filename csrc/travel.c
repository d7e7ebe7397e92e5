/* SPDX-License-Identifier: BSD-3-Clause */
/* Track frames in motion:
 *
 *     w = V turning,   dw = dV turning + V^2 turning',   gravity in the frame = g (third row of P)
 *
 * and the pose of one frame seen from another for the elements that join two. Only what moves is
 * written: elements within one frame keep the inputs they were made with.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "travel.h"

static double *copied(const double *from, int count)
{
	double *to = malloc((size_t)(count + 1) * sizeof *to);
	if (to)
		memcpy(to, from, (size_t)count * sizeof *to);
	return to;
}

rs_travel *rs_travel_create(const rs_track *track, int frames, const double *x, int pieces, const double *time,
                            const double *place, const double *speed, const double *acceleration, double gravity)
{
	rs_travel *travel = frames > 0 && pieces > 0 ? calloc(1, sizeof *travel) : NULL;
	if (!travel)
		return NULL;
	travel->track = track;
	travel->frames = frames;
	travel->pieces = pieces;
	travel->gravity = gravity;
	travel->written[0] = NAN;
	travel->x = copied(x, frames);
	travel->time = copied(time, pieces);
	travel->place = copied(place, pieces);
	travel->start_speed = copied(speed, pieces);
	travel->acceleration = copied(acceleration, pieces);
	travel->frame = calloc((size_t)frames, sizeof *travel->frame);
	travel->straight = malloc((size_t)frames * sizeof *travel->straight);
	if (!travel->straight || !travel->x || !travel->time || !travel->place || !travel->start_speed || !travel->acceleration || !travel->frame) {
		rs_travel_free(travel);
		return NULL;
	}
	for (int k = 0; k < frames; k++)
		travel->straight[k] = (rs_straight){INFINITY, INFINITY};
	for (int k = 0; k < frames; k++)
		travel->frame[k].attitude[0] = travel->frame[k].attitude[4] = travel->frame[k].attitude[8] = 1.0;
	return travel;
}

void rs_travel_free(rs_travel *travel)
{
	if (!travel)
		return;
	free(travel->x);
	free(travel->frame);
	free(travel->straight);
	free(travel->time);
	free(travel->place);
	free(travel->start_speed);
	free(travel->acceleration);
	free(travel->body);
	free(travel->pair);
	free(travel->wheelset);
	free(travel->w);
	free(travel->rail);
	free(travel->rail_start);
	free(travel->rail_end);
	free(travel);
}

/* Where an input of an instance is; others of the lane follow rs_kernel_lanes() apart. */
static double *input_of(const rs_model *model, int kernel, int instance, int slot)
{
	int lanes = rs_kernel_lanes(), inputs = rs_kernel_describe(kernel)->inputs;
	return model->groups[kernel].in + (size_t)(instance / lanes) * (size_t)(inputs * lanes) + slot * lanes + instance % lanes;
}

int rs_travel_bodies(rs_travel *travel, rs_model *model, int kernel, const int *frame)
{
	const rs_kernel_info *info = rs_kernel_describe(kernel);
	int slot = info ? rs_kernel_slot(info, "V") : -1;
	if (slot < 0)
		return RS_BAD_INDEX;
	int count = model->groups[kernel].count;
	rs_moved_body *body = realloc(travel->body, (size_t)(travel->bodies + count + 1) * sizeof *body);
	if (!body)
		return RS_NO_MEMORY;
	travel->body = body;
	travel->written[0] = NAN;
	for (int k = 0; k < count; k++) {
		if (frame[k] < 0 || frame[k] >= travel->frames)
			return RS_BAD_INDEX;
		int inputs = rs_kernel_slot(info, "dV") >= 0 ? 11 : 4;
		body[travel->bodies++] = (rs_moved_body){frame[k], inputs, input_of(model, kernel, k, slot)};
	}
	return RS_OK;
}

int rs_travel_pairs(rs_travel *travel, rs_model *model, int kernel, int count, const int *instance, const int *frames,
                    const double *offsets)
{
	const rs_kernel_info *info = rs_kernel_describe(kernel);
	int slot = info ? rs_kernel_slot(info, "D0") : -1;
	if (slot < 0)
		return RS_BAD_INDEX;
	rs_moved_pair *pair = realloc(travel->pair, (size_t)(travel->pairs + count + 1) * sizeof *pair);
	if (!pair)
		return RS_NO_MEMORY;
	travel->pair = pair;
	for (int k = 0; k < count; k++) {
		int first = frames[2 * k], second = frames[2 * k + 1];
		if (first < 0 || second < 0 || first >= travel->frames || second >= travel->frames || instance[k] < 0
		    || instance[k] >= model->groups[kernel].count)
			return RS_BAD_INDEX;
		rs_moved_pair *own = pair + travel->pairs++;
		travel->still = 0;
		*own = (rs_moved_pair){.first = first, .second = second, .to = input_of(model, kernel, instance[k], slot)};
		memcpy(own->offset1, offsets + 6 * k, sizeof own->offset1);
		memcpy(own->offset2, offsets + 6 * k + 3, sizeof own->offset2);
	}
	return RS_OK;
}

int rs_travel_wheelsets(rs_travel *travel, int count, const int *frame)
{
	for (int k = 0; k < count; k++)
		if (frame[k] < 0 || frame[k] >= travel->frames)
			return RS_BAD_INDEX;
	travel->wheelset = malloc((size_t)(count + 1) * sizeof(int));
	travel->w = calloc(3 * (size_t)count + 1, sizeof(double));
	double **rails[3] = {&travel->rail, &travel->rail_start, &travel->rail_end};
	for (int k = 0; k < 3; k++)
		if (!(*rails[k] = calloc(RS_TRACK_RAILS * (size_t)count + 1, sizeof(double))))
			return RS_NO_MEMORY;
	if (!travel->wheelset || !travel->w)
		return RS_NO_MEMORY;
	memcpy(travel->wheelset, frame, (size_t)count * sizeof(int));
	travel->wheelsets = count;
	return RS_OK;
}

void rs_travel_steady(rs_travel *travel, int steady)
{
	travel->steady = steady;
	travel->written[0] = NAN;
}

double rs_travel_place(const rs_travel *travel, double time, double *V, double *dV)
{
	int piece = 0;
	while (piece + 1 < travel->pieces && time >= travel->time[piece + 1])
		piece++;
	double t = time - travel->time[piece];
	*dV = travel->acceleration[piece];
	*V = travel->start_speed[piece] + *dV * t;
	return travel->place[piece] + t * (travel->start_speed[piece] + 0.5 * *dV * t);
}

static void set_body(const rs_travel *travel, const rs_moved_body *body)
{
	const rs_track_frame *frame = travel->frame + body->frame;
	int lanes = rs_kernel_lanes();
	double V = travel->V, dV = travel->dV, *to = body->to, squared = travel->steady ? 0.0 : V * V;
	to[0] = V;
	for (int k = 0; k < 3; k++)
		to[(1 + k) * lanes] = V * frame->turning[k];
	if (body->inputs == 4)
		return;
	to[4 * lanes] = dV;
	for (int k = 0; k < 3; k++) {
		to[(5 + k) * lanes] = dV * frame->turning[k] + squared * frame->turning_rate[k];
		to[(8 + k) * lanes] = travel->gravity * frame->attitude[6 + k];
	}
}

/* Two frames on one straight: their pose depends neither on place nor on speed. */
static int on_a_straight(const rs_travel *travel, int first, int second)
{
	return travel->straight[first].from == travel->straight[second].from && travel->straight[first].from < INFINITY;
}

static void set_pair(const rs_travel *travel, rs_moved_pair *pair)
{
	rs_track_pose pose;
	int lanes = rs_kernel_lanes(), still = on_a_straight(travel, pair->first, pair->second);
	if (still && pair->still)
		return;
	pair->still = still;
	rs_track_pose_of(travel->frame + pair->first, travel->frame + pair->second, travel->V, pair->offset1, pair->offset2, &pose);
	for (int k = 0; k < 3; k++) {
		pair->to[k * lanes] = pose.D[k];
		pair->to[(12 + k) * lanes] = pose.dD[k];
		pair->to[(15 + k) * lanes] = pose.wf[k];
	}
	for (int k = 0; k < 9; k++)
		pair->to[(3 + k) * lanes] = pose.C[k];
}

/* Rails at all wheelsets, when the vehicle is at s. */
static int rails_at(const rs_travel *travel, double s, double *rail)
{
	int status = RS_OK;
	for (int k = 0; travel->track && k < travel->wheelsets && !status; k++)
		status = rs_track_rails_at(travel->track, s + travel->x[travel->wheelset[k]], rail + RS_TRACK_RAILS * k);
	return status;
}

/* Frames at s; where all are on the straight that all were on before, they stay as they are but for their places, which only poses
 * of pairs would need. */
static int set_frames(rs_travel *travel, double s)
{
	int status = RS_OK, moves = 0;
	for (int k = 0; k < travel->frames; k++) {
		double at = s + travel->x[k];
		moves |= !(at >= travel->straight[k].from && at < travel->straight[k].to) || !on_a_straight(travel, 0, k);
	}
	if (moves)
		travel->written[0] = NAN; /* also where a frame further on is off the track */
	for (int k = 0; moves && k < travel->frames && !status; k++) {
		double at = s + travel->x[k];
		status = rs_track_frame_at(travel->track, at, travel->frame + k);
		if (!status)
			rs_track_straight_at(travel->track, at, &travel->straight[k].from, &travel->straight[k].to);
	}
	travel->still &= !moves;
	return status;
}

/* All but the rails. */
static int set_motion(rs_travel *travel, double s)
{
	int status = travel->track ? set_frames(travel, s) : RS_OK;
	if (status)
		return status;
	for (int k = 0; k < travel->wheelsets; k++)
		for (int i = 0; i < 3; i++)
			travel->w[3 * k + i] = travel->V * travel->frame[travel->wheelset[k]].turning[i];
	if (travel->V != travel->written[0] || travel->dV != travel->written[1])
		for (int k = 0; k < travel->bodies; k++)
			set_body(travel, travel->body + k);
	travel->written[0] = travel->V;
	travel->written[1] = travel->dV;
	for (int k = 0; travel->track && !travel->still && k < travel->pairs; k++)
		set_pair(travel, travel->pair + k);
	travel->still = 1;
	return RS_OK;
}

int rs_travel_set(rs_travel *travel, double time)
{
	double s = rs_travel_place(travel, time, &travel->V, &travel->dV);
	int status = set_motion(travel, s);
	return status ? status : rails_at(travel, s, travel->rail);
}

void rs_travel_begin(rs_travel *travel)
{
	if (travel->wheelsets)
		memcpy(travel->rail_start, travel->rail, RS_TRACK_RAILS * (size_t)travel->wheelsets * sizeof *travel->rail);
}

int rs_travel_within(rs_travel *travel, double time, double end, double share)
{
	double V, dV;
	int status = rails_at(travel, rs_travel_place(travel, end, &V, &dV), travel->rail_end);
	if (status)
		return status;
	for (int k = 0; k < RS_TRACK_RAILS * travel->wheelsets; k++)
		travel->rail[k] = travel->rail_start[k] + share * (travel->rail_end[k] - travel->rail_start[k]);
	return set_motion(travel, rs_travel_place(travel, time, &travel->V, &travel->dV));
}

void rs_travel_next(rs_travel *travel)
{
	double *start = travel->rail_start;
	travel->rail_start = travel->rail_end;
	travel->rail_end = start;
}
