/* SPDX-License-Identifier: BSD-3-Clause */
/* Declarations that cffi reads (no preprocessor here); railsym.h includes this file and
 * holds the contracts. */

enum {
	RS_OK = 0,
	RS_NO_MEMORY = 1,
	RS_BAD_INDEX = 2,
	RS_BAD_SIZE = 3,
	RS_NOT_FINITE = 4,
	RS_NOT_CONVERGED = 5
};

enum {
	RS_LAW_NONE = 0,
	RS_LAW_SPRING_DAMPER = 1,
	RS_LAW_MAXWELL = 2,
	RS_LAW_BUMP_STOP = 3,
	RS_LAW_ACTUATOR_FORCE = 4,
	RS_LAW_ACTUATOR_LENGTH = 5
};

enum {
	RS_FAULT_NONE = 0,
	RS_FAULT_STUCK = 1,   /* holds the demand that it follows: a jack whose valves have closed */
	RS_FAULT_FREE = 2,    /* no force */
	RS_FAULT_DAMPED = 3   /* its bypass damping alone */
};
enum { RS_SEEN_LENGTH = 0, RS_SEEN_RATE = 1, RS_SEEN_FORCE = 2, RS_SEEN = 3 };
enum { RS_FOLLOWED_COMMAND = 3, RS_FOLLOWED_FAULT = 4, RS_SEEN_ROOM = 5 };  /* what rs_integrator_follow met last */

typedef struct {
	int n;               /* points */
	const double *x;     /* n, increasing */
	const double *c;     /* 4 (n - 1): value = c0 + t (c1 + t (c2 + t c3)), t = x - x[piece] */
} rs_curve;

typedef struct {
	int kind;
	double preload;      /* N */
	double stiffness;    /* N/m */
	double damping;      /* N s/m */
	double clearance;    /* m */
	double command;      /* N or m */
	const rs_curve *stiffness_curve;
	const rs_curve *damping_curve;
	double lag;            /* s, time constant with which an actuator follows its command; 0: at once */
	double rate_limit;     /* m/s or N/s, of what it follows, with a lag; 0: none */
	double force_limit;    /* N; 0: none */
	double bypass_damping; /* N s/m, of RS_FAULT_DAMPED */
	int fault;             /* RS_FAULT_... */
	double *seen;          /* RS_SEEN_ROOM: elongation (m), its rate (m/s) and force (N) of the last evaluation; or NULL */
} rs_law;

typedef struct {
	const char *name;
	int inputs;
	int coordinates;
	int entries;
	int has_law;
	const unsigned char *row;        /* entries */
	const unsigned char *column;     /* entries */
	const short *slots;              /* coordinates x 5: q u a sin cos, -1 for none */
	const char *const *input_names;  /* inputs */
	const char *const *input_units;  /* inputs */
} rs_kernel_info;

typedef struct rs_model rs_model;

int rs_kernel_count(void);
const rs_kernel_info *rs_kernel_describe(int kernel);
int rs_kernel_lanes(void);
int rs_kernel_real(int kernel, const double *in, const rs_law *const *laws, const double *seed,
                   double *r, double *S);
int rs_kernel_complex(int kernel, const double *in, const rs_law *law, const double *seed,
                      double *r, double *S);

rs_model *rs_model_create(int coordinates, const unsigned char *is_angle);
void rs_model_free(rs_model *model);
int rs_model_add(rs_model *model, int kernel, int count, const double *in, const int *index,
                 const rs_law *const *laws);
int rs_model_set_input(rs_model *model, int kernel, int slot, const double *values);
int rs_model_residual(rs_model *model, const double *q, const double *u, const double *a, double *r);
int rs_model_pencil(rs_model *model, const double *q, const double *u, const double *a,
                    const double *seed, double *r, double *S);

int rs_bench_run(const rs_law *law, int n, const double *time, const double *e, const double *v, int substeps,
                 double s0, double *f, double *s, int *failed);
int rs_bench_cycles(const rs_law *law, int tests, int n, const double *period, const double *e, const double *v,
                    int substeps, double *f, double *s, int *failed);

enum {
	RS_CREEP_KALKER_LINEAR = 0,
	RS_CREEP_SHEN_HEDRICK_ELKINS = 1,
	RS_CREEP_POLACH = 2,
	RS_CREEP_FASTSIM = 3,
	RS_CREEP_FASTRIP = 4,
	RS_CREEP_EXACT = 5
};
enum { RS_CREEP_INPUTS = 15 };

int rs_creep_forces(int law, int strips, int cells, int contacts, const double *in, double *force,
                    double *slopes);

enum { RS_OUT_OF_TABLE = 6 };
enum { RS_ZONES = 3, RS_PLACE_SIZE = 4, RS_TABLE_SHAPE = 11 };

typedef struct rs_contact_table rs_contact_table;

typedef struct {
	int rail_count;
	double rail_step;              /* m of arc between points */
	const double *rail_y;          /* rail_count, m, as the rail lies */
	const double *rail_z;          /* m, 0 at the top, down */
	const double *rail_cosine;     /* of the rail's slope */
	const double *rail_sine;
	int wheel_count;
	double wheel_start, wheel_step; /* m, along the axle */
	const double *wheel_radius_at; /* wheel_count, m */
	const double *wheel_slope_at;  /* dr/dy */
	double wheel_radius;           /* m, r0 */
	double spacing;                /* m, tape circle from the wheelset's centre */
} rs_surfaces;

typedef struct {
	double load[5];      /* N, elastic normal force, > 0; then its slopes over y, roll, drop, yaw; likewise: */
	double x[5];         /* m, place of the contact ahead of the wheelset's centre, in the wheelset's axes */
	double across[5];    /* m, from the wheelset's centre along the axle, + to the field */
	double radius[5];    /* m, below the axle */
	double angle[5];     /* rad, contact plane to the track plane, positive as at a flange */
	double a[5];         /* m, semi-axis along x */
	double b[5];         /* m, semi-axis across */
	int zone;            /* 0 tread ... */
} rs_patch;

int rs_rigid_contact(const rs_surfaces *from, int n, const double *place, double *contact);
int rs_contact_table_check(const double *shape);
int rs_contact_table_build(const rs_surfaces *from, const double *shape, const double *cuts, const int *parts,
                           double modulus, rs_contact_table **made, int *failures);
int rs_contact_table_of_arrays(const double *shape, const double *axes, const double *const *closure,
                               const double *const *field, int values, rs_contact_table **made);
void rs_contact_table_shape(const rs_contact_table *table, double *shape, double *axes);
void rs_contact_table_arrays(const rs_contact_table *table, int zone, double *closure, double *field);
void rs_contact_table_free(rs_contact_table *table);
int rs_contact_lookup(const rs_contact_table *table, const double *place, rs_patch *patch, int *count, int *beyond);
int rs_contact_lookup_many(const rs_contact_table *table, int n, const double *place, rs_patch *patch, int *count,
                           int *beyond);

enum { RS_OUT_OF_TRACK = 20 };
enum { RS_TRACK_POWERS = 8, RS_TRACK_PLACE_POWERS = 14, RS_TRACK_RAILS = 8 };

typedef struct rs_track rs_track;
typedef struct {
	double place[3];         /* m, origin of the frame, inertial */
	double place_low[3];     /* m, what place lost in rounding: the origin is place + place_low */
	double attitude[9];      /* P by rows: frame to inertial components */
	double turning[3];       /* 1/m, angular velocity per metre of track, frame components */
	double turning_rate[3];  /* 1/m^2, d turning/ds */
} rs_track_frame;
typedef struct {
	double D[3];    /* m, design place of body 2 from that of body 1, frame 1 */
	double C[9];    /* by rows: frame 2 to frame 1 components */
	double dD[3];   /* m/s, rate of D seen in frame 1 */
	double wf[3];   /* rad/s, angular velocity of frame 2 in frame 1, components of frame 2 */
} rs_track_pose;
typedef struct {
	double middle, half;                   /* m, x = (s - middle)/half, -1 <= x <= 1 */
	double curvature[8];                   /* 1/m, powers of x, lowest first */
	double cant[8];                        /* -, sin(cant angle) */
	double slope[8];                       /* -, sin(slope), + uphill */
	double heading[9];                     /* rad */
	double place[3][14];                   /* m, from base, inertial */
	double base[3], base_low[3];           /* m, place at middle */
} rs_track_piece;

int rs_track_frame_at(const rs_track *track, double s, rs_track_frame *frame);
void rs_track_straight_at(const rs_track *track, double s, double *from, double *to);
int rs_track_rails_at(const rs_track *track, double s, double *rails);
void rs_track_pose_of(const rs_track_frame *first, const rs_track_frame *second, double V, const double *offset1,
                      const double *offset2, rs_track_pose *pose);
void rs_track_limits(const rs_track *track, double *start, double *end);
int rs_track_kinks(const rs_track *track, const double **kinks);
int rs_track_jumps(const rs_track *track, const double **jumps);
double rs_track_next_kink(const rs_track *track, double s);

int rs_track_frames(const rs_track *track, int n, const double *s, rs_track_frame *frames, int *failed);
int rs_track_rails(const rs_track *track, int n, const double *s, double *rails, int *failed);
int rs_track_poses(const rs_track *track, int n, const double *s1, const double *s2, const double *V,
                   const double *offset1, const double *offset2, rs_track_pose *poses, int *failed);

rs_track *rs_track_create(int pieces, const double *joint, const rs_track_piece *piece, int kinks, const double *kink,
                          int jumps, const double *jump);
int rs_track_add_rails(rs_track *track, double start, double step, int count, const double *coefficients,
                       const double *after);
void rs_track_free(rs_track *track);

typedef struct {
	int pieces;                  /* of the spline, a unit of each axis of the half ball */
	int ratio_pieces;            /* over log(a/b) */
	double least, largest;       /* a/b */
	const double *coefficients;  /* pieces + 2, 2 pieces + 2, ratio_pieces + 2, pieces + 2, 3, one more: creep/exact_table.c */
} rs_creep_table;

int rs_creep_forces_exact(const rs_creep_table *table, int contacts, const double *in, double *force, double *slopes);

enum { RS_BAD_SPEED = 8 };
enum { RS_CONTACT_TABLE = 0, RS_CONTACT_CONES = 1 };
enum {
	RS_WHEEL_Y = 0,
	RS_WHEEL_Q = 1,
	RS_WHEEL_X = 2,
	RS_WHEEL_TGAMMA = 3,
	RS_WHEEL_PATCHES = 4,
	RS_WHEEL_OUTPUTS = 5
};
enum {
	RS_PATCH_LOAD = 0,
	RS_PATCH_XI = 1,
	RS_PATCH_FX = 4,
	RS_PATCH_X = 7,
	RS_PATCH_ACROSS = 8,
	RS_PATCH_RADIUS = 9,
	RS_PATCH_ANGLE = 10,
	RS_PATCH_A = 11,
	RS_PATCH_B = 12,
	RS_PATCH_OUTPUTS = 13
};

typedef struct {
	int kind;             /* of contact: RS_CONTACT_TABLE, RS_CONTACT_CONES */
	const void *shape;    /* rs_contact_table or rs_contact_cones */
	double r0;            /* m, height of the wheelset's centre over the top of rail where the contact's drop is 0 */
	double sink;          /* m, added to the drop: how far the design position has sunk into the rail */
	double friction;      /* - */
	double weight;        /* -, factor on Kalker's coefficients */
	double damping;       /* s/m, chi: load = elastic load (1 + chi penetration rate), not below zero */
} rs_wheel;

typedef struct {
	int first;            /* coordinate x; y z yaw roll spin follow */
	double offset[3];     /* m, design place of the centre in the track frame; the first is not used in the contact */
	double spacing;       /* m, lateral distance of the rails' heads: their cross level turns both of them */
	rs_wheel wheel[2];    /* left, right */
} rs_wheelset;

typedef struct {
	int law;              /* RS_CREEP_... */
	int strips, cells;    /* grid of FASTSIM, FaStrip */
	double modulus;       /* N/m^2, shear */
	double adhesion, slip; /* Polach's kA, kS */
	int pieces;           /* of the coefficients' cubics over ln(a/b) */
	double start, step;   /* ln(a/b) of the first node, and from node to node */
	const double *c;      /* pieces x 4 x 4: C11, C22, C23, C33 = c0 + t (c1 + t (c2 + t c3)), t = ln(a/b) - node */
	const rs_creep_table *table; /* of RS_CREEP_EXACT, kept, not copied; others need none */
} rs_creep_settings;

typedef struct rs_wheel_rail rs_wheel_rail;

rs_wheel_rail *rs_wheel_rail_create(int wheelsets, const rs_wheelset *wheelset, const rs_creep_settings *creep);
void rs_wheel_rail_free(rs_wheel_rail *wr);
int rs_wheel_rail_rows(rs_wheel_rail *wr, const double *q, const double *u, double V, const double *w,
                       const double *rail, const double *seed, double *rows, double *blocks);
void rs_wheel_rail_failure(const rs_wheel_rail *wr, int *wheel, int *variable, double *value, double *place);
void rs_wheel_rail_outputs(const rs_wheel_rail *wr, double *wheel, double *patch);

typedef struct {
	double slope;          /* -, the radius falls by it towards the field */
	double b0, radius;     /* m, a circle of the cone: from the wheelset's centre along the axle, and its radius */
	double rail_y, rail_z; /* m, centre of the rail's circle: from the track's centre line, below the top of rail */
	double rail_radius;    /* m, > 0 */
	double a, b;           /* m^(1/2), semi-axes over the square root of the penetration */
	double stiffness;      /* N/m^(3/2), load over penetration^(3/2) */
} rs_cone;

typedef struct {
	int cones;             /* 1 ... RS_ZONES, tread first */
	double r0;             /* m, height of the wheelset's centre over the top of rail at drop = 0 */
	double limit[3];       /* largest |y| m, |roll| rad, penetration m; yaw has none */
	rs_cone cone[3];
} rs_contact_cones;

enum { RS_SINGULAR = 30, RS_STOPPED = 31 };
enum {
	RS_CHANNEL_POSITION = 0,
	RS_CHANNEL_RATE = 1,
	RS_CHANNEL_ACCELERATION = 2,
	RS_CHANNEL_ELEMENT = 3,
	RS_CHANNEL_WHEEL = 4,
	RS_CHANNEL_PATCH = 5,
	RS_CHANNEL_LAW = 6
};

typedef struct rs_integrator rs_integrator;
typedef struct rs_travel rs_travel;
typedef struct {
	int kind;        /* RS_CHANNEL_... */
	int number;      /* coordinate; kernel of an element or law; output of a wheel or patch */
	int instance;    /* of the kernel */
	int row;         /* of the instance's residual; RS_SEEN_... of a law that keeps what it sees */
} rs_channel;
typedef struct {
	int status;            /* of the last step */
	int coordinate;        /* that a failed step stuck at, -1: none */
	double time;           /* s, of the state */
	double change;         /* m or rad, what the last iteration of the last step changed most */
	long long steps;       /* done since the start */
	long long residuals;   /* evaluations of the residual alone */
	long long pencils;     /* evaluations with the pencil, each factored */
	long long solves;
	long long wheel_factors;  /* factorisations with new slopes of the wheels alone */
} rs_run_report;
typedef int (*rs_controller)(void *context, double time, const double *q, const double *u, const double *a);

rs_integrator *rs_integrator_create(rs_model *model, int second, int blocks, const int *block, double step,
                                    double rho, double tolerance);
void rs_integrator_free(rs_integrator *integrator);
int rs_integrator_set_step(rs_integrator *integrator, double step);
int rs_integrator_start(rs_integrator *integrator, double time, const double *q, const double *u);
int rs_integrator_hold(rs_integrator *integrator, int count, const int *coordinate, const double *stiffness,
                       const double *damping, const double *mass);
double *rs_integrator_force(rs_integrator *integrator);
int rs_integrator_kinks(rs_integrator *integrator, int count, const double *time);
int rs_integrator_channels(rs_integrator *integrator, int count, const rs_channel *channel);
void rs_integrator_controller(rs_integrator *integrator, rs_controller controller, void *context, int every);
void rs_integrator_watcher(rs_integrator *integrator, rs_controller watcher, void *context);
int rs_integrator_restart(rs_integrator *integrator);
void rs_integrator_follow(rs_integrator *integrator);
int rs_integrator_look(rs_integrator *integrator);
int rs_integrator_inertial(rs_integrator *integrator, int kernel, int instance, const double *arm, double *felt);
int rs_integrator_sample(rs_integrator *integrator, double *row);
int rs_integrator_run(rs_integrator *integrator, int steps, int every, double *samples, int *sampled);
void rs_integrator_state(const rs_integrator *integrator, double *q, double *u, double *a);
const rs_run_report *rs_integrator_report(const rs_integrator *integrator);
int rs_integrator_residual(rs_integrator *integrator, double time, const double *q, const double *u, const double *a, double *r);
int rs_integrator_solve(rs_integrator *integrator, const double *q, const double *u, const double *a,
                        const double *seed, const double *b, double *x);
int rs_integrator_fill(const rs_integrator *integrator, int *operations, int *values);

rs_travel *rs_travel_create(const rs_track *track, int frames, const double *x, int pieces, const double *time,
                            const double *place, const double *speed, const double *acceleration, double gravity);
void rs_travel_free(rs_travel *travel);
int rs_travel_bodies(rs_travel *travel, rs_model *model, int kernel, const int *frame);
int rs_travel_pairs(rs_travel *travel, rs_model *model, int kernel, int count, const int *instance, const int *frames,
                    const double *offsets);
int rs_travel_wheelsets(rs_travel *travel, int count, const int *frame);
void rs_travel_steady(rs_travel *travel, int steady);
void rs_integrator_travel(rs_integrator *integrator, rs_travel *travel);
int rs_integrator_wheels(rs_integrator *integrator, rs_wheel_rail *wheels, int wheelsets, const int *first);
