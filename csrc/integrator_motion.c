/* SPDX-License-Identifier: BSD-3-Clause */
/* Track frames in motion:
 *
 *     w = V turning,   dw = dV turning + V^2 turning',   gravity in the frame = g (third row of P)
 *
 * and the pose of one frame seen from another for the elements that join two. Only what moves is
 * written: elements within one frame keep the inputs they were made with.
 */
#include <stdlib.h>
#include <string.h>

#include "motion.h"

static double *copied(const double *from, int count)
{
	double *to = malloc((size_t)(count + 1) * sizeof *to);
	if (to)
		memcpy(to, from, (size_t)count * sizeof *to);
	return to;
}

rs_motion *rs_motion_create(const rs_track *track, int frames, const double *x, int pieces, const double *time,
                            const double *place, const double *speed, const double *acceleration, double gravity)
{
	rs_motion *motion = frames > 0 && pieces > 0 ? calloc(1, sizeof *motion) : NULL;
	if (!motion)
		return NULL;
	motion->track = track;
	motion->frames = frames;
	motion->pieces = pieces;
	motion->gravity = gravity;
	motion->x = copied(x, frames);
	motion->time = copied(time, pieces);
	motion->place = copied(place, pieces);
	motion->start_speed = copied(speed, pieces);
	motion->acceleration = copied(acceleration, pieces);
	motion->frame = calloc((size_t)frames, sizeof *motion->frame);
	if (!motion->x || !motion->time || !motion->place || !motion->start_speed || !motion->acceleration || !motion->frame) {
		rs_motion_free(motion);
		return NULL;
	}
	for (int k = 0; k < frames; k++)
		motion->frame[k].attitude[0] = motion->frame[k].attitude[4] = motion->frame[k].attitude[8] = 1.0;
	return motion;
}

void rs_motion_free(rs_motion *motion)
{
	if (!motion)
		return;
	free(motion->x);
	free(motion->frame);
	free(motion->time);
	free(motion->place);
	free(motion->start_speed);
	free(motion->acceleration);
	free(motion->body);
	free(motion->pair);
	free(motion->wheelset);
	free(motion->w);
	free(motion->rail);
	free(motion);
}

static int slot_of(const rs_kernel_info *info, const char *name)
{
	for (int slot = 0; slot < info->inputs; slot++)
		if (!strcmp(info->input_names[slot], name))
			return slot;
	return -1;
}

/* Where an input of an instance is; others of the lane follow rs_kernel_lanes() apart. */
static double *input_of(const rs_model *model, int kernel, int instance, int slot)
{
	int lanes = rs_kernel_lanes(), inputs = rs_kernel_describe(kernel)->inputs;
	return model->groups[kernel].in + (size_t)(instance / lanes) * (size_t)(inputs * lanes) + slot * lanes + instance % lanes;
}

int rs_motion_bodies(rs_motion *motion, rs_model *model, int kernel, const int *frame)
{
	const rs_kernel_info *info = rs_kernel_describe(kernel);
	int slot = info ? slot_of(info, "V") : -1;
	if (slot < 0)
		return RS_BAD_INDEX;
	int count = model->groups[kernel].count;
	rs_moved_body *body = realloc(motion->body, (size_t)(motion->bodies + count + 1) * sizeof *body);
	if (!body)
		return RS_NO_MEMORY;
	motion->body = body;
	for (int k = 0; k < count; k++) {
		if (frame[k] < 0 || frame[k] >= motion->frames)
			return RS_BAD_INDEX;
		int inputs = slot_of(info, "dV") >= 0 ? 11 : 4;
		body[motion->bodies++] = (rs_moved_body){frame[k], inputs, input_of(model, kernel, k, slot)};
	}
	return RS_OK;
}

int rs_motion_pairs(rs_motion *motion, rs_model *model, int kernel, int count, const int *instance, const int *frames,
                    const double *offsets)
{
	const rs_kernel_info *info = rs_kernel_describe(kernel);
	int slot = info ? slot_of(info, "D0") : -1;
	if (slot < 0)
		return RS_BAD_INDEX;
	rs_moved_pair *pair = realloc(motion->pair, (size_t)(motion->pairs + count + 1) * sizeof *pair);
	if (!pair)
		return RS_NO_MEMORY;
	motion->pair = pair;
	for (int k = 0; k < count; k++) {
		int first = frames[2 * k], second = frames[2 * k + 1];
		if (first < 0 || second < 0 || first >= motion->frames || second >= motion->frames || instance[k] < 0
		    || instance[k] >= model->groups[kernel].count)
			return RS_BAD_INDEX;
		rs_moved_pair *own = pair + motion->pairs++;
		*own = (rs_moved_pair){.first = first, .second = second, .to = input_of(model, kernel, instance[k], slot)};
		memcpy(own->offset1, offsets + 6 * k, sizeof own->offset1);
		memcpy(own->offset2, offsets + 6 * k + 3, sizeof own->offset2);
	}
	return RS_OK;
}

int rs_motion_wheelsets(rs_motion *motion, int count, const int *frame)
{
	for (int k = 0; k < count; k++)
		if (frame[k] < 0 || frame[k] >= motion->frames)
			return RS_BAD_INDEX;
	motion->wheelset = malloc((size_t)(count + 1) * sizeof(int));
	motion->w = calloc(3 * (size_t)count + 1, sizeof(double));
	motion->rail = calloc(RS_TRACK_RAILS * (size_t)count + 1, sizeof(double));
	if (!motion->wheelset || !motion->w || !motion->rail)
		return RS_NO_MEMORY;
	memcpy(motion->wheelset, frame, (size_t)count * sizeof(int));
	motion->wheelsets = count;
	return RS_OK;
}

static double travel(rs_motion *motion, double time)
{
	int piece = 0;
	while (piece + 1 < motion->pieces && time >= motion->time[piece + 1])
		piece++;
	double t = time - motion->time[piece], dV = motion->acceleration[piece];
	motion->dV = dV;
	motion->V = motion->start_speed[piece] + dV * t;
	return motion->place[piece] + t * (motion->start_speed[piece] + 0.5 * dV * t);
}

static void set_body(const rs_motion *motion, const rs_moved_body *body)
{
	const rs_track_frame *frame = motion->frame + body->frame;
	int lanes = rs_kernel_lanes();
	double V = motion->V, dV = motion->dV, *to = body->to;
	to[0] = V;
	for (int k = 0; k < 3; k++)
		to[(1 + k) * lanes] = V * frame->turning[k];
	if (body->inputs == 4)
		return;
	to[4 * lanes] = dV;
	for (int k = 0; k < 3; k++) {
		to[(5 + k) * lanes] = dV * frame->turning[k] + V * V * frame->turning_rate[k];
		to[(8 + k) * lanes] = motion->gravity * frame->attitude[6 + k];
	}
}

static void set_pair(const rs_motion *motion, const rs_moved_pair *pair)
{
	rs_track_pose pose;
	int lanes = rs_kernel_lanes();
	rs_track_pose_of(motion->frame + pair->first, motion->frame + pair->second, motion->V, pair->offset1, pair->offset2, &pose);
	for (int k = 0; k < 3; k++) {
		pair->to[k * lanes] = pose.D[k];
		pair->to[(12 + k) * lanes] = pose.dD[k];
		pair->to[(15 + k) * lanes] = pose.wf[k];
	}
	for (int k = 0; k < 9; k++)
		pair->to[(3 + k) * lanes] = pose.C[k];
}

static int set_wheelset(rs_motion *motion, int k, double s)
{
	const rs_track_frame *frame = motion->frame + motion->wheelset[k];
	for (int i = 0; i < 3; i++)
		motion->w[3 * k + i] = motion->V * frame->turning[i];
	return motion->track ? rs_track_rails_at(motion->track, s, motion->rail + RS_TRACK_RAILS * k) : RS_OK;
}

int rs_motion_set(rs_motion *motion, double time)
{
	double s = travel(motion, time);
	int status = RS_OK;
	for (int k = 0; motion->track && k < motion->frames && !status; k++)
		status = rs_track_frame_at(motion->track, s + motion->x[k], motion->frame + k);
	for (int k = 0; k < motion->wheelsets && !status; k++)
		status = set_wheelset(motion, k, s + motion->x[motion->wheelset[k]]);
	if (status)
		return status;
	for (int k = 0; k < motion->bodies; k++)
		set_body(motion, motion->body + k);
	for (int k = 0; motion->track && k < motion->pairs; k++)
		set_pair(motion, motion->pair + k);
	return RS_OK;
}
