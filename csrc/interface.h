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
enum { RS_ZONES = 3, RS_PLACE_SIZE = 4 };

typedef struct rs_contact_table rs_contact_table;

typedef struct {
	int pieces;                  /* of the spline, a unit of each axis of the half ball */
	int ratio_pieces;            /* over log(a/b) */
	double least, largest;       /* a/b */
	const double *coefficients;  /* pieces + 2, 2 pieces + 2, ratio_pieces + 2, pieces + 2, 3, one more: creep/exact_table.c */
} rs_creep_table;

int rs_creep_forces_exact(const rs_creep_table *table, int contacts, const double *in, double *force, double *slopes);
