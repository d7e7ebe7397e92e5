/* SPDX-License-Identifier: BSD-3-Clause */
/* Tilting: controller, sensors, and the unit that joins both to an integrator. docs/tilting.md has the law's equations,
 * railsym/tilt the same controller in Python, whose results these are bit for bit.
 *
 * rs_tilt_controller_create   a controller that remembers nothing; NULL without memory
 *   Given     constants   copied; railsym/tilt/constants.py makes them
 *             points      of the track database, 0: none
 *             place       points, m, increasing
 *             curvature   points, 1/m
 *             sine        points, of the cant angle
 * rs_tilt_controller_step     a sample
 *   Given     time      s
 *             signal    RS_TILT_SIGNALS: roll rate, yaw rate (rad/s), two lateral accelerations (m/s^2), tilt (rad), speed (m/s),
 *                       place (m); NAN: missing
 *   Returned  command   rad
 *             output    RS_TILT_OUTPUTS, as OUTPUTS of railsym/tilt/faults.py
 *   Status    RS_OK always: its type is that of a rs_tilt_law, which may answer otherwise to stop a run
 *
 * rs_tilt_motion              roll and yaw rate (rad/s) of a body, and the lateral acceleration (m/s^2) of two points of it against free fall,
 *                             in its axes
 *   Given     q u a     6 each: x y z yaw roll pitch of the body in its track frame, their rates and accelerations
 *             offset    3, m, design position of the body in its track frame
 *             arm       6, m, the two points from it
 *             frame     motion of the track frame, in its axes
 *   Returned  out       4
 *
 * rs_tilt_unit_create         sensors, a law and the commands of actuators on an integrator; NULL without memory or where a place in
 *                             the setup lies outside the model. Everything that the setup points to is kept by the caller.
 * rs_tilt_unit_watch          a watcher of the integrator, with the unit as context: sensors
 * rs_tilt_unit_control        an rs_controller at the unit's samples, for a law in C
 * rs_tilt_unit_read           sensors at the present state, a row of RS_TILT_SIGNALS
 *   Status    RS_OK; of the track; RS_TILT_NO_NOISE: the random numbers are used up
 * rs_tilt_unit_command        the tilt angle (rad) of this sample: the set point of the actuators runs straight to it from the last one
 * rs_tilt_unit_log            rows written since it was asked last: time, signals, outputs; the next rows begin at the first again
 * rs_tilt_unit_noise          random numbers of the next samples, rows of RS_TILT_NOISY
 * rs_tilt_unit_answer         what the law answered to the last sample: status, command
 */
#ifndef RS_TILT_H
#define RS_TILT_H

#include "../railsym.h"

enum { RS_TILT_A = 1, RS_TILT_B = 2, RS_TILT_GYRO = 4, RS_TILT_ANGLE = 8, RS_TILT_ODOMETER = 16, RS_TILT_ACTUATOR = 32, RS_TILT_DATABASE = 64 };
enum { RS_TILT_OWN = 0, RS_TILT_LEADING = 1, RS_TILT_BY_TABLE = 2 };
enum { RS_TILT_ROOM = 1024 };   /* values of the place buffer */

typedef struct {
	double value[RS_TILT_SIGNALS];
	int missing[RS_TILT_SIGNALS], same[RS_TILT_SIGNALS];
	double roll;                /* rad, of the gyroscope's integral */
	int apart, off;
} rs_tilt_channels;

typedef struct {
	int in_curve, quiet;
	double curvature, start_time, start_place, passed_off, before;
} rs_tilt_detector;

typedef struct {
	int points, table_at;
	double *table_place, *table_curvature, *table_sine;
	long long count, at;
	double place[RS_TILT_ROOM], value[RS_TILT_ROOM];
} rs_tilt_places;

typedef struct {
	double expected, rate, error, integral, derivative, trim;
	double *commands, *demands;
	int next;
} rs_tilt_servo;

struct rs_tilt_controller {
	rs_tilt_constants k;
	rs_tilt_channels channels;
	rs_tilt_detector detector;
	rs_tilt_places places;
	rs_tilt_servo servo;
	double filter[4][2], smooth[2];
	int faults, state, off, strayed;
	double complementary, yaw_before, demand;
};

/* b0 b1 b2 a1 a2 and the two numbers that a filter remembers (transposed direct form II). */
static inline double rs_tilt_low_pass(const double *b, double *z, double x)
{
	double y = b[0] * x + z[0];
	z[0] = b[1] * x - b[3] * y + z[1];
	z[1] = b[2] * x - b[4] * y;
	return y;
}

static inline double rs_tilt_clamp(double value, double bound)
{
	return value < -bound ? -bound : value > bound ? bound : value;
}

/* tilt_plausibility.c */
int rs_tilt_take(rs_tilt_channels *channels, const rs_tilt_constants *k, const double *raw);
double rs_tilt_by_gyroscope(rs_tilt_channels *channels, const rs_tilt_constants *k, int faults, double roll_rate, double yaw_rate,
                            double speed, int in_curve);
int rs_tilt_judge(rs_tilt_channels *channels, const rs_tilt_constants *k, int faults, double a, double b, double by_gyro);
double rs_tilt_mean(int faults, double a, double b);

/* tilt_detection.c */
void rs_tilt_detect(rs_tilt_detector *detector, const rs_tilt_constants *k, double time, double yaw_rate, double roll_rate, double speed,
                    double place);
void rs_tilt_detect_by_accelerometer(rs_tilt_detector *detector, const rs_tilt_constants *k, double acceleration);

/* tilt_place.c */
void rs_tilt_push(rs_tilt_places *places, double place, double value);
double rs_tilt_look(rs_tilt_places *places, double place);
double rs_tilt_table(rs_tilt_places *places, double gravity, double place, double speed);

/* tilt_servo.c */
double rs_tilt_compare(rs_tilt_servo *servo, const rs_tilt_constants *k, double tilt);
double rs_tilt_servo_command(rs_tilt_servo *servo, const rs_tilt_constants *k, double demand, int feedback);

#endif
