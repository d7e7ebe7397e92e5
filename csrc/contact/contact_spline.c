/* SPDX-License-Identifier: BSD-3-Clause */
/* From values at the nodes (of c, s, r, Y' and of the fields) to coefficients of quadratic B-splines, axis by axis:
 *
 *   c_k = f_k - (f_(k-1) - 2 f_k + f_(k+1))/8
 *
 * so that the spline reproduces parabolas (a quasi-interpolant; C. de Boor, A Practical Guide to Splines, 2001, chapter XII): it
 * is continuous with continuous slopes, errs by the third power of the step, and takes three coefficients an axis where a cubic
 * takes four. At the ends of an axis the second difference of the node beside them is taken. Filtering is local, so that what
 * is no number spreads to the neighbours only.
 */
#include <stdlib.h>
#include <string.h>

#include "contact_table.h"

/* One row of count nodes of so many fields each, stride apart; room: count x fields. */
static void filter_row(double *row, size_t stride, size_t count, size_t fields, double *room)
{
	for (size_t k = 0; k < count; k++)
		memcpy(room + k * fields, row + k * stride, fields * sizeof *row);
	for (size_t k = 0; k < count; k++) {
		const double *f = room + (k == 0 ? 1 : k == count - 1 ? count - 2 : k) * fields;
		for (size_t n = 0; n < fields; n++)
			row[k * stride + n] = room[k * fields + n] - 0.125 * ((f - fields)[n] - 2.0 * f[n] + (f + fields)[n]);
	}
}

/* Nodes of a block shifts x rolls x levels x fields along each of its three axes; an axis of one node stays as it is. */
static void filter_block(double *block, size_t shifts, size_t rolls, size_t levels, size_t fields, double *room)
{
	for (size_t k = 0; levels > 1 && k < shifts * rolls; k++)
		filter_row(block + k * levels * fields, fields, levels, fields, room);
	for (size_t i = 0; i < shifts; i++)
		for (size_t l = 0; l < levels; l++)
			filter_row(block + (i * rolls * levels + l) * fields, levels * fields, rolls, fields, room);
	for (size_t k = 0; k < rolls * levels; k++)
		filter_row(block + k * fields, rolls * levels * fields, shifts, fields, room);
}

int rs_contact_table_filter(rs_contact_table *t)
{
	for (int z = 0; z < t->zones; z++) {
		size_t shifts = (size_t)t->zone[z].shift.count, rolls = (size_t)t->roll.count, levels = (size_t)t->levels;
		size_t longest = shifts > rolls ? shifts : rolls;
		double *room = malloc((longest > levels ? longest : levels) * RS_FIELDS * sizeof *room);
		if (!room)
			return RS_NO_MEMORY;
		filter_block(t->zone[z].closure, shifts, rolls, 1, RS_CLOSURE, room);
		filter_block(t->zone[z].field, shifts, rolls, levels, RS_FIELDS, room);
		free(room);
	}
	return RS_OK;
}
