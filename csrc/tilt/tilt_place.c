/* SPDX-License-Identifier: BSD-3-Clause */
/* Values by place: what the leading sensors found, and a track database (railsym/tilt/place.py). */
#include "tilt.h"

static const double apart = 0.2;   /* m, between values that are kept */

void rs_tilt_push(rs_tilt_places *places, double place, double value)
{
	long long n = places->count;
	if (n && place - places->place[(n - 1) % RS_TILT_ROOM] < apart)
		return;
	places->place[n % RS_TILT_ROOM] = place;
	places->value[n % RS_TILT_ROOM] = value;
	places->count = n + 1;
}

double rs_tilt_look(rs_tilt_places *places, double place)
{
	long long n = places->count;
	if (places->at < n - RS_TILT_ROOM)
		places->at = n - RS_TILT_ROOM;
	if (!n || place < places->place[places->at % RS_TILT_ROOM])
		return places->at == 0 ? 0.0 : places->value[places->at % RS_TILT_ROOM];
	while (places->at + 1 < n && places->place[(places->at + 1) % RS_TILT_ROOM] <= place)
		places->at++;
	int i = (int)(places->at % RS_TILT_ROOM), j = (int)((places->at + 1) % RS_TILT_ROOM);
	if (places->at + 1 == n)
		return places->value[i];
	double part = (place - places->place[i]) / (places->place[j] - places->place[i]);
	return places->value[i] + part * (places->value[j] - places->value[i]);
}

double rs_tilt_table(rs_tilt_places *places, double gravity, double place, double speed)
{
	const double *at_place = places->table_place, *curvature = places->table_curvature, *cant = places->table_sine;
	int at = places->table_at, last = places->points - 2;
	while (at < last && at_place[at + 1] <= place)
		at++;
	while (at > 0 && at_place[at] > place)
		at--;
	places->table_at = at;
	double part = (place - at_place[at]) / (at_place[at + 1] - at_place[at]);
	part = part < 0.0 ? 0.0 : part > 1.0 ? 1.0 : part;
	double k = curvature[at] + part * (curvature[at + 1] - curvature[at]);
	double sine = cant[at] + part * (cant[at + 1] - cant[at]);
	return speed * speed * k - gravity * sine;
}
