/* SPDX-License-Identifier: BSD-3-Clause */
/* Sensors on a vehicle in motion, a law that reads them, and the actuators that it commands; tilt.h holds the contracts.
 *
 * Every step the true values pass the sensors' low-pass filters; every `every` steps a sample is taken of them:
 *     value = limited(filtered + bias + scatter times a random number), or NAN, or the last value.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../integrator.h"
#include "tilt.h"

struct rs_tilt_unit {
	rs_integrator *integrator;
	rs_tilt_setup setup;
	double *q;                    /* 3 n, room for a state */
	long long seen;               /* step that the filters have seen; -1: none */
	double filter[RS_TILT_NOISY][2], filtered[RS_TILT_NOISY], last[RS_TILT_SIGNALS];
	double place, V, twist;
	double from, to;              /* rad, the last two commands */
	const double *noise;
	int noises, next_noise;
	double *log;
	int rows, logged, answer;
	double command;
};

rs_tilt_unit *rs_tilt_unit_create(rs_integrator *integrator, const rs_tilt_setup *setup, int rows)
{
	const rs_tilt_setup *s = setup;
	int second = integrator->second, fine = s->bogie >= 0 && s->bogie + 6 <= second && s->car_roll >= 0 && s->car_roll < second
	                                        && s->bolsters >= 1 && s->bolsters <= RS_TILT_BOLSTERS && s->every >= 1 && rows >= 1;
	for (int k = 0; fine && k < s->bolsters; k++)
		fine = s->bolster_roll[k] >= 0 && s->bolster_roll[k] < second;
	rs_tilt_unit *unit = fine ? calloc(1, sizeof *unit) : NULL;
	if (!unit)
		return NULL;
	unit->integrator = integrator;
	unit->setup = *setup;
	unit->seen = -1;
	unit->rows = rows;
	unit->q = malloc(3 * (size_t)integrator->n * sizeof(double));
	unit->log = malloc((size_t)rows * RS_TILT_ROW * sizeof(double));
	if (!unit->q || !unit->log) {
		rs_tilt_unit_free(unit);
		return NULL;
	}
	return unit;
}

void rs_tilt_unit_free(rs_tilt_unit *unit)
{
	if (!unit)
		return;
	free(unit->q);
	free(unit->log);
	free(unit);
}

/* Track frame a way ahead of the vehicle's centre: its motion, and the angle of the cant. */
static int frame_at(const rs_tilt_unit *unit, double ahead, double dV, rs_tilt_frame *to, double *cant)
{
	const rs_travel *travel = unit->integrator->travel;
	double g = unit->setup.gravity;
	*cant = 0.0;
	if (to)
		*to = (rs_tilt_frame){.V = unit->V, .dV = dV, .gravity = {0.0, 0.0, g}};
	if (!travel || !travel->track)
		return RS_OK;
	rs_track_frame frame;
	int status = rs_track_frame_at(travel->track, unit->place + ahead, &frame);
	if (status)
		return status;
	*cant = atan2(frame.attitude[7], frame.attitude[8]);
	for (int k = 0; to && k < 3; k++) {
		to->w[k] = unit->V * frame.turning[k];
		to->dw[k] = dV * frame.turning[k] + unit->V * unit->V * frame.turning_rate[k];
		to->gravity[k] = g * frame.attitude[6 + k];
	}
	return RS_OK;
}

/* Cant under the body less that under its bolsters, rad: it changes so slowly that it is looked up once a sample. */
static int twist(rs_tilt_unit *unit)
{
	const rs_tilt_setup *s = &unit->setup;
	double cant, below = 0.0;
	int status = RS_OK;
	for (int k = 0; k < s->bolsters && !status; k++) {
		status = frame_at(unit, s->bolster_ahead[k], 0.0, NULL, &cant);
		below += cant / s->bolsters;
	}
	if (!status)
		status = frame_at(unit, s->car_ahead, 0.0, NULL, &cant);
	unit->twist = cant - below;
	return status;
}

/* Gyroscope, accelerometers and tilt as they truly are. */
static int truth(rs_tilt_unit *unit, double time, const double *q, const double *u, const double *a, double *value)
{
	const rs_tilt_setup *s = &unit->setup;
	double dV = 0.0, cant, below = 0.0;
	rs_tilt_frame frame;
	unit->V = s->speed;
	unit->place = unit->integrator->travel ? rs_travel_place(unit->integrator->travel, time, &unit->V, &dV) : s->start + s->speed * time;
	int status = frame_at(unit, s->ahead, dV, &frame, &cant);
	if (status)
		return status;
	rs_tilt_motion(q + s->bogie, u + s->bogie, a + s->bogie, s->offset, s->arm, &frame, value);
	for (int k = 0; k < s->bolsters; k++)
		below += q[s->bolster_roll[k]] / s->bolsters;
	if (unit->integrator->report.steps % s->every == 0)
		status = twist(unit);
	value[4] = q[s->car_roll] - below + unit->twist;
	return status;
}

/* The filters' state in which a constant value stands. */
static void settle(const double *b, double *z, double x)
{
	z[0] = x - b[0] * x;
	z[1] = b[2] * x - b[4] * x;
}

static int sense(rs_tilt_unit *unit, double time, const double *q, const double *u, const double *a)
{
	double value[RS_TILT_NOISY];
	if (unit->seen == unit->integrator->report.steps)
		return RS_OK;
	int status = truth(unit, time, q, u, a, value);
	for (int i = 0; i < RS_TILT_NOISY && !status; i++) {
		const double *b = unit->setup.sensor[i].low_pass;
		if (unit->seen < 0)
			settle(b, unit->filter[i], value[i]);
		unit->filtered[i] = rs_tilt_low_pass(b, unit->filter[i], value[i]);
	}
	unit->seen = unit->integrator->report.steps;
	return status;
}

static void spoil(const rs_tilt_unit *unit, double time, int signal, double *value)
{
	const rs_tilt_setup *s = &unit->setup;
	for (int k = 0; k < s->faults; k++) {
		const rs_tilt_sensor_fault *fault = s->fault + k;
		if (fault->signal != signal || time < fault->start || time >= fault->end)
			continue;
		*value = fault->kind == RS_TILT_MISSING ? NAN : fault->kind == RS_TILT_FROZEN ? unit->last[signal] : *value + fault->value;
	}
}

static int sample(rs_tilt_unit *unit, double time, double *signal)
{
	const rs_tilt_setup *s = &unit->setup;
	if (unit->next_noise >= unit->noises)
		return RS_TILT_NO_NOISE;
	const double *noise = unit->noise + RS_TILT_NOISY * unit->next_noise++;
	for (int i = 0; i < RS_TILT_NOISY; i++)
		signal[i] = unit->filtered[i] + s->sensor[i].bias + s->sensor[i].scatter * noise[i];
	signal[5] = unit->V * (1.0 + s->place_scale);
	signal[6] = unit->place * (1.0 + s->place_scale) + s->place_offset;
	for (int i = 0; i < RS_TILT_SIGNALS; i++) {
		spoil(unit, time, i, signal + i);
		if (i < RS_TILT_NOISY)
			signal[i] = rs_tilt_clamp(signal[i], s->sensor[i].range);
		if (!isnan(signal[i]))
			unit->last[i] = signal[i];
	}
	return RS_OK;
}

int rs_tilt_unit_read(rs_tilt_unit *unit, double *signal)
{
	size_t n = (size_t)unit->integrator->n;
	double *q = unit->q, time = unit->integrator->report.time;
	rs_integrator_state(unit->integrator, q, q + n, q + 2 * n);
	int status = sense(unit, time, q, q + n, q + 2 * n);
	return status ? status : sample(unit, time, signal);
}

/* The set point of the step that begins: in its middle, on the straight line from the last command to this one. */
static void set_point(rs_tilt_unit *unit)
{
	const rs_tilt_setup *s = &unit->setup;
	double part = ((double)(unit->integrator->report.steps % s->every) + 0.5) / s->every, angle = unit->from + part * (unit->to - unit->from);
	for (int k = 0; k < s->actuators; k++) {
		const double *c = s->length + RS_TILT_POWERS * k;
		double length = c[RS_TILT_POWERS - 1];
		for (int i = RS_TILT_POWERS - 2; i >= 0; i--)
			length = length * angle + c[i];
		s->actuator[k]->command = length;
	}
}

void rs_tilt_unit_command(rs_tilt_unit *unit, double angle)
{
	unit->from = unit->to;
	unit->to = angle;
	set_point(unit);
}

int rs_tilt_unit_watch(void *context, double time, const double *q, const double *u, const double *a)
{
	rs_tilt_unit *unit = context;
	unit->answer = sense(unit, time, q, u, a);
	set_point(unit);
	return unit->answer;
}

int rs_tilt_unit_control(void *context, double time, const double *q, const double *u, const double *a)
{
	rs_tilt_unit *unit = context;
	const rs_tilt_setup *s = &unit->setup;
	unit->answer = sense(unit, time, q, u, a);
	if (unit->answer)
		return unit->answer;
	double *row = unit->log + (size_t)(unit->logged < unit->rows ? unit->logged : 0) * RS_TILT_ROW;
	row[0] = time;
	memset(row + 1 + RS_TILT_SIGNALS, 0, RS_TILT_OUTPUTS * sizeof *row);
	unit->answer = sample(unit, time, row + 1);
	if (!unit->answer)
		unit->answer = s->law(s->context, time, row + 1, &unit->command, row + 1 + RS_TILT_SIGNALS);
	if (!unit->answer && !(fabs(unit->command) <= s->limit))
		unit->answer = RS_TILT_BAD_COMMAND;
	if (unit->answer)
		return unit->answer;
	row[1 + RS_TILT_SIGNALS] = unit->command;
	unit->logged = unit->logged < unit->rows ? unit->logged + 1 : 1;
	rs_tilt_unit_command(unit, unit->command);
	return RS_OK;
}

int rs_tilt_unit_log(rs_tilt_unit *unit, double *rows)
{
	int count = unit->logged;
	memcpy(rows, unit->log, (size_t)count * RS_TILT_ROW * sizeof *rows);
	unit->logged = 0;
	return count;
}

void rs_tilt_unit_noise(rs_tilt_unit *unit, int rows, const double *noise)
{
	unit->noise = noise;
	unit->noises = rows;
	unit->next_noise = 0;
}

int rs_tilt_unit_answer(const rs_tilt_unit *unit, double *command)
{
	*command = unit->command;
	return unit->answer;
}
