/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory of a contact table: made from arrays, and given back as arrays, so that it can be kept in a file. */
#include "contact_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static size_t closure_size(const rs_contact_table *t, int zone)
{
	return (size_t)t->zone[zone].shift.count * (size_t)t->roll.count * RS_CLOSURE;
}

static size_t field_size(const rs_contact_table *t, int zone)
{
	return (size_t)t->zone[zone].shift.count * (size_t)t->roll.count * (size_t)t->levels * RS_FIELDS;
}

static double *zeros(size_t count)
{
	size_t bytes = (count * sizeof(double) + 63) / 64 * 64;
	double *room = aligned_alloc(64, bytes);
	if (room)
		memset(room, 0, bytes);
	return room;
}

rs_axis rs_axis_of(double start, double step, int count)
{
	return (rs_axis){start, step, 1.0 / step, count};
}

static rs_axis axis_of(const double *numbers)
{
	return rs_axis_of(numbers[0], numbers[1], (int)numbers[2]);
}

static int is_axis(const rs_axis *axis)
{
	return axis->count >= 4 && axis->count <= 100000 && axis->step > 0.0;
}

/* Shape: axes of shift and roll (start, step, nodes each), levels, zones, deepest, wheel radius, spacing. NULL: no memory. */
rs_contact_table *rs_contact_table_allocate(const double *shape)
{
	rs_contact_table *t = calloc(1, sizeof *t);
	if (!t)
		return NULL;
	t->shift = axis_of(shape);
	t->roll = axis_of(shape + 3);
	t->levels = (int)shape[6];
	t->zones = (int)shape[7];
	t->deepest = shape[8];
	t->inverse_root = 1.0 / sqrt(t->deepest);
	t->wheel_radius = shape[9];
	t->spacing = shape[10];
	return t;
}

/* Room for a zone whose axis is set. */
int rs_zone_table_allocate(rs_contact_table *t, int zone)
{
	t->zone[zone].closure = zeros(closure_size(t, zone));
	t->zone[zone].field = zeros(field_size(t, zone));
	return t->zone[zone].closure && t->zone[zone].field ? RS_OK : RS_NO_MEMORY;
}

void rs_contact_table_free(rs_contact_table *t)
{
	if (!t)
		return;
	for (int z = 0; z < RS_ZONES; z++) {
		free(t->zone[z].closure);
		free(t->zone[z].field);
	}
	free(t);
}

static int is_shape(const rs_contact_table *t)
{
	return is_axis(&t->shift) && is_axis(&t->roll) && t->levels >= 5 && t->levels <= 100 && t->zones >= 1 && t->zones <= RS_ZONES &&
	       t->deepest > 0.0;
}

int rs_contact_table_check(const double *shape)
{
	rs_contact_table t = {.shift = axis_of(shape), .roll = axis_of(shape + 3), .levels = (int)shape[6], .zones = (int)shape[7], .deepest = shape[8]};
	return is_shape(&t) ? RS_OK : RS_BAD_SIZE;
}

void rs_contact_table_shape(const rs_contact_table *t, double *shape, double *axes)
{
	double values[RS_TABLE_SHAPE] = {t->shift.start, t->shift.step, t->shift.count, t->roll.start, t->roll.step, t->roll.count,
	                                 t->levels, t->zones, t->deepest, t->wheel_radius, t->spacing};
	memcpy(shape, values, sizeof values);
	for (int z = 0; z < t->zones; z++) {
		axes[3 * z] = t->zone[z].shift.start;
		axes[3 * z + 1] = t->zone[z].shift.step;
		axes[3 * z + 2] = t->zone[z].shift.count;
	}
}

void rs_contact_table_arrays(const rs_contact_table *t, int zone, double *closure, double *field)
{
	memcpy(closure, t->zone[zone].closure, closure_size(t, zone) * sizeof(double));
	memcpy(field, t->zone[zone].field, field_size(t, zone) * sizeof(double));
}

int rs_contact_table_of_arrays(const double *shape, const double *axes, const double *const *closure, const double *const *field,
                               int values, rs_contact_table **made)
{
	*made = NULL;
	if (rs_contact_table_check(shape) != RS_OK)
		return RS_BAD_SIZE;
	rs_contact_table *t = rs_contact_table_allocate(shape);
	int status = t ? RS_OK : RS_NO_MEMORY;
	for (int z = 0; status == RS_OK && z < t->zones; z++) {
		t->zone[z].shift = axis_of(axes + 3 * z);
		status = is_axis(&t->zone[z].shift) ? rs_zone_table_allocate(t, z) : RS_BAD_SIZE;
		if (status != RS_OK)
			break;
		memcpy(t->zone[z].closure, closure[z], closure_size(t, z) * sizeof(double));
		memcpy(t->zone[z].field, field[z], field_size(t, z) * sizeof(double));
	}
	if (status == RS_OK && values)
		status = rs_contact_table_filter(t);
	if (status == RS_OK)
		*made = t;
	else
		rs_contact_table_free(t);
	return status;
}
