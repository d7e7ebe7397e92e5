/* SPDX-License-Identifier: BSD-3-Clause */
/* Frame of the track: P = Rz(heading) Ry(slope) Rx(cant angle), o' = P e_x,
 *     turning = vee(P^T P') = heading' b3 + slope' b2 + angle' b1,
 * with b1 = e_x, b2 = Rx^T e_y, b3 = (Ry Rx)^T e_z. With c = sin(angle) and g = sin(slope) as polynomials,
 *     cos = sqrt(1 - c^2),  angle' = c'/cos,  angle'' = (c'' + c angle'^2)/cos,  and likewise for the slope.
 */
#include "store.h"

#include <math.h>

static int piece_at(const rs_track *track, double s)
{
	const double *joint = track->joint;
	int last = track->pieces - 1, k = (int)((s - joint[0]) * track->guide_scale);
	k = track->guide[k < last ? k : last];
	while (k < last && joint[k + 1] <= s)
		k++;
	while (k > 0 && joint[k] > s)   /* the product above may round up */
		k--;
	return k;
}

static double value(const double *c, int degree, double x)
{
	double sum = c[degree];
	for (int k = degree - 1; k >= 0; k--)
		sum = sum * x + c[k];
	return sum;
}

/* Value, first and second derivative by s, x = (s - middle) scale. */
static void jet(const double *c, int degree, double x, double scale, double *out)
{
	double v = c[degree], d = 0.0, h = 0.0;
	for (int k = degree - 1; k >= 0; k--) {
		h = h * x + d;
		d = d * x + v;
		v = v * x + c[k];
	}
	out[0] = v;
	out[1] = d * scale;
	out[2] = 2.0 * h * scale * scale;
}

/* An angle given by its sine: s, c, and the angle's two derivatives. */
typedef struct {
	double sine, cosine, rate, second;
} turn;

static turn turn_of(const double *c, int degree, double x, double scale)
{
	double at[3];
	jet(c, degree, x, scale, at);
	turn found = {.sine = at[0], .cosine = sqrt(1.0 - at[0] * at[0])};
	found.rate = at[1] / found.cosine;
	found.second = (at[2] + found.sine * found.rate * found.rate) / found.cosine;
	return found;
}

static void attitude(double heading, const turn *slope, const turn *cant, double *P)
{
	double sh = sin(heading), ch = cos(heading);
	double st = slope->sine, ct = slope->cosine, sc = cant->sine, cc = cant->cosine;
	P[0] = ch * ct, P[1] = ch * st * sc - sh * cc, P[2] = ch * st * cc + sh * sc;
	P[3] = sh * ct, P[4] = sh * st * sc + ch * cc, P[5] = sh * st * cc - ch * sc;
	P[6] = -st, P[7] = ct * sc, P[8] = ct * cc;
}

static void turnings(const double *curvature, const turn *slope, const turn *cant, rs_track_frame *frame)
{
	double k = curvature[0], dk = curvature[1], a = cant->rate, b = slope->rate;
	double st = slope->sine, ct = slope->cosine, sc = cant->sine, cc = cant->cosine;
	double *w = frame->turning, *dw = frame->turning_rate;
	w[0] = a - k * st;
	w[1] = k * ct * sc + b * cc;
	w[2] = k * ct * cc - b * sc;
	dw[0] = cant->second - dk * st - k * ct * b;
	dw[1] = dk * ct * sc + k * (ct * cc * a - st * sc * b) + slope->second * cc - b * sc * a;
	dw[2] = dk * ct * cc - k * (st * cc * b + ct * sc * a) - slope->second * sc - b * cc * a;
}

int rs_track_frame_at(const rs_track *track, double s, rs_track_frame *frame)
{
	int status = rs_track_check(track, s);
	if (status != RS_OK)
		return status;
	int k = piece_at(track, s);
	const rs_track_piece *piece = track->piece + k;
	rs_track_degree degree = track->degree[k];
	double scale = 1.0 / piece->half, x = (s - piece->middle) * scale, curvature[3];
	jet(piece->curvature, degree.curvature, x, scale, curvature);
	turn cant = turn_of(piece->cant, degree.cant, x, scale), slope = turn_of(piece->slope, degree.slope, x, scale);
	attitude(value(piece->heading, degree.curvature + 1, x), &slope, &cant, frame->attitude);
	turnings(curvature, &slope, &cant, frame);
	for (int i = 0; i < 3; i++) {
		double local = value(piece->place[i], degree.place, x), sum = piece->base[i] + local;
		double back = sum - piece->base[i];   /* exact two-term sum (Knuth) */
		frame->place[i] = sum;
		frame->place_low[i] = piece->base_low[i] + ((piece->base[i] - (sum - back)) + (local - back));
	}
	return RS_OK;
}

void rs_track_straight_at(const rs_track *track, double s, double *from, double *to)
{
	int k = piece_at(track, s);
	rs_track_degree degree = track->degree[k];
	int straight = degree.curvature == 0 && degree.cant == 0 && degree.slope == 0 && track->piece[k].curvature[0] == 0.0;
	*from = straight ? track->joint[k] : INFINITY;
	*to = straight ? track->joint[k + 1] : INFINITY;
}

int rs_track_frames(const rs_track *track, int n, const double *s, rs_track_frame *frames, int *failed)
{
	int status = RS_OK, k = 0;
	while (k < n && (status = rs_track_frame_at(track, s[k], frames + k)) == RS_OK)
		k++;
	*failed = k;
	return status;
}
