/* SPDX-License-Identifier: BSD-3-Clause */
/* Building a contact table.
 *   1. On the nodes of the whole range every zone is closed; a zone gets nodes of its own where it can touch before the whole
 *      wheel is beyond the deepest penetration.
 *   2. On those it is closed again and lowered level by level. Two zones with least gaps of their own part at the largest gap
 *      between them.
 *   3. Where a zone has no contact of its own, c goes on as a straight line over the shift and the fields as they were, so
 *      that the cubics beside it stay sound.
 * At the end of a profile, and where the patch cannot be computed, c is known and the stiffness is not a number: who touches there
 * has left the table.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact_table.h"
#include "posture.h"

#define FIRST_LEVEL 0.3 /* of the first tau after 0: where the limit tau -> 0 is taken */
#define REACH 1.2       /* zones further than this many largest penetrations from contact are not computed */
#define MISPLACED 2e-6  /* m: places on the wheel may be off by this */
#define NEEDED 1.8      /* the same for the nodes of a zone: beside those within reach, for their cubics */
#define COARSE 2        /* levels that may be too shallow for the points of the rail */
#define SIDEWAYS 2      /* nodes beside those within reach, which their cubics need */

enum { NOTHING, OWN, END }; /* what a zone has at a node: no contact of its own, one, one at the end of a profile */

typedef struct {
	int kind;
	double drop, cosine, across;
} closed;

typedef struct {
	rs_contact_table *table;
	rs_influence influence;
	rs_zone zone[RS_ZONES];
	double modulus;
	rs_posture posture;
	char *kind;             /* of the nodes of the zone being filled */
	int failures;
} builder;

static double *closure_node(const rs_contact_table *t, int zone, int shift, int roll)
{
	return t->zone[zone].closure + ((size_t)shift * (size_t)t->roll.count + (size_t)roll) * RS_CLOSURE;
}

static double *field_node(const rs_contact_table *t, int zone, int shift, int roll, int level)
{
	size_t node = (size_t)shift * (size_t)t->roll.count + (size_t)roll;
	return t->zone[zone].field + (node * (size_t)t->levels + (size_t)level) * RS_FIELDS;
}

/* tau of a level: 0 is level 1, 1 is level m + 1. */
static double tau_of(const rs_contact_table *t, int level)
{
	double part = 1.0 / (t->levels - 3);
	return level == 1 ? FIRST_LEVEL * part : (level - 1) * part;
}

/* Every zone closed, from the gaps at the drop where the posture is; then the posture at the lowest drop. */
static void close_each(builder *b, closed *out)
{
	double start = b->posture.drop, least = INFINITY;
	rs_gaps(&b->posture);
	for (int z = 0; z < b->table->zones; z++) {
		b->posture.drop = start;
		double cosine = rs_close_zone(&b->posture, b->zone[z]);
		out[z] = (closed){cosine > 0.0 ? OWN : cosine < 0.0 ? END : NOTHING, b->posture.drop, fabs(cosine), b->posture.touch_across};
		if (cosine != 0.0 && b->posture.drop < least)
			least = b->posture.drop;
	}
	b->posture.drop = isfinite(least) ? least : start;
}

/* A node: once more where the gaps were those of another drop, at which the wheel lay over other places. */
static void close_zones(builder *b, double eta, int roll, closed *out)
{
	double angle = b->table->roll.start + roll * b->table->roll.step;
	b->posture.sine = sin(angle);
	b->posture.cosine = cos(angle);
	b->posture.y = eta + b->table->wheel_radius * angle;
	close_each(b, out);
	if (fabs((b->posture.drop - b->posture.gap_drop) * b->posture.sine) > MISPLACED)
		close_each(b, out);
}

/* Can the zone touch before the whole wheel is beyond the deepest level? */
static int within_reach(const builder *b, const closed *zones, int zone)
{
	return zones[zone].kind != NOTHING && zones[zone].drop - b->posture.drop < REACH * b->table->deepest / zones[zone].cosine;
}

/* First pass: range of nodes of each zone. */
static void find_ranges(builder *b, int (*range)[2])
{
	const rs_contact_table *t = b->table;
	for (int z = 0; z < t->zones; z++) {
		range[z][0] = t->shift.count;
		range[z][1] = -1;
	}
	for (int j = 0; j < t->roll.count; j++) {
		b->posture.drop = 0.0;
		for (int i = 0; i < t->shift.count; i++) {
			closed zones[RS_ZONES];
			close_zones(b, t->shift.start + i * t->shift.step, j, zones);
			for (int z = 0; z < t->zones; z++)
				if (within_reach(b, zones, z)) {
					range[z][0] = i < range[z][0] ? i : range[z][0];
					range[z][1] = i > range[z][1] ? i : range[z][1];
				}
		}
	}
}

/* Nodes of a zone: those of its range and two more on each side, each interval cut into parts. */
static rs_axis own_axis(const rs_axis *whole, const int *range, int parts)
{
	int first = range[0] - SIDEWAYS > 0 ? range[0] - SIDEWAYS : 0;
	int last = range[1] + SIDEWAYS < whole->count - 1 ? range[1] + SIDEWAYS : whole->count - 1;
	if (range[1] < 0) { /* it never touches */
		first = 0;
		last = 3;
	}
	return rs_axis_of(whole->start + first * whole->step, whole->step / parts, (last - first) * parts + 1);
}

/* Place on the wheel of the largest gap between two rail points. */
static double parting(const rs_posture *p, int one, int other)
{
	int from = one < other ? one : other, to = one < other ? other : one, at = from;
	for (int k = from; k <= to; k++)
		if (p->gap[k] > p->gap[at])
			at = k;
	return p->across[at];
}

/* Where a zone ends: at its neighbours with contacts of their own, or nowhere. */
static rs_zone part_of(builder *b, const closed *zones, int zone)
{
	rs_zone part = {-INFINITY, INFINITY};
	rs_posture *p = &b->posture;
	double drop = p->drop;
	p->drop = zones[zone].drop;
	rs_close_zone(p, b->zone[zone]);
	int own = p->touch_point;
	for (int step = -1; step <= 1; step += 2)
		for (int z = zone + step; z >= 0 && z < b->table->zones; z += step)
			if (zones[z].kind == OWN) {
				p->drop = zones[z].drop;
				rs_close_zone(p, b->zone[z]);
				*(step < 0 ? &part.high : &part.low) = parting(p, own, p->touch_point);
				break;
			}
	p->drop = drop;
	return part;
}

/* Levels of one zone at one node, the posture at the drop of its gaps. */
static int fill_levels(builder *b, int zone, rs_zone part, const closed *own, int shift, int roll)
{
	rs_contact_table *t = b->table;
	rs_patch_guess before = {0};
	double last = tau_of(t, t->levels - 1), above = own->drop - b->posture.gap_drop;
	rs_limit_search(&b->posture, t->deepest * last * last / own->cosine + above);
	int known = 0;
	for (int level = 1; level < t->levels; level++) {
		double tau = tau_of(t, level), normal = t->deepest * tau * tau, depth = normal / own->cosine + above;
		int status = rs_patch_fields(&b->posture, &b->influence, b->modulus, part, depth, normal, &before, field_node(t, zone, shift, roll, level));
		if (status == RS_OK && !known)
			known = level;
		else if (status != RS_OK && known)
			return RS_NOT_CONVERGED;
	}
	if (!known || known > COARSE)
		return RS_NOT_CONVERGED;
	for (int level = 1; level < known; level++) /* too small a patch for the points of the rail: as the first that can be seen */
		memcpy(field_node(t, zone, shift, roll, level), field_node(t, zone, shift, roll, known), RS_FIELDS * sizeof(double));
	double *ghost = field_node(t, zone, shift, roll, 0);
	for (int k = 0; k < RS_FIELDS; k++) /* a parabola through the first three */
		ghost[k] = 3.0 * (ghost[RS_FIELDS + k] - ghost[2 * RS_FIELDS + k]) + ghost[3 * RS_FIELDS + k];
	return RS_OK;
}

/* Second pass, one node. One that cannot be computed is taken as the end of a profile, and counted. */
static void fill_node(builder *b, int zone, int shift, int roll)
{
	rs_zone_table *own = &b->table->zone[zone];
	closed zones[RS_ZONES];
	char *kind = b->kind + (size_t)shift * (size_t)b->table->roll.count + (size_t)roll;
	close_zones(b, own->shift.start + shift * own->shift.step, roll, zones);
	double *c = closure_node(b->table, zone, shift, roll);
	c[0] = zones[zone].drop;
	c[1] = zones[zone].cosine;
	c[2] = rs_wheel_radius(b->posture.from, zones[zone].across);
	c[3] = zones[zone].across;
	*kind = (char)zones[zone].kind;
	if (*kind != OWN)
		return;
	if (zones[zone].drop - b->posture.drop > NEEDED * b->table->deepest / zones[zone].cosine) {
		*kind = NOTHING; /* beyond reach: it only goes along with its neighbours */
		return;
	}
	double lowest = b->posture.drop;
	rs_zone part = part_of(b, zones, zone);
	b->posture.drop = b->posture.gap_drop;
	if (fill_levels(b, zone, part, &zones[zone], shift, roll) != RS_OK) {
		*kind = END; /* who touches there is told that the table ends */
		b->failures++;
	}
	b->posture.drop = lowest;
}

/* Third pass, one node from the two towards the known ones. */
static void extend_node(builder *b, int zone, int shift, int roll, int towards)
{
	rs_contact_table *t = b->table;
	int kind = b->kind[(size_t)shift * (size_t)t->roll.count + (size_t)roll];
	if (kind == NOTHING) {
		double *c = closure_node(t, zone, shift, roll);
		const double *near = closure_node(t, zone, shift + towards, roll), *far = closure_node(t, zone, shift + 2 * towards, roll);
		c[0] = 2.0 * near[0] - far[0];
		for (int k = 1; k < RS_CLOSURE; k++)
			c[k] = near[k];
	}
	for (int level = 0; level < t->levels; level++) {
		double *to = field_node(t, zone, shift, roll, level);
		if (kind == END)
			to[RS_STIFFNESS] = NAN; /* and what touches beside it */
		else
			memcpy(to, field_node(t, zone, shift + towards, roll, level), RS_FIELDS * sizeof *to);
	}
}

static int is_own(const builder *b, int zone, int shift, int roll)
{
	return shift >= 0 && shift < b->table->zone[zone].shift.count && b->kind[(size_t)shift * (size_t)b->table->roll.count + (size_t)roll] == OWN;
}

/* Nodes of one roll before the first pair and after the last pair of known ones, and holes between. 0: there is no pair. */
static int extend(builder *b, int zone, int roll)
{
	int count = b->table->zone[zone].shift.count, first = 0, last = count - 1;
	while (first < count && !(is_own(b, zone, first, roll) && is_own(b, zone, first + 1, roll)))
		first++;
	while (last > first && !(is_own(b, zone, last, roll) && is_own(b, zone, last - 1, roll)))
		last--;
	if (last <= first)
		return 0;
	for (int i = first + 2; i < last - 1; i++)
		if (!is_own(b, zone, i, roll))
			extend_node(b, zone, i, roll, -1);
	for (int i = first - 1; i >= 0; i--)
		extend_node(b, zone, i, roll, 1);
	for (int i = last + 1; i < count; i++)
		extend_node(b, zone, i, roll, -1);
	return 1;
}

/* A roll at which a zone never touches: its nodes are those of a neighbouring roll. */
static void copy_roll(rs_contact_table *t, int zone, int to, int from)
{
	for (int i = 0; i < t->zone[zone].shift.count; i++) {
		memcpy(closure_node(t, zone, i, to), closure_node(t, zone, i, from), RS_CLOSURE * sizeof(double));
		memcpy(field_node(t, zone, i, to, 0), field_node(t, zone, i, from, 0), (size_t)t->levels * RS_FIELDS * sizeof(double));
	}
}

static void fill_zone(builder *b, int zone)
{
	int rolls = b->table->roll.count, known = -1, missing = 0;
	for (int j = 0; j < rolls; j++) {
		b->posture.drop = 0.0;
		for (int i = 0; i < b->table->zone[zone].shift.count; i++)
			fill_node(b, zone, i, j);
		if (extend(b, zone, j)) {
			for (int k = missing; k < j && known < 0; k++)
				copy_roll(b->table, zone, k, j);
			known = j;
		} else if (known >= 0)
			copy_roll(b->table, zone, j, known);
	}
}

static int build(builder *b, const int *parts)
{
	rs_contact_table *t = b->table;
	int range[RS_ZONES][2];
	find_ranges(b, range);
	for (int z = 0; z < t->zones; z++) {
		t->zone[z].shift = own_axis(&t->shift, range[z], parts[z]);
		b->kind = calloc((size_t)t->zone[z].shift.count, (size_t)t->roll.count);
		if (!b->kind || rs_zone_table_allocate(t, z) != RS_OK) {
			free(b->kind);
			return RS_NO_MEMORY;
		}
		fill_zone(b, z);
		free(b->kind);
	}
	return rs_contact_table_filter(t);
}

int rs_contact_table_build(const rs_surfaces *from, const double *shape, const double *cuts, const int *parts, double modulus,
                           rs_contact_table **made, int *failures)
{
	*made = NULL;
	if (rs_contact_table_check(shape) != RS_OK || from->rail_count < 16 || from->wheel_count < 16)
		return RS_BAD_SIZE;
	rs_contact_table *t = rs_contact_table_allocate(shape);
	builder *b = calloc(1, sizeof *b);
	double *room = malloc(3 * (size_t)from->rail_count * sizeof *room);
	int status = t && b && room ? RS_OK : RS_NO_MEMORY;
	if (status == RS_OK) {
		b->table = t;
		b->modulus = modulus;
		b->posture = (rs_posture){.from = from, .across = room, .gap = room + from->rail_count, .slope = room + 2 * from->rail_count};
		for (int z = 0; z < t->zones; z++)
			b->zone[z] = (rs_zone){cuts[z + 1], cuts[z]};
		rs_influence_make(&b->influence);
		status = build(b, parts);
		*failures = b->failures;
	}
	if (status == RS_OK)
		*made = t;
	else
		rs_contact_table_free(t);
	free(b);
	free(room);
	return status;
}
