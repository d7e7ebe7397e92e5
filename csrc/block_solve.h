/* SPDX-License-Identifier: BSD-3-Clause */
/* Forward and backward substitution (block_lu.c), once for each kind of COLUMN: eight rows that SUBTRACT(to, x, column) takes x times a
 * column from. PART(name) names the functions, LEVELS says for which processors. */

/* A vector in two parts, y = even + odd columns: half the latency of one sum. */
typedef struct {
	COLUMN even, odd;
} PART(parts);

/* y = y - A x */
static RS_ALWAYS_INLINE void PART(subtract_columns)(PART(parts) *y, const double *A, const double *x, int size)
{
	const COLUMN *column = (const COLUMN *)A;
	for (int c = 0; c + 1 < size; c += 2) {
		SUBTRACT(&y->even, x[c], column + c);
		SUBTRACT(&y->odd, x[c + 1], column + c + 1);
	}
	if (size % 2)
		SUBTRACT(&y->even, x[size - 1], column + size - 1);
}

static RS_ALWAYS_INLINE void PART(subtract_vector)(PART(parts) *y, const double *A, const double *x, int size)
{
	if (size == 6)
		PART(subtract_columns)(y, A, x, 6);
	else if (size == 8)
		PART(subtract_columns)(y, A, x, 8);
	else
		PART(subtract_columns)(y, A, x, size);
}

static RS_ALWAYS_INLINE PART(parts) PART(begin)(const double *x)
{
	PART(parts) y;
	memset(&y.odd, 0, sizeof y.odd);
	memcpy(&y.even, x, sizeof y.even);
	return y;
}

static RS_ALWAYS_INLINE void PART(finish)(PART(parts) *y, double *x)
{
	COLUMN sum = y->even;
	SUBTRACT(&sum, -1.0, &y->odd);
	memcpy(x, &sum, sizeof sum);
}

LEVELS
static void PART(solve)(const rs_block_lu *lu, double *x)
{
	const double *values = lu->values;
	for (int k = 0; k < lu->blocks; k++)
		for (int i = lu->first[k]; i < lu->first[k + 1]; i++) {
			double *to = x + RS_BLOCK * lu->later[i];
			PART(parts) y = PART(begin)(to);
			PART(subtract_vector)(&y, values + lu->lower[i], x + RS_BLOCK * k, lu->size[k]);
			PART(finish)(&y, to);
		}
	for (int k = lu->blocks - 1; k >= 0; k--) {
		static const double zero[RS_BLOCK] = {0.0};
		double *own = x + RS_BLOCK * k;
		PART(parts) y = PART(begin)(own), product = PART(begin)(zero);
		for (int j = lu->first[k]; j < lu->first[k + 1]; j++)
			PART(subtract_vector)(&y, values + lu->upper[j], x + RS_BLOCK * lu->later[j], lu->size[lu->later[j]]);
		PART(finish)(&y, own);
		PART(subtract_vector)(&product, values + lu->diagonal[k], own, lu->size[k]);
		PART(finish)(&product, own);
		for (int r = 0; r < RS_BLOCK; r++)
			own[r] = -own[r];
	}
}

#undef COLUMN
#undef SUBTRACT
#undef PART
#undef LEVELS
