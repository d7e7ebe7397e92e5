/* SPDX-License-Identifier: BSD-3-Clause */
/* Declarations of tilting that cffi reads, as those of interface.h; tilt.h holds the contracts. */
enum { RS_TILT_SIGNALS = 7, RS_TILT_OUTPUTS = 12, RS_TILT_NOISY = 5, RS_TILT_ROW = 20, RS_TILT_POWERS = 6, RS_TILT_BOLSTERS = 4 };
enum { RS_TILT_BIASED = 0, RS_TILT_MISSING = 1, RS_TILT_FROZEN = 2 };
enum { RS_TILT_NO_NOISE = 64, RS_TILT_BAD_COMMAND = 65 };

typedef struct {
	double period, gravity, share, limit, demand_step, return_step, kp, ki, kd, derivative, trim_limit, tracking;
	double stiffness, damping;       /* of the reference model, times the period */
	double lateral[5], gyro[5];      /* b0 b1 b2 a1 a2 */
	double blend, washout, curve_on, curve_off, roll_on, roll_off, lateral_on, lateral_off, start_delay, extrapolation, slowest;
	double disagreement, gyro_tolerance, database_tolerance, follow_tolerance, ahead, lead;
	int hold, stale, confirm, leave, follow_confirm;   /* samples */
	int delay, complementary, source;
} rs_tilt_constants;
typedef struct rs_tilt_controller rs_tilt_controller;
typedef int (*rs_tilt_law)(void *context, double time, const double *signal, double *command, double *output);

rs_tilt_controller *rs_tilt_controller_create(const rs_tilt_constants *constants, int points, const double *place,
                                              const double *curvature, const double *sine);
void rs_tilt_controller_free(rs_tilt_controller *controller);
int rs_tilt_controller_step(void *controller, double time, const double *signal, double *command, double *output);

typedef struct {
	double low_pass[5];     /* b0 b1 b2 a1 a2 at the integrator's step */
	double bias, scatter, range;
} rs_tilt_sensor;
typedef struct {
	int signal, kind;       /* RS_TILT_BIASED ... */
	double start, end, value;
} rs_tilt_sensor_fault;
typedef struct {
	int bogie;                          /* first coordinate (x) of the body that carries gyroscope and accelerometers */
	double ahead, offset[3], arm[6];    /* m: its track frame; its design position there; the accelerometers from it */
	int car_roll, bolsters, bolster_roll[4];
	double car_ahead, bolster_ahead[4];
	int every;                          /* steps between samples */
	rs_tilt_sensor sensor[5];
	double place_offset, place_scale, start, speed;   /* m, -; m and m/s without travel */
	double gravity, limit;
	int faults;
	const rs_tilt_sensor_fault *fault;
	int actuators;
	rs_law **actuator;
	const double *length;               /* RS_TILT_POWERS an actuator: command = c0 + c1 angle + c2 angle^2 ... */
	rs_tilt_law law;                    /* NULL: the caller reads and commands */
	void *context;
} rs_tilt_setup;
typedef struct {
	double V, dV, w[3], dw[3], gravity[3];   /* m/s, m/s^2, rad/s, rad/s^2, m/s^2, of a track frame */
} rs_tilt_frame;
void rs_tilt_motion(const double *q, const double *u, const double *a, const double *offset, const double *arm, const rs_tilt_frame *frame,
                    double *out);

typedef struct rs_tilt_unit rs_tilt_unit;

rs_tilt_unit *rs_tilt_unit_create(rs_integrator *integrator, const rs_tilt_setup *setup, int rows);
void rs_tilt_unit_free(rs_tilt_unit *unit);
int rs_tilt_unit_watch(void *unit, double time, const double *q, const double *u, const double *a);
int rs_tilt_unit_control(void *unit, double time, const double *q, const double *u, const double *a);
int rs_tilt_unit_read(rs_tilt_unit *unit, double *signal);
void rs_tilt_unit_command(rs_tilt_unit *unit, double angle);
int rs_tilt_unit_log(rs_tilt_unit *unit, double *rows);
void rs_tilt_unit_noise(rs_tilt_unit *unit, int rows, const double *noise);
int rs_tilt_unit_answer(const rs_tilt_unit *unit, double *command);
