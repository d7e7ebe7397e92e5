/* SPDX-License-Identifier: BSD-3-Clause */
/* The tilting controller: sensors to a tilt angle, sample by sample (railsym/tilt/controller.py). tilt.h holds the contracts. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tilt.h"

static double *copied(const double *from, int count)
{
	double *to = malloc((size_t)(count + 1) * sizeof *to);
	if (to && count)
		memcpy(to, from, (size_t)count * sizeof *to);
	return to;
}

rs_tilt_controller *rs_tilt_controller_create(const rs_tilt_constants *constants, int points, const double *place,
                                              const double *curvature, const double *sine)
{
	rs_tilt_controller *c = calloc(1, sizeof *c);
	if (!c)
		return NULL;
	size_t room = (size_t)constants->delay + 1;
	c->k = *constants;
	c->detector.start_time = c->detector.start_place = c->detector.passed_off = NAN;
	c->servo.commands = calloc(room, sizeof(double));
	c->servo.demands = calloc(room, sizeof(double));
	c->places.points = points;
	c->places.table_place = copied(place, points);
	c->places.table_curvature = copied(curvature, points);
	c->places.table_sine = copied(sine, points);
	if (!c->servo.commands || !c->servo.demands || !c->places.table_place || !c->places.table_curvature || !c->places.table_sine) {
		rs_tilt_controller_free(c);
		return NULL;
	}
	return c;
}

void rs_tilt_controller_free(rs_tilt_controller *c)
{
	if (!c)
		return;
	free(c->servo.commands);
	free(c->servo.demands);
	free(c->places.table_place);
	free(c->places.table_curvature);
	free(c->places.table_sine);
	free(c);
}

/* x' = (raw - x)/crossover + V yaw_rate' - g roll_rate, or the low-passed acceleration */
static double estimate(rs_tilt_controller *c, const double *filtered, const double *value)
{
	const rs_tilt_constants *k = &c->k;
	double roll_rate = filtered[0], yaw_rate = filtered[1], turned = yaw_rate - c->yaw_before, speed = value[5];
	c->yaw_before = yaw_rate;
	c->complementary += k->blend * (rs_tilt_mean(c->faults, value[2], value[3]) - c->complementary)
	                    + (speed * turned - k->gravity * k->period * roll_rate);
	if (k->complementary && !(c->faults & RS_TILT_GYRO))
		return c->complementary;
	return rs_tilt_mean(c->faults, filtered[2], filtered[3]);
}

/* m/s^2 that are to be compensated now */
static double source(rs_tilt_controller *c, double own, double deficiency, double place, double speed)
{
	const rs_tilt_constants *k = &c->k;
	if (k->source == RS_TILT_LEADING) {
		rs_tilt_push(&c->places, place + k->ahead, own);
		return rs_tilt_look(&c->places, place + speed * k->lead);
	}
	if (k->source == RS_TILT_BY_TABLE && !(c->faults & RS_TILT_DATABASE)) {
		double here = rs_tilt_table(&c->places, k->gravity, place + k->ahead, speed);
		c->off = fabs(here - deficiency) > k->database_tolerance ? c->off + 1 : 0;
		if (c->off >= k->confirm)
			c->faults |= RS_TILT_DATABASE;
		return rs_tilt_low_pass(k->lateral, c->smooth, rs_tilt_table(&c->places, k->gravity, place + speed * k->lead, speed));
	}
	return own;
}

static void watch_actuator(rs_tilt_controller *c, double error)
{
	int off = fabs(error) > c->k.follow_tolerance && !(c->faults & RS_TILT_ANGLE);
	c->strayed = off ? c->strayed + 1 : 0;
	if (c->strayed >= c->k.follow_confirm)
		c->faults |= RS_TILT_ACTUATOR;
}

static void judge_state(rs_tilt_controller *c)
{
	int both = RS_TILT_A | RS_TILT_B, blind = (c->faults & both) == both || c->faults & RS_TILT_ODOMETER;
	c->state = c->faults & RS_TILT_ACTUATOR ? 3 : blind ? 2 : c->faults ? 1 : 0;
}

static double command_of(rs_tilt_controller *c, double wanted)
{
	const rs_tilt_constants *k = &c->k;
	int off = c->state >= 2;
	double target = off ? 0.0 : rs_tilt_clamp(k->share * atan(wanted / k->gravity), k->limit);
	c->demand += rs_tilt_clamp(target - c->demand, off ? k->return_step : k->demand_step);
	return rs_tilt_servo_command(&c->servo, k, c->demand, !off && !(c->faults & RS_TILT_ANGLE));
}

int rs_tilt_controller_step(void *context, double time, const double *signal, double *command, double *output)
{
	rs_tilt_controller *c = context;
	const rs_tilt_constants *k = &c->k;
	const double *value = c->channels.value, *filter[] = {k->gyro, k->gyro, k->lateral, k->lateral};
	double filtered[4];
	c->faults |= rs_tilt_take(&c->channels, k, signal);
	for (int i = 0; i < 4; i++)
		filtered[i] = rs_tilt_low_pass(filter[i], c->filter[i], value[i]);
	double tilt = value[4], speed = value[5], place = value[6];
	double by_gyro = rs_tilt_by_gyroscope(&c->channels, k, c->faults, filtered[0], filtered[1], speed, c->detector.in_curve);
	c->faults = rs_tilt_judge(&c->channels, k, c->faults, filtered[2], filtered[3], by_gyro);
	double deficiency = estimate(c, filtered, value);
	if (c->faults & RS_TILT_GYRO)
		rs_tilt_detect_by_accelerometer(&c->detector, k, deficiency);
	else
		rs_tilt_detect(&c->detector, k, time, filtered[1], filtered[0], speed, place);
	double wanted = source(c, c->detector.in_curve ? deficiency : 0.0, deficiency, place, speed);
	double error = rs_tilt_compare(&c->servo, k, tilt);
	watch_actuator(c, error);
	judge_state(c);
	*command = command_of(c, wanted);
	const double found[RS_TILT_OUTPUTS] = {*command, c->demand, deficiency, c->detector.in_curve, c->detector.curvature,
	                                       c->detector.start_time, c->detector.start_place, c->servo.expected, error, c->servo.trim,
	                                       c->state, c->faults};
	memcpy(output, found, sizeof found);
	return RS_OK;
}
