/* SPDX-License-Identifier: BSD-3-Clause */
/* Motion of the track frames along the track, and what of it the kernels' inputs take.
 *
 * rs_travel_create      speed over time in pieces of constant acceleration, on a track or (NULL) on straight level track
 *   Given     x         frames, m: places of the frames ahead of the vehicle's centre; each frame is at s(t) + x
 *             time      pieces, s, increasing; the first and the last piece reach on without end
 *             place speed acceleration   pieces: s (m), V (m/s) and dV (m/s^2) at the start of each
 *             gravity   m/s^2
 *   Returned  the motion, or NULL (no memory, nothing given); the track is kept, not copied
 * rs_travel_bodies      frames of all instances of a kernel: its inputs V, w and (bodies) dV, dw, grav are kept up to date
 *   Given     frame     one an instance
 * rs_travel_pairs       elements that join two frames: their inputs D, C, dD, wf are kept up to date
 *   Given     instance  count, numbers of the kernel's instances
 *             frames    2 count, of the first and the second end
 *             offsets   6 count, m, design place of each end's body in its frame
 * rs_travel_wheelsets   frames at which the wheel-rail forces want the lie of the rails
 *   Status    RS_OK, RS_NO_MEMORY, RS_BAD_INDEX
 * rs_travel_steady      1: every place is taken as if it went on for ever, without angular acceleration of the frames
 */
#ifndef RS_TRAVEL_H
#define RS_TRAVEL_H

#include "model.h"
#include "track.h"

typedef struct {
	int frame, inputs;
	double *to;               /* first input of a lane */
} rs_moved_body;

typedef struct {
	int first, second;
	double offset1[3], offset2[3];
	int still;                /* 1: as the inputs were last written, both frames lay straight and level with each other */
	double *to;
} rs_moved_pair;

/* s on a straight piece of the track, from <= s < to: there only the place of a frame changes. */
typedef struct {
	double from, to;
} rs_straight;

struct rs_travel {
	const rs_track *track;
	int frames, pieces, bodies, pairs, wheelsets;
	double *x;                /* frames */
	rs_track_frame *frame;    /* frames */
	rs_straight *straight;    /* frames, where each was found last */
	double *time, *place, *start_speed, *acceleration;  /* pieces */
	double gravity;
	int steady;
	int still;                /* 1: no pair has moved since it was written */
	double V, dV;             /* at the time last asked for */
	double written[2];        /* V and dV in the inputs of bodies; NAN: they are to be written */
	rs_moved_body *body;
	rs_moved_pair *pair;
	int *wheelset;            /* frames of the wheelsets */
	double *w, *rail;         /* 3 and RS_TRACK_RAILS a wheelset */
	double *rail_start, *rail_end;  /* rails at both ends of a step */
};

/* Place (m) of the vehicle's centre at a time, speed and its rate. */
double rs_travel_place(const rs_travel *travel, double time, double *V, double *dV);

/* Everything at a time; status of the track. */
int rs_travel_set(rs_travel *travel, double time);

/* The rails of the time last set are those at the start of the next step. */
void rs_travel_begin(rs_travel *travel);

/* Everything at a time within a step but the rails, which go straight from its start to its end: share of the way. A scheme that
 * takes places in between from straight lines puts the wheels that far off a rail that bends, and a micrometre is a kilonewton. */
int rs_travel_within(rs_travel *travel, double time, double end, double share);

/* The next step starts where this one ends. */
void rs_travel_next(rs_travel *travel);

#endif
