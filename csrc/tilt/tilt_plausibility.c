/* SPDX-License-Identifier: BSD-3-Clause */
/* Which signals can be used: missing and repeated samples, and a vote between two accelerometers and the gyroscope
 * (railsym/tilt/plausibility.py). */
#include <math.h>

#include "tilt.h"

enum { COULD_BE_STALE = 4 };

int rs_tilt_take(rs_tilt_channels *channels, const rs_tilt_constants *k, const double *raw)
{
	static const int fault_of[RS_TILT_SIGNALS] = {RS_TILT_GYRO, RS_TILT_GYRO, RS_TILT_A, RS_TILT_B, RS_TILT_ANGLE, RS_TILT_ODOMETER,
	                                              RS_TILT_ODOMETER};
	int faults = 0;
	for (int i = 0; i < RS_TILT_SIGNALS; i++) {
		double value = raw[i];
		if (isnan(value)) {
			channels->missing[i]++;
		} else {
			channels->missing[i] = 0;
			channels->same[i] = value == channels->value[i] && value != 0.0 ? channels->same[i] + 1 : 0;
			channels->value[i] = value;
		}
		if (channels->missing[i] > k->hold || (i < COULD_BE_STALE && channels->same[i] >= k->stale))
			faults |= fault_of[i];
	}
	return faults;
}

double rs_tilt_by_gyroscope(rs_tilt_channels *channels, const rs_tilt_constants *k, int faults, double roll_rate, double yaw_rate,
                            double speed, int in_curve)
{
	if (!(faults & RS_TILT_GYRO)) {
		channels->roll += k->period * roll_rate;
		if (!in_curve)
			channels->roll -= k->washout * channels->roll;
	}
	return speed * yaw_rate - k->gravity * channels->roll;
}

int rs_tilt_judge(rs_tilt_channels *channels, const rs_tilt_constants *k, int faults, double a, double b, double by_gyro)
{
	int both = !(faults & (RS_TILT_A | RS_TILT_B)), apart = fabs(a - b) > k->disagreement;
	channels->apart = both && apart ? channels->apart + 1 : 0;
	if (channels->apart >= k->confirm) {
		if (faults & RS_TILT_GYRO)
			return faults | RS_TILT_A | RS_TILT_B;
		faults |= fabs(a - by_gyro) > fabs(b - by_gyro) ? RS_TILT_A : RS_TILT_B;
		channels->apart = 0;
	}
	if (faults & RS_TILT_GYRO || (faults & RS_TILT_A && faults & RS_TILT_B) || (both && apart)) {
		channels->off = 0;
		return faults;
	}
	int off = fabs(rs_tilt_mean(faults, a, b) - by_gyro) > k->gyro_tolerance;
	channels->off = off ? channels->off + 1 : 0;
	if (channels->off >= k->confirm)
		faults |= faults & (RS_TILT_A | RS_TILT_B) ? RS_TILT_A | RS_TILT_B | RS_TILT_GYRO : RS_TILT_GYRO;
	return faults;
}

double rs_tilt_mean(int faults, double a, double b)
{
	if (!(faults & (RS_TILT_A | RS_TILT_B)))
		return 0.5 * (a + b);
	if (!(faults & RS_TILT_A))
		return a;
	return faults & RS_TILT_B ? 0.0 : b;
}
