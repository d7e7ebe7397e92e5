/* SPDX-License-Identifier: BSD-3-Clause */
/* Building a contact table: every zone of the wheel at every shift and roll is closed, then lowered level by level. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact_table.h"
#include "posture.h"

#define FIRST_LEVEL 0.3 /* of the first tau after 0: where the limit tau -> 0 is taken */
#define REACH 1.5       /* zones further than this many largest penetrations from contact are not computed */
#define UNKNOWN NAN

typedef struct {
	rs_contact_table *table;
	const rs_influence *influence;
	const rs_zone *zone;
	double modulus;
	rs_posture posture;
} builder;

static double *closure_node(const rs_contact_table *t, int shift, int roll)
{
	return t->closure + ((size_t)shift * (size_t)t->roll.count + (size_t)roll) * RS_FIELDS;
}

static double *field_node(const rs_contact_table *t, int zone, int shift, int roll, int level)
{
	size_t node = ((size_t)zone * (size_t)t->shift.count + (size_t)shift) * (size_t)t->roll.count + (size_t)roll;
	return t->field + (node * (size_t)t->levels + (size_t)level) * RS_FIELDS;
}

/* tau of a level: 0 is level 1, 1 is level m + 1. */
static double tau_of(const rs_contact_table *t, int level)
{
	double part = 1.0 / (t->levels - 3);
	return level == 1 ? FIRST_LEVEL * part : (level - 1) * part;
}

static void take_posture(builder *b, int shift, int roll)
{
	double angle = b->table->roll.start + roll * b->table->roll.step;
	b->posture.sine = sin(angle);
	b->posture.cosine = cos(angle);
	b->posture.y = b->table->shift.start + shift * b->table->shift.step + b->table->wheel_radius * angle;
}

/* c and s of every zone; unknown where none of it is over the rail. */
static void close_node(builder *b, int shift, int roll)
{
	double *to = closure_node(b->table, shift, roll);
	take_posture(b, shift, roll);
	for (int z = 0; z < b->table->zones; z++) {
		double cosine = rs_close_zone(&b->posture, b->zone[z]);
		to[z] = cosine != 0.0 ? b->posture.drop : UNKNOWN;
		to[RS_ZONES + z] = cosine != 0.0 ? fabs(cosine) : UNKNOWN;
	}
}

/* A zone beside the rail is far from contact: c goes on as a straight line, so that the cubics beside it stay sound. */
static void extend(const rs_contact_table *t, int roll, int zone, int from, int step)
{
	for (int i = from; i >= 0 && i < t->shift.count; i += step) {
		double *c = closure_node(t, i, roll);
		if (isfinite(c[zone]))
			continue;
		const double *near = closure_node(t, i - step, roll), *far = closure_node(t, i - 2 * step, roll);
		c[zone] = 2.0 * near[zone] - far[zone];
		c[RS_ZONES + zone] = near[RS_ZONES + zone];
	}
}

static void copy_field(double *to, const double *from)
{
	memcpy(to, from, RS_FIELDS * sizeof *to);
}

/* Levels of one zone at one node; a level without an answer repeats the one before it. */
static int fill_levels(builder *b, int zone, int shift, int roll)
{
	rs_contact_table *t = b->table;
	double cosine = rs_close_zone(&b->posture, b->zone[zone]);
	if (!(cosine > 0.0))
		return 0;
	rs_gaps(&b->posture);
	int known = 0;
	for (int level = 1; level < t->levels; level++) {
		double tau = tau_of(t, level), normal = t->deepest * tau * tau;
		double *to = field_node(t, zone, shift, roll, level);
		if (rs_patch_fields(&b->posture, b->influence, b->modulus, b->zone[zone], normal / cosine, normal, to) == RS_OK)
			known = known ? known : level;
		else if (known)
			copy_field(to, field_node(t, zone, shift, roll, level - 1));
	}
	if (!known)
		return 0;
	for (int level = known - 1; level >= 1; level--)
		copy_field(field_node(t, zone, shift, roll, level), field_node(t, zone, shift, roll, known));
	double *ghost = field_node(t, zone, shift, roll, 0);
	for (int k = 0; k < RS_FIELDS; k++) /* a parabola through the first three */
		ghost[k] = 3.0 * (ghost[RS_FIELDS + k] - ghost[2 * RS_FIELDS + k]) + ghost[3 * RS_FIELDS + k];
	return 1;
}

/* Can the zone touch before the whole wheel is beyond the deepest level? Nodes beside those that can are wanted as well. */
static int within_reach(const rs_contact_table *t, int zone, int shift, int roll)
{
	const double *c = closure_node(t, shift, roll);
	double first = INFINITY;
	for (int z = 0; z < t->zones; z++)
		if (c[z] < first)
			first = c[z];
	return isfinite(c[zone]) && c[zone] - first < REACH * t->deepest / c[RS_ZONES + zone];
}

static int wanted(const rs_contact_table *t, int zone, int shift, int roll)
{
	for (int i = shift - 2; i <= shift + 2; i++)
		if (i >= 0 && i < t->shift.count && within_reach(t, zone, i, roll))
			return isfinite(closure_node(t, shift, roll)[zone]);
	return 0;
}

static void fill_node(builder *b, int shift, int roll)
{
	rs_contact_table *t = b->table;
	take_posture(b, shift, roll);
	for (int z = 0; z < t->zones; z++)
		if (!wanted(t, z, shift, roll) || !fill_levels(b, z, shift, roll))
			for (int level = 0; level < t->levels; level++)
				field_node(t, z, shift, roll, level)[RS_STIFFNESS] = UNKNOWN;
}

int rs_rigid_contact(const rs_surfaces *from, int n, const double *place, double *contact)
{
	static const rs_zone whole = {-INFINITY, INFINITY};
	double *room = malloc(3 * (size_t)from->rail_count * sizeof *room);
	if (!room)
		return RS_NO_MEMORY;
	rs_posture p = {.from = from, .across = room, .gap = room + from->rail_count, .slope = room + 2 * from->rail_count};
	for (int k = 0; k < n; k++, place += 2, contact += 4) {
		p.y = place[0];
		p.sine = sin(place[1]);
		p.cosine = cos(place[1]);
		double cosine = rs_close_zone(&p, whole);
		contact[0] = p.drop;
		contact[1] = p.touch_across;
		contact[2] = p.touch_slope;
		contact[3] = cosine > 0.0;
	}
	free(room);
	return RS_OK;
}

static int check_axes(const rs_axis *shift, const rs_axis *roll, int levels, int zones)
{
	return shift->count >= 4 && roll->count >= 4 && levels >= 5 && zones >= 1 && zones <= RS_ZONES && shift->step > 0.0 && roll->step > 0.0;
}

int rs_contact_table_build(const rs_surfaces *from, const double *axes, int levels, int zones, const double *cuts, double modulus,
                           double deepest, rs_contact_table **made)
{
	rs_axis shift = {axes[0], axes[1], (int)axes[2]}, roll = {axes[3], axes[4], (int)axes[5]};
	*made = NULL;
	if (!check_axes(&shift, &roll, levels, zones) || from->rail_count < 4 || from->wheel_count < 4)
		return RS_BAD_SIZE;
	rs_contact_table *t = rs_contact_table_allocate(shift.count, roll.count, levels, zones);
	rs_influence *influence = malloc(sizeof *influence);
	double *room = malloc(3 * (size_t)from->rail_count * sizeof *room);
	int status = t && influence && room ? RS_OK : RS_NO_MEMORY;
	if (status == RS_OK) {
		rs_zone zone[RS_ZONES];
		for (int z = 0; z < zones; z++)
			zone[z] = (rs_zone){cuts[z + 1], cuts[z]};
		t->shift = shift;
		t->roll = roll;
		t->deepest = deepest;
		t->wheel_radius = from->wheel_radius;
		t->spacing = from->spacing;
		rs_influence_make(influence);
		builder b = {t, influence, zone, modulus,
		             {.from = from, .across = room, .gap = room + from->rail_count, .slope = room + 2 * from->rail_count}};
		for (int i = 0; i < shift.count; i++)
			for (int j = 0; j < roll.count; j++)
				close_node(&b, i, j);
		for (int j = 0; j < roll.count; j++)
			for (int z = 0; z < zones; z++) {
				int middle = (int)(-shift.start / shift.step);
				extend(t, j, z, middle, 1);
				extend(t, j, z, middle, -1);
			}
		for (int i = 0; i < shift.count; i++)
			for (int j = 0; j < roll.count; j++)
				fill_node(&b, i, j);
		*made = t;
		t = NULL;
	}
	rs_contact_table_free(t);
	free(influence);
	free(room);
	return status;
}
