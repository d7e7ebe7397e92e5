/* SPDX-License-Identifier: BSD-3-Clause */
/* What the contact needs of a wheel's motion, its work memory, and the parts of the force computation.
 *
 * motion.c    wheelset and rails -> place and motion of each wheel, and their tangents
 * patches.c   patches in lanes of eight -> forces and moments on the wheelset, and their tangents
 * adhesion.c  creepages, load and ellipse of eight patches -> creep forces and slopes, by any creep law
 * cones.c     a contact in closed form that takes the place of a table
 *
 * A tangent of column j is the change for (dq_j, du_j) = (cq, cu): six columns a wheelset.
 */
#ifndef RS_MOTION_H
#define RS_MOTION_H

#include "../creep.h"
#include "../wheel_rail.h"

enum { RS_COLUMNS = 6, RS_PATCH_ROWS = 7 };

/* Vectors in the track frame; values and tangents have the same fields. */
#define RS_MOTION_FIELDS(T) \
	{ \
		T v[3];     /* velocity of the wheelset's centre against the rail, which rests */ \
		T omega[3]; /* angular velocity likewise */ \
		T close[3]; /* rate of the centre's place against the rail's head */ \
		T turn[3];  /* rate of the axle's attitude against the rail's head: no spin, no turning of the track frame */ \
		T f[3], a[3], d[3]; /* wheel axes: forward in the rail's plane, along the axle to the right, down */ \
	}
typedef struct RS_MOTION_FIELDS(double) rs_motion;
typedef struct RS_MOTION_FIELDS(rs_lane) rs_motion_lanes;
enum { RS_MOTION_SIZE = sizeof(rs_motion) / sizeof(double) };
_Static_assert(sizeof(rs_motion_lanes) == RS_MOTION_SIZE * sizeof(rs_lane), "the same fields");

typedef struct {
	double side;             /* -1 left, +1 right */
	double e2[3], e3[3];     /* rail axes across and down, track frame */
	double place[RS_PLACE_SIZE];
	rs_motion at;
	double place_to[RS_COLUMNS][RS_PLACE_SIZE];
	rs_motion to[RS_COLUMNS];
	int count;               /* patches that carry load */
	rs_patch patch[RS_ZONES];
	double log_ratio[RS_ZONES];  /* ln(a/b) */
	double force[3], moment[3];  /* on the wheelset, about its centre */
	double force_to[RS_COLUMNS][3], moment_to[RS_COLUMNS][3];
	double tgamma;
	double found[RS_ZONES][RS_PATCH_OUTPUTS];  /* in the order of patch */
} rs_wheel_state;

/* The axle's own part: level forward and axle direction, what its rows are taken about. */
typedef struct {
	double forward[3], axle[3];
	double forward_to[RS_COLUMNS][3], axle_to[RS_COLUMNS][3];
	rs_wheel_state wheel[2];
} rs_axle_state;

/* Patches of eight at most. */
typedef struct {
	int count;
	rs_wheel_state *wheel[RS_LANES];
	const rs_wheel *given[RS_LANES];
	int patch[RS_LANES];
} rs_batch;

/* Inputs of the creep forces, and what comes out: forces, and slopes over xi eta phi load ln(a b) ln(a/b). */
typedef struct {
	rs_lane creepage[3], load, friction, weight, a, b;
	rs_lane c[4], c_to[4];  /* Kalker's coefficients, and their slopes over ln(a/b) */
} rs_adhesion_input;

enum { RS_ADHESION_SLOPES = 6 };
typedef struct {
	rs_lane force[3];  /* Fx Fy Mz */
	rs_lane slope[3][RS_ADHESION_SLOPES];
} rs_adhesion;

struct rs_wheel_rail {
	int wheelsets;
	rs_wheelset *wheelset;
	rs_creep_settings creep;
	rs_creep_law *law;
	rs_axle_state *axle;
	double *coefficients;
	int failed_wheel, failed_variable;
	double failed_value;
};

typedef int rs_lookup(const rs_contact_table *shape, const double *place, rs_patch *patch, int *count, int *beyond);

int rs_contact_cones_lookup(const rs_contact_table *shape, const double *place, rs_patch *patch, int *count, int *beyond);

/* Places and motions of both wheels of one wheelset; seed NULL: no tangents. rail 8 numbers, q u w those of the wheelset. */
void rs_axle_motion(const rs_wheelset *set, const double *q, const double *u, double V, const double *w,
                    const double *rail, const double *seed, rs_axle_state *axle);

/* Adds forces, moments and, with tangents, theirs to the wheel of each patch of the batch. */
void rs_patch_forces(const rs_wheel_rail *wr, double V, int tangents, const rs_batch *batch);

/* Creep forces of eight patches. */
void rs_adhesion_forces(const rs_wheel_rail *wr, int slopes, const rs_adhesion_input *in, rs_adhesion *out);

/* Kalker's coefficients (4) and their slopes over ln(a/b); 0 outside their range. */
int rs_kalker_covers(const rs_creep_settings *creep, double log_ratio);
void rs_kalker_at(const rs_creep_settings *creep, double log_ratio, double *c, double *slope);

#endif
