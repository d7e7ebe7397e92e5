/* SPDX-License-Identifier: BSD-3-Clause */
/* A track from its arrays, and what it says of itself. */
#include "store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void *copied(const void *from, size_t count, size_t size)
{
	void *made = malloc((count ? count : 1) * size);
	if (made && count)
		memcpy(made, from, count * size);
	return made;
}

static int highest_power(const double *c, int powers)
{
	int k = powers - 1;
	while (k > 0 && c[k] == 0.0)
		k--;
	return k;
}

static rs_track_degree degree_of(const rs_track_piece *piece)
{
	rs_track_degree degree = {highest_power(piece->curvature, RS_TRACK_POWERS), highest_power(piece->cant, RS_TRACK_POWERS),
	                          highest_power(piece->slope, RS_TRACK_POWERS), 1};
	for (int k = 0; k < 3; k++) {
		int highest = highest_power(piece->place[k], RS_TRACK_PLACE_POWERS);
		degree.place = highest > degree.place ? highest : degree.place;
	}
	return degree;
}

/* Where to begin the search for s: as many equal stretches as there are pieces. */
static void fill_guide(rs_track *track)
{
	double length = track->joint[track->pieces] - track->joint[0];
	track->guide_scale = track->pieces / length;
	for (int k = 0, at = 0; k < track->pieces; k++) {
		while (at + 1 < track->pieces && track->joint[at + 1] <= track->joint[0] + k / track->guide_scale)
			at++;
		track->guide[k] = at;
	}
}

rs_track *rs_track_create(int pieces, const double *joint, const rs_track_piece *piece, int kinks, const double *kink,
                          int jumps, const double *jump)
{
	rs_track *track = pieces > 0 ? calloc(1, sizeof *track) : NULL;
	if (!track)
		return NULL;
	size_t n = (size_t)pieces;
	*track = (rs_track){.pieces = pieces, .kinks = kinks, .jumps = jumps};
	track->joint = copied(joint, n + 1, sizeof *joint);
	track->piece = copied(piece, n, sizeof *piece);
	track->kink = copied(kink, (size_t)kinks, sizeof *kink);
	track->jump = copied(jump, (size_t)jumps, sizeof *jump);
	track->degree = malloc(n * sizeof *track->degree);
	track->guide = malloc(n * sizeof *track->guide);
	if (!track->joint || !track->piece || !track->kink || !track->jump || !track->degree || !track->guide) {
		rs_track_free(track);
		return NULL;
	}
	for (int k = 0; k < pieces; k++)
		track->degree[k] = degree_of(piece + k);
	fill_guide(track);
	return track;
}

int rs_track_add_rails(rs_track *track, double start, double step, int count, const double *coefficients,
                       const double *after)
{
	if (count < 2 || !(step > 0.0))
		return RS_BAD_SIZE;
	rs_track_layer *grown = realloc(track->layer, ((size_t)track->layers + 1) * sizeof *grown);
	if (!grown)
		return RS_NO_MEMORY;
	track->layer = grown;
	rs_track_layer *layer = grown + track->layers;
	*layer = (rs_track_layer){.start = start, .per_step = 1.0 / step, .count = count};
	memcpy(layer->after, after, sizeof layer->after);
	layer->coefficients = copied(coefficients, 4 * ((size_t)count + 2), sizeof *coefficients);
	if (!layer->coefficients)
		return RS_NO_MEMORY;
	track->layers++;
	return RS_OK;
}

void rs_track_free(rs_track *track)
{
	if (!track)
		return;
	for (int k = 0; k < track->layers; k++)
		free(track->layer[k].coefficients);
	free(track->layer);
	free(track->joint);
	free(track->piece);
	free(track->degree);
	free(track->guide);
	free(track->kink);
	free(track->jump);
	free(track);
}

int rs_track_check(const rs_track *track, double s)
{
	if (!isfinite(s))
		return RS_NOT_FINITE;
	return s >= track->joint[0] && s <= track->joint[track->pieces] ? RS_OK : RS_OUT_OF_TRACK;
}

void rs_track_limits(const rs_track *track, double *start, double *end)
{
	*start = track->joint[0];
	*end = track->joint[track->pieces];
}

int rs_track_kinks(const rs_track *track, const double **kinks)
{
	*kinks = track->kink;
	return track->kinks;
}

int rs_track_jumps(const rs_track *track, const double **jumps)
{
	*jumps = track->jump;
	return track->jumps;
}

double rs_track_next_kink(const rs_track *track, double s)
{
	int low = 0, high = track->kinks;   /* kinks below low are <= s, from high on they are > s */
	while (low < high) {
		int middle = low + (high - low) / 2;
		if (track->kink[middle] > s)
			high = middle;
		else
			low = middle + 1;
	}
	return low < track->kinks ? track->kink[low] : INFINITY;
}
