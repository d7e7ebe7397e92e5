/* SPDX-License-Identifier: BSD-3-Clause */
/* Frame 2 seen from frame 1: C = P1^T P2, O = P1^T (o2 - o1), w = V turning,
 *     D = O + C c2 - c1,  dD = V (C e_x - e_x) + C (w2 x c2) - w1 x (O + C c2),  wf = w2 - C^T w1.
 */
#include "store.h"

static void cross(const double *a, const double *b, double *out)
{
	out[0] = a[1] * b[2] - a[2] * b[1];
	out[1] = a[2] * b[0] - a[0] * b[2];
	out[2] = a[0] * b[1] - a[1] * b[0];
}

void rs_track_pose_of(const rs_track_frame *first, const rs_track_frame *second, double V, const double *offset1,
                      const double *offset2, rs_track_pose *pose)
{
	const double *P1 = first->attitude, *P2 = second->attitude;
	double *C = pose->C, apart[3], far[3], w1[3], w2[3], swing[3], turned[3];
	for (int i = 0; i < 3; i++) {
		apart[i] = (second->place[i] - first->place[i]) + (second->place_low[i] - first->place_low[i]);
		w1[i] = V * first->turning[i];
		w2[i] = V * second->turning[i];
	}
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++)
			C[3 * i + j] = P1[i] * P2[j] + P1[i + 3] * P2[j + 3] + P1[i + 6] * P2[j + 6];
	cross(w2, offset2, swing);
	for (int i = 0; i < 3; i++) {
		const double *row = C + 3 * i;
		far[i] = P1[i] * apart[0] + P1[i + 3] * apart[1] + P1[i + 6] * apart[2] +
		         (row[0] * offset2[0] + row[1] * offset2[1] + row[2] * offset2[2]);
		pose->D[i] = far[i] - offset1[i];
		pose->dD[i] = V * (row[0] - (i == 0)) + (row[0] * swing[0] + row[1] * swing[1] + row[2] * swing[2]);
		pose->wf[i] = w2[i] - (C[i] * w1[0] + C[i + 3] * w1[1] + C[i + 6] * w1[2]);
	}
	cross(w1, far, turned);
	for (int i = 0; i < 3; i++)
		pose->dD[i] -= turned[i];
}

int rs_track_poses(const rs_track *track, int n, const double *s1, const double *s2, const double *V,
                   const double *offset1, const double *offset2, rs_track_pose *poses, int *failed)
{
	int status = RS_OK;
	for (int k = 0; k < n; k++) {
		rs_track_frame first, second;
		*failed = k;
		if ((status = rs_track_frame_at(track, s1[k], &first)) != RS_OK ||
		    (status = rs_track_frame_at(track, s2[k], &second)) != RS_OK)
			return status;
		rs_track_pose_of(&first, &second, V[k], offset1 + 3 * (long)k, offset2 + 3 * (long)k, poses + k);
	}
	*failed = n;
	return status;
}
