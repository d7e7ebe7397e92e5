/* SPDX-License-Identifier: BSD-3-Clause */
/* What the contact needs of a wheel's motion, its work memory, and the parts of the force computation.
 *
 * motion.c    wheelset and rails -> place and motion of eight wheels
 * tangents.c  their tangents, wheelset by wheelset
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

/* Eight wheels. */
typedef struct {
	rs_motion_lanes at;
	rs_lane side;                       /* -1 left, +1 right */
	rs_lane forward[3];                 /* level forward of the axle */
	rs_lane e1[3], e2[3], e3[3];        /* rail axes along, across and down, track frame */
	rs_lane D[3];                       /* from the rail's head to the wheelset's centre */
	rs_lane turn_rate;                  /* of the rail about e1, rad/s */
	rs_lane length;                     /* |axle x e3|, the cosine of the roll against the rail */
	rs_lane place[RS_PLACE_SIZE];
} rs_wheels;

typedef struct {
	double place[RS_PLACE_SIZE];
	double side, e2[3], e3[3];  /* with at: of tangents only */
	rs_motion at;
	double place_to[RS_COLUMNS][RS_PLACE_SIZE];
	rs_motion to[RS_COLUMNS];
	int count;               /* patches that carry load */
	rs_patch patch[RS_ZONES];
	double log_ratio[RS_ZONES];  /* ln(a/b) */
	double force[3], moment[3];  /* on the wheelset, about its centre */
	double force_to[RS_COLUMNS][3], moment_to[RS_COLUMNS][3];
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
	int wheel[RS_LANES], patch[RS_LANES];  /* numbers */
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

/* What outputs are made of. */
typedef struct {
	rs_batch batch;
	rs_lane load, creepage[3], creep[3], place[6];
} rs_found;

struct rs_wheel_rail {
	int wheelsets, batches;
	rs_wheels *wheels;       /* eights of wheels */
	rs_found *found;         /* batches */
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

/* Places and motions of eight wheels from number first on; q u of all coordinates, w 3 and rail 8 (or NULL) a wheelset. */
void rs_wheel_motion(const rs_wheel_rail *wr, const double *q, const double *u, double V, const double *w, const double *rail, int first,
                     rs_wheels *wheels);

/* Tangents of a wheelset whose left wheel has a number, with its forward and axle; u w are those of the wheelset. */
void rs_axle_tangents(const rs_wheels *eights, int number, const double *u, const double *w, const double *seed, rs_axle_state *axle);

/* Adds forces, moments and, with tangents, theirs to the wheel of each patch of the batch. */
void rs_patch_forces(const rs_wheel_rail *wr, double V, int tangents, const rs_batch *batch, rs_found *found);

/* Creep forces of eight patches. */
void rs_adhesion_forces(const rs_wheel_rail *wr, int slopes, const rs_adhesion_input *in, rs_adhesion *out);

/* Kalker's coefficients (4) and, unless NULL, their slopes over ln(a/b); 0 outside their range. */
int rs_kalker_covers(const rs_creep_settings *creep, double log_ratio);
void rs_kalker_at(const rs_creep_settings *creep, double log_ratio, double *c, double *slope);

#endif
