/* SPDX-License-Identifier: BSD-3-Clause */
/* Feed-forward of the demand and PID on what tilt lacks of the reference model's (railsym/tilt/servo.py). */
#include "tilt.h"

double rs_tilt_compare(rs_tilt_servo *servo, const rs_tilt_constants *k, double tilt)
{
	double before = servo->error;
	servo->error = servo->expected - tilt;
	servo->derivative += k->derivative * (k->kd * (servo->error - before) - servo->derivative);
	return servo->error;
}

static double delayed(rs_tilt_servo *servo, const rs_tilt_constants *k, double command, double demand)
{
	servo->commands[servo->next] = command;
	servo->demands[servo->next] = demand;
	servo->next = (servo->next + 1) % (k->delay + 1);
	demand = servo->demands[servo->next];
	servo->rate += k->stiffness * (demand - servo->expected) - k->damping * servo->rate;
	servo->expected += k->period * servo->rate;
	return servo->commands[servo->next];
}

double rs_tilt_servo_command(rs_tilt_servo *servo, const rs_tilt_constants *k, double demand, int feedback)
{
	double wanted = k->kp * servo->error + servo->integral + servo->derivative;
	double limited = rs_tilt_clamp(demand + rs_tilt_clamp(wanted, k->trim_limit), k->limit);
	if (feedback) {
		servo->trim = limited - demand;
		servo->integral += k->ki * servo->error + k->tracking * (servo->trim - wanted);
	} else {
		servo->trim = servo->integral = servo->derivative = 0.0;
		limited = rs_tilt_clamp(demand, k->limit);
	}
	return delayed(servo, k, limited, demand);
}
