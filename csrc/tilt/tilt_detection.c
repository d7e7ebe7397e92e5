/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves found with hysteresis, and where they began (railsym/tilt/detection.py):
 *
 *     t_start = t_off - (t_on - t_off) curve_off / (curve_on - curve_off) - delay.
 */
#include <math.h>

#include "tilt.h"

static void switch_to(rs_tilt_detector *found, const rs_tilt_constants *k, int above, int below)
{
	if (above) {
		found->in_curve = 1;
		found->quiet = 0;
	} else if (!below) {
		found->quiet = 0;
	} else if (found->in_curve && ++found->quiet >= k->leave) {
		found->in_curve = 0;
	}
}

static void begun(rs_tilt_detector *found, const rs_tilt_constants *k, double time, double size, double speed, double place)
{
	double before = found->before;
	if (before < k->curve_off && k->curve_off <= size)
		found->passed_off = time - k->period * (size - k->curve_off) / (size - before);
	if (before < k->curve_on && k->curve_on <= size) {
		double passed_on = time - k->period * (size - k->curve_on) / (size - before);
		double start = found->passed_off - (passed_on - found->passed_off) * k->extrapolation - k->start_delay;
		found->start_time = start;
		found->start_place = place + k->ahead - speed * (time - start);
	}
}

void rs_tilt_detect(rs_tilt_detector *found, const rs_tilt_constants *k, double time, double yaw_rate, double roll_rate, double speed,
                    double place)
{
	found->curvature = yaw_rate / (speed > k->slowest ? speed : k->slowest);
	double size = fabs(found->curvature), roll = fabs(roll_rate);
	begun(found, k, time, size, speed, place);
	found->before = size;
	switch_to(found, k, size > k->curve_on || roll > k->roll_on, size < k->curve_off && roll < k->roll_off);
}

void rs_tilt_detect_by_accelerometer(rs_tilt_detector *found, const rs_tilt_constants *k, double acceleration)
{
	double size = fabs(acceleration);
	found->curvature = 0.0;
	switch_to(found, k, size > k->lateral_on, size < k->lateral_off);
}
