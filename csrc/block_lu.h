/* SPDX-License-Identifier: BSD-3-Clause */
/* Sparse LU in blocks of at most eight coordinates, one block a body.
 *
 * The pattern is analysed once (block_order.c): order of elimination, fill, and a list of block
 * operations. The numbers are then factored again and again (block_lu.c) without looking at the
 * pattern. A block is stored by columns of eight rows, rows that do not exist are zero; a vector
 * has eight numbers a block.
 */
#ifndef RS_BLOCK_LU_H
#define RS_BLOCK_LU_H

enum { RS_BLOCK = 8 };

typedef struct {
	int blocks;            /* N, numbered in the order of elimination */
	int *size;             /* N, coordinates of each block */
	int *block_at;         /* N, the caller's number of each block */
	int *diagonal;         /* N, offset of each diagonal block in values */
	int *first;            /* N + 1: later blocks that k couples to are first[k] ... first[k + 1] - 1 of the next three */
	int *later;            /* their numbers, increasing */
	int *lower, *upper;    /* offsets of L(later, k) and U(k, later) */
	int *target;           /* offsets of A(i, j) for i, j of each k's later blocks, in the order they are used */
	int values_size;       /* doubles, without the eight spare ones behind them */
	double *values;
} rs_block_lu;

/* coupled: N x N, non-zero where two blocks share an equation (taken as symmetric); size: N, 1..8. NULL: no memory. */
rs_block_lu *rs_block_lu_create(int blocks, const int *size, const unsigned char *coupled);
void rs_block_lu_free(rs_block_lu *lu);

/* Offset of block (row, column), numbers in the order of elimination; -1 where the pattern has none. */
int rs_block_lu_offset(const rs_block_lu *lu, int row, int column);

/* Factors values in place. Rows are exchanged within diagonal blocks only.
 * Status: RS_OK, RS_SINGULAR (*worst: the block whose pivot is below 1e-13 of its own entries, or not a number). */
int rs_block_lu_factor(rs_block_lu *lu, int *worst);

/* Solves in place; x: 8 N, zero where a block has no coordinate. */
void rs_block_lu_solve(const rs_block_lu *lu, double *x);

#endif
