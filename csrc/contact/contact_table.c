/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory of a contact table: made from arrays, and given back as arrays, so that it can be kept in a file. */
#include "contact_table.h"

#include <stdlib.h>
#include <string.h>

static size_t closure_size(const rs_contact_table *t)
{
	return (size_t)t->shift.count * (size_t)t->roll.count * RS_FIELDS;
}

static size_t field_size(const rs_contact_table *t)
{
	return closure_size(t) * (size_t)t->levels * (size_t)t->zones;
}

static double *zeros(size_t count)
{
	size_t bytes = (count * sizeof(double) + 63) / 64 * 64;
	double *room = aligned_alloc(64, bytes);
	if (room)
		memset(room, 0, bytes);
	return room;
}

rs_contact_table *rs_contact_table_allocate(int shifts, int rolls, int levels, int zones)
{
	rs_contact_table *t = calloc(1, sizeof *t);
	if (!t)
		return NULL;
	t->shift.count = shifts;
	t->roll.count = rolls;
	t->levels = levels;
	t->zones = zones;
	t->closure = zeros(closure_size(t));
	t->field = zeros(field_size(t));
	if (!t->closure || !t->field) {
		rs_contact_table_free(t);
		return NULL;
	}
	return t;
}

void rs_contact_table_free(rs_contact_table *t)
{
	if (!t)
		return;
	free(t->closure);
	free(t->field);
	free(t);
}

void rs_contact_table_shape(const rs_contact_table *t, double *shape)
{
	double values[RS_TABLE_SHAPE] = {t->shift.start, t->shift.step, t->shift.count, t->roll.start, t->roll.step, t->roll.count,
	                                 t->levels, t->zones, t->deepest, t->wheel_radius, t->spacing};
	memcpy(shape, values, sizeof values);
}

void rs_contact_table_arrays(const rs_contact_table *t, double *closure, double *field)
{
	memcpy(closure, t->closure, closure_size(t) * sizeof(double));
	memcpy(field, t->field, field_size(t) * sizeof(double));
}

int rs_contact_table_of_arrays(const double *shape, const double *closure, const double *field, rs_contact_table **made)
{
	int shifts = (int)shape[2], rolls = (int)shape[5], levels = (int)shape[6], zones = (int)shape[7];
	*made = NULL;
	if (shifts < 4 || rolls < 4 || levels < 5 || zones < 1 || zones > RS_ZONES || !(shape[1] > 0.0) || !(shape[4] > 0.0) || !(shape[8] > 0.0))
		return RS_BAD_SIZE;
	rs_contact_table *t = rs_contact_table_allocate(shifts, rolls, levels, zones);
	if (!t)
		return RS_NO_MEMORY;
	t->shift.start = shape[0];
	t->shift.step = shape[1];
	t->roll.start = shape[3];
	t->roll.step = shape[4];
	t->deepest = shape[8];
	t->wheel_radius = shape[9];
	t->spacing = shape[10];
	memcpy(t->closure, closure, closure_size(t) * sizeof(double));
	memcpy(t->field, field, field_size(t) * sizeof(double));
	*made = t;
	return RS_OK;
}
