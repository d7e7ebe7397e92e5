/* SPDX-License-Identifier: BSD-3-Clause */
/* Deviation of the rails: f(s) = sum over layers of sum_j c_j B((s - start)/step - j), B the cubic B-spline. */
#include "store.h"

/* Weights of the four splines that meet at 0 <= t < 1, and their derivatives by t. */
static void weights(double t, double *b, double *db)
{
	double r = 1.0 - t;
	b[0] = r * r * r / 6.0;
	b[1] = (4.0 - 3.0 * t * t * (1.0 + r)) / 6.0;
	b[2] = (4.0 - 3.0 * r * r * (1.0 + t)) / 6.0;
	b[3] = t * t * t / 6.0;
	db[0] = -0.5 * r * r;
	db[1] = t * (1.5 * t - 2.0);
	db[2] = r * (2.0 - 1.5 * r);
	db[3] = 0.5 * t * t;
}

static void add_layer(const rs_track_layer *layer, double s, double *rails)
{
	double t = (s - layer->start) * layer->per_step, b[4], db[4];
	if (t < 0.0)
		return;
	if (t >= layer->count - 1) {
		for (int i = 0; i < 4; i++)
			rails[i] += layer->after[i];
		return;
	}
	int node = (int)t;
	weights(t - node, b, db);
	const double *c = layer->coefficients + 4 * (long)node;
	for (int i = 0; i < 4; i++) {
		rails[i] += b[0] * c[i] + b[1] * c[i + 4] + b[2] * c[i + 8] + b[3] * c[i + 12];
		rails[i + 4] += layer->per_step * (db[0] * c[i] + db[1] * c[i + 4] + db[2] * c[i + 8] + db[3] * c[i + 12]);
	}
}

int rs_track_rails_at(const rs_track *track, double s, double *rails)
{
	int status = rs_track_check(track, s);
	if (status != RS_OK)
		return status;
	for (int i = 0; i < RS_TRACK_RAILS; i++)
		rails[i] = 0.0;
	for (int k = 0; k < track->layers; k++)
		add_layer(track->layer + k, s, rails);
	return RS_OK;
}

int rs_track_rails(const rs_track *track, int n, const double *s, double *rails, int *failed)
{
	int status = RS_OK, k = 0;
	while (k < n && (status = rs_track_rails_at(track, s[k], rails + RS_TRACK_RAILS * (long)k)) == RS_OK)
		k++;
	*failed = k;
	return status;
}
