/* SPDX-License-Identifier: BSD-3-Clause */
/* The fields of a node: a node of a zone has eight (row), a node of a closure four (half_row). Vectors of 32 bytes, for GCC lowers longer
 * ones badly where the processor has none of 64. */
#ifndef RS_ROWS_H
#define RS_ROWS_H

#include "../dispatch.h"
#include "contact_table.h"

#if defined(__GNUC__)
typedef double half_row __attribute__((vector_size(8 * RS_CLOSURE), may_alias));
typedef struct {
	half_row half[2];
} row;
_Static_assert(sizeof(row) == RS_FIELDS * sizeof(double), "fields of a zone's node");
#define ADD_SCALED(sum, w, node) ((sum) += (w) * (node))
#define ADD_SCALED_ROW(sum, w, node) ((sum).half[0] += (w) * (node).half[0], (sum).half[1] += (w) * (node).half[1])
#define ROW_OF(a, b, c, d, e, f) {{{a, b, c, d}, {e, f}}}
#define MULTIPLY_ROWS(to, one, other) ((to).half[0] = (one).half[0] * (other).half[0], (to).half[1] = (one).half[1] * (other).half[1])
#else
typedef struct {
	double v[RS_FIELDS];
} row;
typedef struct {
	double v[RS_CLOSURE];
} half_row;
#define ADD_SCALED(sum, w, node) \
	for (int f_ = 0; f_ < (int)(sizeof(sum) / sizeof(double)); f_++) \
	((double *)&(sum))[f_] += (w) * ((const double *)&(node))[f_]
#define ADD_SCALED_ROW ADD_SCALED
#define ROW_OF(a, b, c, d, e, f) {{a, b, c, d, e, f}}
#define MULTIPLY_ROWS(to, one, other) \
	for (int f_ = 0; f_ < (int)(sizeof(to) / sizeof(double)); f_++) \
	((double *)&(to))[f_] = ((const double *)&(one))[f_] * ((const double *)&(other))[f_]
#endif

#endif
