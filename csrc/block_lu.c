/* SPDX-License-Identifier: BSD-3-Clause */
/* Block LU: for k = 1 ... N
 *
 *     D_k = A_kk^-1,   L_ik = A_ik D_k,   A_ij = A_ij - L_ik U_kj   (i, j later than k and coupled to it)
 *
 * with U_kj = A_kj and D_k kept in place of A_kk. Then A x = b is
 *
 *     y_i = b_i - sum L_ik y_k,     x_k = D_k (y_k - sum U_kj x_j).
 *
 * A_kk is inverted by Gauss-Jordan with exchange of columns: of a body's block, mass and own
 * stiffness on the diagonal, so that pivots across blocks are not needed. What could go wrong is
 * looked at twice: a pivot against the entries of its block, and the residual of the iteration
 * that the factors serve.
 */
#include <math.h>
#include <string.h>

#include "block_lu.h"
#include "dispatch.h"
#include "railsym.h"

#if defined(__GNUC__)
typedef double column8 __attribute__((vector_size(8 * RS_BLOCK), may_alias));
#else
typedef struct { double row[RS_BLOCK]; } column8;
#endif

/* to = to - x times column */
static RS_ALWAYS_INLINE void subtract(column8 *to, double x, const column8 *column)
{
#if defined(__GNUC__)
	*to -= x * *column;
#else
	for (int r = 0; r < RS_BLOCK; r++)
		to->row[r] -= x * column->row[r];
#endif
}

/* C = C - A B; A has inner columns, B and C have columns. */
static RS_ALWAYS_INLINE void multiply(column8 *C, const column8 *A, const double *B, int inner, int columns)
{
	column8 sum[RS_BLOCK];
	for (int j = 0; j < columns; j++)
		sum[j] = C[j];
	for (int k = 0; k < inner; k++)
		for (int j = 0; j < columns; j++)
			subtract(sum + j, B[RS_BLOCK * j + k], A + k);
	for (int j = 0; j < columns; j++)
		C[j] = sum[j];
}

/* Six and eight coordinates, a body and a wheelset with axleboxes, as constants: loops unroll. */
static RS_ALWAYS_INLINE void subtract_product(double *C, const double *A, const double *B, int inner, int columns)
{
	if (inner == 6 && columns == 6)
		multiply((column8 *)C, (const column8 *)A, B, 6, 6);
	else if (inner == 6 && columns == 8)
		multiply((column8 *)C, (const column8 *)A, B, 6, 8);
	else if (inner == 8 && columns == 6)
		multiply((column8 *)C, (const column8 *)A, B, 8, 6);
	else if (inner == 8 && columns == 8)
		multiply((column8 *)C, (const column8 *)A, B, 8, 8);
	else
		multiply((column8 *)C, (const column8 *)A, B, inner, columns);
}

static void swap(double *a, double *b, int count, int stride)
{
	for (int k = 0; k < count * stride; k += stride) {
		double kept = a[k];
		a[k] = b[k];
		b[k] = kept;
	}
}

/* Column, at or behind k, with the largest entry in row k. */
static RS_ALWAYS_INLINE int pivot_column(const double *A, int size, int k)
{
	int best = k;
	for (int j = k + 1; j < size; j++)
		if (fabs(A[RS_BLOCK * j + k]) > fabs(A[RS_BLOCK * best + k]))
			best = j;
	return best;
}

/* A = A^-1 with exchanges. Returns 0 where a pivot vanishes against the row it stands in. */
static int invert_with_exchanges(double *A, int size)
{
	double largest[RS_BLOCK] = {0.0};
	int with[RS_BLOCK];
	for (int j = 0; j < size; j++)
		for (int r = 0; r < size; r++)
			largest[r] = fabs(A[RS_BLOCK * j + r]) > largest[r] ? fabs(A[RS_BLOCK * j + r]) : largest[r];
	for (int k = 0; k < size; k++) {
		double *own = A + RS_BLOCK * k;
		with[k] = pivot_column(A, size, k);
		if (with[k] != k)
			swap(own, A + RS_BLOCK * with[k], RS_BLOCK, 1);
		double pivot = own[k], inverse = 1.0 / pivot;
		if (!(fabs(pivot) > 1e-13 * largest[k]) || !isfinite(pivot))
			return 0;
		own[k] = 1.0;
		for (int r = 0; r < RS_BLOCK; r++)
			own[r] *= inverse;
		for (int j = 0; j < size; j++) {
			double *other = A + RS_BLOCK * j, factor = other[k];
			if (j == k)
				continue;
			other[k] = 0.0;
			subtract((column8 *)other, factor, (const column8 *)own);
		}
	}
	for (int k = size - 1; k >= 0; k--)
		if (with[k] != k)
			swap(A + k, A + with[k], size, RS_BLOCK);
	return 1;
}

#if defined(__GNUC__)
/* A = A^-1 without exchanges, in registers. Returns 0, A as it was, where a pivot is below a hundredth of its row: then the
 * growth of what is left would cost digits. */
static RS_ALWAYS_INLINE int invert_as_it_stands(double *A, const int size)
{
	column8 c[RS_BLOCK];
	double smallest = 1.0;
	for (int j = 0; j < size; j++)
		c[j] = ((const column8 *)A)[j];
#pragma GCC unroll 8
	for (int k = 0; k < size; k++) {
		double pivot = c[k][k], inverse = 1.0 / pivot, row = 0.0;
#pragma GCC unroll 8
		for (int j = 0; j < size; j++)
			row = j > k && fabs(c[j][k]) > row ? fabs(c[j][k]) : row;
		double ratio = fabs(pivot) / row;
		smallest = ratio < smallest ? ratio : pivot == pivot ? smallest : -1.0;
		c[k][k] = 1.0;
		c[k] *= inverse;
#pragma GCC unroll 8
		for (int j = 0; j < size; j++) {
			double factor = c[j][k];
			if (j == k)
				continue;
			c[j][k] = 0.0;
			c[j] -= factor * c[k];
		}
	}
	if (!(smallest > 0.01))
		return 0;
	for (int j = 0; j < size; j++)
		((column8 *)A)[j] = c[j];
	return 1;
}

static RS_ALWAYS_INLINE int invert(double *A, int size)
{
	if ((size == 6 && invert_as_it_stands(A, 6)) || (size == 8 && invert_as_it_stands(A, 8)))
		return 1;
	return invert_with_exchanges(A, size);
}
#else
static int invert(double *A, int size)
{
	return invert_with_exchanges(A, size);
}
#endif

RS_CLONES
int rs_block_lu_factor(rs_block_lu *lu, int *worst)
{
	double *values = lu->values;
	const int *target = lu->target;
	for (int k = 0; k < lu->blocks; k++) {
		double *diagonal = values + lu->diagonal[k];
		int size = lu->size[k], from = lu->first[k], to = lu->first[k + 1];
		if (!invert(diagonal, size)) {
			*worst = k;
			return RS_SINGULAR;
		}
		for (int i = from; i < to; i++) {
			_Alignas(64) double product[RS_BLOCK * RS_BLOCK] = {0.0};
			double *lower = values + lu->lower[i];
			subtract_product(product, lower, diagonal, size, size);
			for (int e = 0; e < RS_BLOCK * size; e++)
				lower[e] = -product[e];
			for (int j = from; j < to; j++)
				subtract_product(values + *target++, lower, values + lu->upper[j], size, lu->size[lu->later[j]]);
		}
	}
	return RS_OK;
}

/* Solves with columns whole, and with their halves: GCC lowers vectors of 64 bytes badly where the processor has none. */
#if RS_LEVELS
typedef double half8 __attribute__((vector_size(4 * RS_BLOCK), may_alias));
typedef struct {
	half8 half[2];
} column4;

#define COLUMN column4
#define SUBTRACT(to, x, column) ((to)->half[0] -= (x) * (column)->half[0], (to)->half[1] -= (x) * (column)->half[1])
#define PART(name) name##_by_halves
#define LEVELS RS_CLONES
#include "block_solve.h"
#endif

#define COLUMN column8
#define SUBTRACT subtract
#define PART(name) name##_whole
#define LEVELS RS_WIDEST
#include "block_solve.h"

void rs_block_lu_solve(const rs_block_lu *lu, double *x)
{
#if RS_LEVELS
	if (!RS_TAKES_WIDEST) {
		solve_by_halves(lu, x);
		return;
	}
#endif
	solve_whole(lu, x);
}
