/* SPDX-License-Identifier: BSD-3-Clause */
/* FASTSIM's strips (fastsim.c) on WIDE contacts of a batch. fastsim.c includes this once for each processor:
 * 8 with AVX-512, 4 with AVX2 and FMA, 2 with any vector type, 1 without.
 *
 * Where P slips it is shortened to s P, and a small dP of it only turns:
 *
 *   s = g/|P|, g = 1 - t^2    dP -> s (-Py, Px) (Px dPy - Py dPx)/|P|^2
 *
 * What costs is the latency of s, so strips go side by side; then multiplications, so sum t Py comes from sums of sums.
 *
 * Ahead of the first cell that slips P is a polynomial in the distance tau = 1 - t from the leading edge, and so are its sums:
 *
 *   P = -tau (A, B + u3 w),  w = 1 + t    A = (dpx/dX)/L, B = (dpy/dX - 2 u3 X)/L
 *
 * A contact begins where it might slip on any of the strips that go side by side, a batch with the first of them: |P| <= g = tau w is
 * (1 - u3^2) w^2 - 2 B u3 w - (A^2 + B^2) >= 0, from the leading edge to where w is the positive root; never with |u3| >= 1. |A|, |B|
 * and the root grow towards the edges.
 */
#define JOINED(name, wide) name##_##wide
#define JOIN(name, wide) JOINED(name, wide)
#define PART(name) JOIN(name, WIDE)
#define part PART(part)
#define mask PART(mask)
#define traction PART(traction)
#define rates PART(rates)
#define step PART(step)
#define stuck PART(stuck)
#define lines PART(lines)
#define grid PART(grid)

/* LARGER(x, y), AT_LEAST(x, d): the larger one. ABOVE(x, d): where x > d. WHERE(slips, x, y): x where it slips, else y. SCALE(x, s, on,
 * old): x s where on, else old. ADD(sum, on, x): sum and, where on, x. */
#if WIDE == 8
typedef __m512d part;
typedef __mmask8 mask;
#define LARGER(x, y) _mm512_max_pd(x, y)
#define AT_LEAST(x, d) _mm512_max_pd(x, _mm512_set1_pd(d))
#define ABOVE(x, d) _mm512_cmp_pd_mask(x, _mm512_set1_pd(d), _CMP_GT_OQ)
#define WHERE(slips, x, y) _mm512_mask_mov_pd(y, slips, x)
#define SQUARE_ROOT(x) _mm512_sqrt_pd(x)
#define ADD(sum, on, x) _mm512_mask_add_pd(sum, on, sum, x)
#elif WIDE == 4
typedef __m256d part;
typedef __m256d mask;
#define LARGER(x, y) _mm256_max_pd(x, y)
#define AT_LEAST(x, d) _mm256_max_pd(x, _mm256_set1_pd(d))
#define ABOVE(x, d) _mm256_cmp_pd(x, _mm256_set1_pd(d), _CMP_GT_OQ)
#define WHERE(slips, x, y) _mm256_blendv_pd(y, x, slips)
#define SQUARE_ROOT(x) _mm256_sqrt_pd(x)
#define ADD(sum, on, x) ((sum) + _mm256_and_pd(on, x))
#elif WIDE == 2
typedef double part __attribute__((vector_size(16), may_alias));
typedef long long mask __attribute__((vector_size(16), may_alias));
#define ABOVE(x, d) ((mask)((x) > (d)))
#define WHERE(slips, x, y) ((part)(((mask)(x) & (slips)) | ((mask)(y) & ~(slips))))
#define SQUARE_ROOT(x) ((part){sqrt((x)[0]), sqrt((x)[1])})
#define ADD(sum, on, x) ((sum) + (part)((mask)(x) & (on)))
#define LARGER(x, y) WHERE((mask)((x) > (y)), x, y)
#define AT_LEAST(x, d) LARGER(x, (d) + (part){0})
#else
typedef double part;
typedef int mask;
#define ABOVE(x, d) ((x) > (d))
#define WHERE(slips, x, y) ((slips) ? (x) : (y))
#define SQUARE_ROOT(x) sqrt(x)
#define ADD(sum, on, x) ((sum) + ((on) ? (x) : 0.0))
#define LARGER(x, y) fmax(x, y)
#define AT_LEAST(x, d) fmax(x, d)
#endif

typedef struct {
	part x, y;                 /* P, or its slope with respect to one of the u */
	part sum_x, sum_y, sums_y; /* of x, of y, and of sum_y after each cell */
} traction;

typedef struct {
	part x, y;
} step;

/* dpx/dX = x - across u3 Y, dpy/dX = y + spin X. Their slopes: straight for u1 and u2, -across Y and 2 X for u3. */
typedef struct {
	part x, y, spin, across, u3, root, per_root;
	part most_x, most_turn, along, rest, per_rest;  /* |x|, |across u3|, y u3 or 0, 1 - u3^2 */
	double straight;
} rates;

typedef struct {
	int strips, cells;
	double dt, dY;
} grid;

/* Strips side by side: place, half length and its inverse. */
typedef struct {
	double Y[MOST], L[MOST], per_L[MOST];
} lines;

/* After the cells that stick: P, sum of P and sum of sums, of a part that grows by one a cell, and of the spin's. */
typedef struct {
	part grown, sum, sums, spun, spun_sum, spun_sums;
} stuck;

/* g/sqrt(square), 1 where square <= g^2, to 6e-13: processors find 1/sqrt to 14 or 12 bits, a series does the rest. */
RS_INLINE part PART(shortening)(part square, double g)
{
	part m = AT_LEAST(square, g * g);
#if WIDE == 8
	part r = _mm512_rsqrt14_pd(m), e = 1.0 - m * r * r, s = g * r;
	return s + s * e * (0.5 + e * 0.375);
#elif WIDE == 4
	part r = _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(m))), e = 1.0 - m * r * r, s = g * r;
	return s + s * e * (0.5 + e * (0.375 + e * 0.3125));
#elif WIDE == 2
	part s;
	for (int l = 0; l < 2; l++)
		((double *)&s)[l] = g / sqrt(((const double *)&m)[l]);
	return s;
#else
	return g / sqrt(m);
#endif
}

/* Turns the slopes of a traction from before to its shortened value. */
RS_INLINE void PART(turn)(traction *p, const traction *before, part square, part s, double g)
{
	mask slips = ABOVE(square, g * g);
	part per_square = s * s * (1.0 / (g * g)), back = -p[0].x;
	UNROLL
	for (int k = 1; k <= 3; k++) {
		part angle = (before->y * p[k].x - before->x * p[k].y) * per_square;
		p[k].x = WHERE(slips, angle * p[0].y, p[k].x);
		p[k].y = WHERE(slips, angle * back, p[k].y);
	}
}

/* One cell of one strip: what it adds to P, the bound, the sums; where it is not yet on, all stays. */
RS_INLINE void PART(cell)(traction *p, int columns, const step *add, part spin, double spin_slope, double g, mask on)
{
	traction next[4];
	UNROLL
	for (int k = 0; k < columns; k++) {
		next[k].x = p[k].x;
		next[k].y = p[k].y;
		if (k != 2) /* dPx/du2 grows by nothing, and so does dPy/du1 */
			next[k].x -= add[k].x;
		if (k == 0)
			next[k].y -= add[k].y + spin;
		else if (k > 1)
			next[k].y -= k == 2 ? add[k].y : (part)(spin_slope + (part){0});
	}
	part square = next->x * next->x + next->y * next->y, s = PART(shortening)(square, g);
	traction before = next[0];
	next->x *= s;
	next->y *= s;
	if (columns > 1)
		PART(turn)(next, &before, square, s, g);
	UNROLL
	for (int k = 0; k < columns; k++) {
		p[k].x = WHERE(on, next[k].x, p[k].x);
		p[k].y = WHERE(on, next[k].y, p[k].y);
		p[k].sum_x = ADD(p[k].sum_x, on, p[k].x);
		p[k].sum_y = ADD(p[k].sum_y, on, p[k].y);
		p[k].sums_y = ADD(p[k].sums_y, on, p[k].sum_y);
	}
}

/* Cells that stick on strips from +-Y to the middle; where a number is none, no cell does. */
RS_INLINE part PART(sticking)(const rates *rate, int cells, double Y, double per_L)
{
	const double round = 6755399441055744.0; /* 1.5 2^52 */
	part A = rate->most_x + Y * rate->most_turn, square = rate->rest * A * A + rate->y * rate->y, w;
	w = per_L * (rate->along + SQUARE_ROOT(square));
	/* (i + 1/2) dt < 2 - w, rounded down or to one less; none where w is beyond 2 */
	part stick = (0.5 * cells) * (2.0 - w * rate->per_rest);
	stick = WHERE(ABOVE(rate->rest, 0.0), WHERE(ABOVE(stick, 1.0), stick, (part){0}), (part){0});
	return (stick + round) - round;
}

RS_INLINE int PART(least)(part n)
{
	double least = ((const double *)&n)[0];
	for (int l = 1; l < WIDE; l++)
		least = ((const double *)&n)[l] < least ? ((const double *)&n)[l] : least;
	return (int)least;
}

/* The spin's part of P is tau - tau^2/2; cell i has its middle at tau = (i + 1/2) dt. */
RS_INLINE stuck PART(sums_of)(part n, double dt)
{
	part first = 0.5 * n * (n + 1.0), second = first * (2.0 * n + 1.0) * (1.0 / 3.0), third = first * first, tau = (n - 0.5) * dt;
	return (stuck){0.5 - n, -0.5 * n * n, -0.5 * second, WHERE(ABOVE(n, 0.5), tau * (0.5 * tau - 1.0), (part){0}),
	               0.5 * dt * ((dt / 12.0) * n * (4.0 * n * n - 1.0) - n * n), 0.5 * dt * ((dt / 12.0) * (4.0 * third - first) - second)};
}

/* What a whole cell adds to P and its slopes, spin's part in y aside; and P where the strip begins. At the leading edge that is half
 * a cell ahead of where it is zero, for the first step is half a cell long. */
RS_INLINE void PART(start)(const rates *rate, int columns, double Y, double cell, const stuck *after, step *add, traction *p)
{
	const part zero = {0}, straight = zero + rate->straight * cell;
	add[0] = (step){(rate->x - rate->across * rate->u3 * Y) * cell, rate->y * cell};
	if (columns > 1) {
		add[1] = (step){straight, zero};
		add[2] = (step){zero, straight};
		add[3] = (step){rate->across * (-Y * cell), zero};
	}
	UNROLL
	for (int k = 0; k < columns; k++) {
		p[k] = (traction){after->grown * add[k].x, after->grown * add[k].y, after->sum * add[k].x, after->sum * add[k].y, after->sums * add[k].y};
		if (k == 1 || k == 2)
			continue;
		part spin = k ? (part)(2.0 + zero) : rate->spin;
		p[k].y += after->spun * spin;
		p[k].sum_y += after->spun_sum * spin;
		p[k].sums_y += after->spun_sums * spin;
	}
}

/* What one strip adds to part q of h, or of a column of dh/du. */
RS_INLINE void PART(collect)(const traction *p, const rates *rate, double Y, double L, double dt, double weight, part *h[3], int q)
{
	/* t falls by dt from cell to cell, to dt/2 - 1 */
	part sum_ty = dt * p->sums_y - (1.0 + 0.5 * dt) * p->sum_y;
	h[0][q] += weight * p->sum_x;
	h[1][q] += weight * p->sum_y;
	h[2][q] += weight * (L * rate->root * sum_ty - Y * rate->per_root * p->sum_x);
}

/* Cells from ... to - 1 of the first strips of those side by side; n: cells that stick, one a pair of strips. */
RS_INLINE void PART(advance)(double dt, int columns, int count, int from, int to, const rates *rate, const part *n, step add[][4],
                             traction p[][4])
{
	for (int i = from; i < to; i++) {
		double t = 1.0 - (i + 0.5) * dt, slope = i ? 2.0 * dt * (t + 0.5 * dt) : dt * (1.0 - 0.25 * dt);
		part spin = 0.5 * slope * rate->spin, middle = (i + 0.5) + (part){0};
		UNROLL
		for (int j = 0; j < count; j++)
			PART(cell)(p[j], columns, add[j], spin, slope, 1.0 - t * t, ABOVE(middle - n[j / 2], 0.0));
	}
}

/* Cells that stick on strips first ... last, and what they leave. Returns the least of the contacts. */
RS_INLINE int PART(stick)(const grid *of, int columns, int first, int last, const lines *at, const rates *rate, part *n, step add[][4],
                          traction p[][4])
{
	*n = PART(sticking)(rate, of->cells, fabs(at->Y[first]), at->per_L[first]);
	stuck after = PART(sums_of)(*n, of->dt);
	UNROLL
	for (int j = first; j <= last; j++)
		PART(start)(rate, columns, at->Y[j], of->dt * at->per_L[j], &after, add[j], p[j]);
	return PART(least)(*n);
}

/* Strips side by side; the first of the columns is P, the others its slopes. Pairs at the edge slip so much earlier than the next ones
 * that they begin apart. Sums of every other strip are apart. */
RS_INLINE void PART(strips)(const grid *of, int q, int columns, int count, int edge, const lines *at, const rates *rate, rs_creep_value *sum)
{
	part n[PAIRS];
	traction p[MOST][4];
	step add[MOST][4];
	int last = edge ? 1 : count - 1, first = PART(stick)(of, columns, 0, last, at, rate, n, add, p);
	n[PAIRS - 1] = n[0];
	if (edge) {
		int all = PART(stick)(of, columns, 2, count - 1, at, rate, n + 1, add, p);
		PART(advance)(of->dt, columns, 2, first, all, rate, n, add, p);
		first = all;
	}
	PART(advance)(of->dt, columns, count, first, of->cells, rate, n, add, p);
	UNROLL
	for (int j = 0; j < count; j++)
		UNROLL
		for (int k = 0; k < columns; k++) {
			double L = at->L[j];
			part *to[3];
			for (int i = 0; i < 3; i++)
				to[i] = (part *)(k ? &sum[j % 2].d[i][k - 1] : &sum[j % 2].h[i]);
			PART(collect)(&p[j][k], rate, at->Y[j], L, of->dt, 2.0 / RS_PI * L * L * L * of->dt * of->dY, to, q);
		}
}

/* Strips first ... first + pairs - 1, counted from the edge at Y = -1 inwards, each with the one across from it. */
RS_INLINE void PART(both_sides)(const grid *of, int q, int columns, int pairs, int first, int edge, const rates *rate, rs_creep_value *sum)
{
	lines at;
	UNROLL
	for (int j = 0; j < 2 * pairs; j++) {
		double Y = (first + j / 2 + 0.5) * of->dY - 1.0;
		at.Y[j] = j % 2 ? -Y : Y;
		at.L[j] = sqrt(1.0 - Y * Y);
		at.per_L[j] = 1.0 / at.L[j];
	}
	PART(strips)(of, q, columns, 2 * pairs, edge, &at, rate, sum);
}

RS_INLINE void PART(all_strips)(const grid *of, int q, int slopes, const rates *rate, rs_creep_value *sum, rs_creep_value *out)
{
	const lines middle = {{0.0}, {1.0}, {1.0}};
	int j = 0, half = of->strips / 2;
	if (slopes) {
		for (; j < half; j++)
			PART(both_sides)(of, q, 4, 1, j, 0, rate, sum);
		if (of->strips % 2)
			PART(strips)(of, q, 4, 1, 0, &middle, rate, out);
		return;
	}
	for (; j + PAIRS <= half; j += PAIRS)
		if (j)
			PART(both_sides)(of, q, 1, PAIRS, j, 0, rate, sum);
		else
			PART(both_sides)(of, q, 1, PAIRS, 0, 1, rate, sum);
	for (; j < half; j++)
		PART(both_sides)(of, q, 1, 1, j, 0, rate, sum);
	if (of->strips % 2)
		PART(strips)(of, q, 1, 1, 0, &middle, rate, out);
}

/* Each side has a sum of its own, and the strip in the middle, so that mirrored creepages have mirrored forces to the last bit. */
static void PART(fastsim)(const rs_creep_input *in, int slopes, rs_creep_value *out)
{
	const double straight = 3.0 * RS_PI / 16.0;
	const grid of = {in->strips, in->cells, 2.0 / in->cells, 2.0 / in->strips};
	rs_creep_value sum[2];
	memset(sum, 0, sizeof sum);
	for (int q = 0; q < RS_LANES / WIDE; q++) {
		part root = ((const part *)&in->root)[q], u3 = ((const part *)&in->u[2])[q], rest = 1.0 - u3 * u3;
		part x = straight * ((const part *)&in->u[0])[q], y = straight * ((const part *)&in->u[1])[q], zero = {0};
		part across = 2.0 / (root * root), turn = across * u3;
		rates rate = {x, y, 2.0 * u3, across, u3, root, 1.0 / root,
		              LARGER(x, -x), LARGER(turn, -turn), LARGER(y * u3, zero), rest, 1.0 / rest, straight};
		PART(all_strips)(&of, q, slopes, &rate, sum, out);
	}
	for (int i = 0; i < 3; i++) {
		out->h[i] += sum[0].h[i] + sum[1].h[i];
		for (int j = 0; slopes && j < 3; j++)
			out->d[i][j] += sum[0].d[i][j] + sum[1].d[i][j];
	}
}

#undef JOINED
#undef JOIN
#undef PART
#undef part
#undef mask
#undef traction
#undef rates
#undef step
#undef stuck
#undef lines
#undef grid
#undef LARGER
#undef SQUARE_ROOT
#undef ADD
#undef AT_LEAST
#undef ABOVE
#undef WHERE
#undef WIDE
