/* SPDX-License-Identifier: BSD-3-Clause */
/* The fields of a node as one vector: a node of a zone has eight (row), a node of a closure four (half_row). */
#ifndef RS_ROWS_H
#define RS_ROWS_H

#include "../dispatch.h"
#include "contact_table.h"

#if defined(__GNUC__)
typedef double row __attribute__((vector_size(8 * RS_FIELDS), may_alias));
typedef double half_row __attribute__((vector_size(8 * RS_CLOSURE), may_alias));
#define ADD_SCALED(sum, w, node) ((sum) += (w) * (node))
#define MULTIPLY(to, one, other) ((to) = (one) * (other))
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
#define MULTIPLY(to, one, other) \
	for (int f_ = 0; f_ < (int)(sizeof(to) / sizeof(double)); f_++) \
	((double *)&(to))[f_] = ((const double *)&(one))[f_] * ((const double *)&(other))[f_]
#endif

#endif
