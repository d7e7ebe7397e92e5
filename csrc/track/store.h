/* SPDX-License-Identifier: BSD-3-Clause */
/* The track's memory: create.c fills it, the others read it. */
#ifndef RS_TRACK_STORE_H
#define RS_TRACK_STORE_H

#include "../track.h"

typedef struct {
	int curvature, cant, slope, place;   /* highest power that is not zero */
} rs_track_degree;

typedef struct {
	double start, per_step;   /* m, 1/m */
	int count;                /* nodes */
	double *coefficients;     /* (count + 2) x 4 */
	double after[4];          /* m */
} rs_track_layer;

struct rs_track {
	int pieces;
	double *joint;              /* pieces + 1, m */
	rs_track_piece *piece;      /* pieces */
	rs_track_degree *degree;    /* pieces */
	int *guide;                 /* pieces: the piece at joint[0] + k/guide_scale */
	double guide_scale;         /* 1/m */
	int kinks, jumps;
	double *kink, *jump;        /* kinks, jumps, m */
	int layers;
	rs_track_layer *layer;      /* layers */
};

/* RS_OK if the track has a frame at s. */
int rs_track_check(const rs_track *track, double s);

#endif
