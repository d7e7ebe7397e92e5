/* SPDX-License-Identifier: BSD-3-Clause */
/* Order of elimination, fill and list of operations of a block LU.
 *
 * Minimum degree: the block whose elimination couples the fewest coordinates goes next (links,
 * then wheelsets, bogie frames, and the car body last), ties by number, so that the order is
 * always the same. Eliminating k couples all its later neighbours to each other.
 */
#include <stdlib.h>
#include <string.h>

#include "block_lu.h"

static int degree_of(int blocks, const int *size, const unsigned char *coupled, const unsigned char *gone, int k)
{
	int degree = 0;
	for (int j = 0; j < blocks; j++)
		if (j != k && !gone[j] && coupled[k * blocks + j])
			degree += size[j];
	return degree;
}

/* Fills order, and couples what elimination couples. */
static void eliminate(int blocks, const int *size, unsigned char *coupled, unsigned char *gone, int *order)
{
	for (int step = 0; step < blocks; step++) {
		int best = -1, least = 0;
		for (int k = 0; k < blocks; k++) {
			int degree = gone[k] ? 0 : degree_of(blocks, size, coupled, gone, k);
			if (!gone[k] && (best < 0 || degree < least)) {
				best = k;
				least = degree;
			}
		}
		order[step] = best;
		gone[best] = 1;
		for (int i = 0; i < blocks; i++)
			for (int j = 0; j < blocks; j++)
				if (!gone[i] && !gone[j] && coupled[best * blocks + i] && coupled[best * blocks + j])
					coupled[i * blocks + j] = 1;
	}
}

static int *integers(int count)
{
	return malloc((size_t)(count + 1) * sizeof(int));
}

static int count_pairs(int blocks, const int *order, const unsigned char *coupled)
{
	int pairs = 0;
	for (int k = 0; k < blocks; k++)
		for (int i = k + 1; i < blocks; i++)
			pairs += coupled[order[k] * blocks + order[i]] != 0;
	return pairs;
}

static void number_blocks(rs_block_lu *lu, const int *order, const int *size, const unsigned char *coupled)
{
	int blocks = lu->blocks, offset = 0, pair = 0;
	for (int k = 0; k < blocks; k++) {
		lu->block_at[k] = order[k];
		lu->size[k] = size[order[k]];
	}
	for (int k = 0; k < blocks; k++) {
		lu->diagonal[k] = offset;
		offset += RS_BLOCK * lu->size[k];
		lu->first[k] = pair;
		for (int i = k + 1; i < blocks; i++) {
			if (!coupled[order[k] * blocks + order[i]])
				continue;
			lu->later[pair] = i;
			lu->lower[pair] = offset;
			lu->upper[pair++] = offset + RS_BLOCK * lu->size[k];
			offset += RS_BLOCK * (lu->size[k] + lu->size[i]);
		}
	}
	lu->first[blocks] = pair;
	lu->values_size = offset;
}

int rs_block_lu_offset(const rs_block_lu *lu, int row, int column)
{
	int k = row < column ? row : column, i = row < column ? column : row;
	if (row == column)
		return lu->diagonal[k];
	for (int p = lu->first[k]; p < lu->first[k + 1]; p++)
		if (lu->later[p] == i)
			return row < column ? lu->upper[p] : lu->lower[p];
	return -1;
}

static int list_targets(rs_block_lu *lu)
{
	int count = 0, filled = 0;
	for (int k = 0; k < lu->blocks; k++) {
		int degree = lu->first[k + 1] - lu->first[k];
		count += degree * degree;
	}
	lu->target = integers(count);
	for (int k = 0; lu->target && k < lu->blocks; k++)
		for (int i = lu->first[k]; i < lu->first[k + 1]; i++)
			for (int j = lu->first[k]; j < lu->first[k + 1]; j++)
				lu->target[filled++] = rs_block_lu_offset(lu, lu->later[i], lu->later[j]);
	return lu->target != NULL;
}

static int allocate(rs_block_lu *lu, int pairs)
{
	lu->size = integers(lu->blocks);
	lu->block_at = integers(lu->blocks);
	lu->diagonal = integers(lu->blocks);
	lu->first = integers(lu->blocks + 1);
	lu->later = integers(pairs);
	lu->lower = integers(pairs);
	lu->upper = integers(pairs);
	return lu->size && lu->block_at && lu->diagonal && lu->first && lu->later && lu->lower && lu->upper;
}

/* gone and order are the caller's work space. */
static rs_block_lu *analyse(int blocks, const int *size, unsigned char *coupled, unsigned char *gone, int *order)
{
	rs_block_lu *lu = calloc(1, sizeof *lu);
	if (!lu)
		return NULL;
	eliminate(blocks, size, coupled, gone, order);
	lu->blocks = blocks;
	int fine = allocate(lu, count_pairs(blocks, order, coupled));
	if (fine) {
		number_blocks(lu, order, size, coupled);
		fine = list_targets(lu);
	}
	size_t bytes = (size_t)(lu->values_size + RS_BLOCK) * sizeof(double);
	lu->values = fine ? aligned_alloc(64, (bytes + 63) / 64 * 64) : NULL;
	if (!lu->values) {
		rs_block_lu_free(lu);
		return NULL;
	}
	memset(lu->values, 0, bytes);
	return lu;
}

rs_block_lu *rs_block_lu_create(int blocks, const int *size, const unsigned char *coupled)
{
	size_t square = (size_t)blocks * (size_t)blocks;
	unsigned char *pattern = malloc(square + 1), *gone = calloc((size_t)blocks + 1, 1);
	int *order = integers(blocks);
	rs_block_lu *lu = NULL;
	if (pattern && gone && order) {
		for (int i = 0; i < blocks; i++)
			for (int j = 0; j < blocks; j++)
				pattern[i * blocks + j] = coupled[i * blocks + j] || coupled[j * blocks + i];
		lu = analyse(blocks, size, pattern, gone, order);
	}
	free(pattern);
	free(gone);
	free(order);
	return lu;
}

void rs_block_lu_free(rs_block_lu *lu)
{
	if (!lu)
		return;
	free(lu->size);
	free(lu->block_at);
	free(lu->diagonal);
	free(lu->first);
	free(lu->later);
	free(lu->lower);
	free(lu->upper);
	free(lu->target);
	free(lu->values);
	free(lu);
}
