/* SPDX-License-Identifier: BSD-3-Clause */
/* FASTSIM's strips (fastsim.c) on WIDE contacts of a batch. fastsim.c includes this once for each processor:
 * 8 with AVX-512, 4 with AVX2 and FMA, 2 with any vector type, 1 without.
 *
 * Where P slips it is shortened to s P, and a small dP of it only turns:
 *
 *   s = g/|P|, g = 1 - t^2    dP -> s (-Py, Px) (Px dPy - Py dPx)/|P|^2
 *
 * What costs is the latency of s, so strips go side by side; then multiplications, so sum t Py comes from sums of sums.
 */
#define JOINED(name, wide) name##_##wide
#define JOIN(name, wide) JOINED(name, wide)
#define PART(name) JOIN(name, WIDE)
#define part PART(part)
#define mask PART(mask)
#define traction PART(traction)
#define rates PART(rates)
#define step PART(step)

/* AT_LEAST(x, d): the larger one. ABOVE(x, d): where x > d. WHERE(slips, x, y): x where it slips, else y. */
#if WIDE == 8
typedef __m512d part;
typedef __mmask8 mask;
#define AT_LEAST(x, d) _mm512_max_pd(x, _mm512_set1_pd(d))
#define ABOVE(x, d) _mm512_cmp_pd_mask(x, _mm512_set1_pd(d), _CMP_GT_OQ)
#define WHERE(slips, x, y) _mm512_mask_mov_pd(y, slips, x)
#elif WIDE == 4
typedef __m256d part;
typedef __m256d mask;
#define AT_LEAST(x, d) _mm256_max_pd(x, _mm256_set1_pd(d))
#define ABOVE(x, d) _mm256_cmp_pd(x, _mm256_set1_pd(d), _CMP_GT_OQ)
#define WHERE(slips, x, y) _mm256_blendv_pd(y, x, slips)
#elif WIDE == 2
typedef double part __attribute__((vector_size(16), may_alias));
typedef long long mask __attribute__((vector_size(16), may_alias));
#define ABOVE(x, d) ((mask)((x) > (d)))
#define WHERE(slips, x, y) ((part)(((mask)(x) & (slips)) | ((mask)(y) & ~(slips))))
#define AT_LEAST(x, d) WHERE(ABOVE(x, d), x, (d) + (part){0})
#else
typedef double part;
typedef int mask;
#define ABOVE(x, d) ((x) > (d))
#define WHERE(slips, x, y) ((slips) ? (x) : (y))
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
	part x, y, spin, across, u3, root;
	double straight;
} rates;

/* g/sqrt(square), 1 where square <= g^2, to rounding: processors find 1/sqrt to 14 or 12 bits, a series does the rest. */
RS_INLINE part PART(shortening)(part square, double g)
{
	part m = AT_LEAST(square, g * g);
#if WIDE == 8
	part r = _mm512_rsqrt14_pd(m), e = 1.0 - m * r * r, s = g * r;
	return s + s * e * (0.5 + e * (0.375 + e * 0.3125));
#elif WIDE == 4
	part r = _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(m))), e = 1.0 - m * r * r, s = g * r;
	return s + s * e * (0.5 + e * (0.375 + e * (0.3125 + e * 0.2734375)));
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

/* One cell of one strip: what it adds to P, the bound, the sums. */
RS_INLINE void PART(cell)(traction *p, int columns, const step *add, part spin, double spin_slope, double g)
{
	UNROLL
	for (int k = 0; k < columns; k++) {
		if (k != 2) /* dPx/du2 grows by nothing, and so does dPy/du1 */
			p[k].x -= add[k].x;
		if (k == 0)
			p[k].y -= add[k].y + spin;
		else if (k > 1)
			p[k].y -= k == 2 ? add[k].y : (part)(spin_slope + (part){0});
	}
	traction before = p[0];
	part square = p->x * p->x + p->y * p->y, s = PART(shortening)(square, g);
	p->x *= s;
	p->y *= s;
	if (columns > 1)
		PART(turn)(p, &before, square, s, g);
	UNROLL
	for (int k = 0; k < columns; k++) {
		p[k].sum_x += p[k].x;
		p[k].sum_y += p[k].y;
		p[k].sums_y += p[k].sum_y;
	}
}

/* What a whole cell adds to P and its slopes, spin's part in y aside; and P at the leading edge, half a cell ahead of where it
 * is zero, for the first step is half a cell long. */
RS_INLINE void PART(start)(const rates *rate, int columns, double Y, double cell, step *add, traction *p)
{
	const part zero = {0}, straight = zero + rate->straight * cell;
	add[0] = (step){(rate->x - rate->across * rate->u3 * Y) * cell, rate->y * cell};
	if (columns > 1) {
		add[1] = (step){straight, zero};
		add[2] = (step){zero, straight};
		add[3] = (step){rate->across * (-Y * cell), zero};
	}
	UNROLL
	for (int k = 0; k < columns; k++)
		p[k] = (traction){0.5 * add[k].x, 0.5 * add[k].y, zero, zero, zero};
}

/* What one strip adds to part q of h, or of a column of dh/du. */
RS_INLINE void PART(collect)(const traction *p, const rates *rate, double Y, double L, double dt, double weight, part *h[3], int q)
{
	/* t falls by dt from cell to cell, to dt/2 - 1 */
	part sum_ty = dt * p->sums_y - (1.0 + 0.5 * dt) * p->sum_y;
	h[0][q] += weight * p->sum_x;
	h[1][q] += weight * p->sum_y;
	h[2][q] += weight * (L * rate->root * sum_ty - Y / rate->root * p->sum_x);
}

/* Strips first .. first + count - 1, counted inwards from Y = -side, side by side; the first of the columns is P, the others its
 * slopes. */
RS_INLINE void PART(strips)(const rs_creep_input *in, int q, int columns, int count, int first, double side, const rates *rate,
                            rs_creep_value *out)
{
	double dt = 2.0 / in->cells, dY = 2.0 / in->strips, Y[MOST], L[MOST];
	traction p[MOST][4];
	step add[MOST][4];
	UNROLL
	for (int j = 0; j < count; j++) {
		Y[j] = side * (-1.0 + (first + j + 0.5) * dY);
		L[j] = sqrt(1.0 - Y[j] * Y[j]);
		PART(start)(rate, columns, Y[j], dt / L[j], add[j], p[j]);
	}
	part spin = 0.5 * dt * (1.0 - 0.25 * dt) * rate->spin, whole = dt * rate->spin, less = dt * whole;
	double slope = dt * (1.0 - 0.25 * dt);
	for (int i = 0; i < in->cells; i++) {
		double t = 1.0 - (i + 0.5) * dt;
		UNROLL
		for (int j = 0; j < count; j++)
			PART(cell)(p[j], columns, add[j], spin, slope, 1.0 - t * t);
		whole -= less;
		spin = whole;
		slope = 2.0 * dt * (t - 0.5 * dt);
	}
	UNROLL
	for (int j = 0; j < count; j++)
		UNROLL
		for (int k = 0; k < columns; k++) {
			part *to[3];
			for (int i = 0; i < 3; i++)
				to[i] = (part *)(k ? &out->d[i][k - 1] : &out->h[i]);
			PART(collect)(&p[j][k], rate, Y[j], L[j], dt, 2.0 / RS_PI * L[j] * L[j] * L[j] * dt * dY, to, q);
		}
}

/* Strips on one side of the middle, from the edge inwards. */
RS_INLINE void PART(one_side)(const rs_creep_input *in, int q, int slopes, double side, const rates *rate, rs_creep_value *out)
{
	int j = 0, half = in->strips / 2;
	if (slopes) {
		for (; j + FEW <= half; j += FEW)
			PART(strips)(in, q, 4, FEW, j, side, rate, out);
		for (; j < half; j++)
			PART(strips)(in, q, 4, 1, j, side, rate, out);
		return;
	}
	for (; j + MOST <= half; j += MOST)
		PART(strips)(in, q, 1, MOST, j, side, rate, out);
	for (; j < half; j++)
		PART(strips)(in, q, 1, 1, j, side, rate, out);
}

/* Each side has a sum of its own, and the strip in the middle, so that mirrored creepages have mirrored forces to the last bit. */
static void PART(fastsim)(const rs_creep_input *in, int slopes, rs_creep_value *out)
{
	const double straight = 3.0 * RS_PI / 16.0;
	rs_creep_value sum[2];
	memset(sum, 0, sizeof sum);
	for (int q = 0; q < RS_LANES / WIDE; q++) {
		part root = ((const part *)&in->root)[q], u3 = ((const part *)&in->u[2])[q];
		rates rate = {straight * ((const part *)&in->u[0])[q], straight * ((const part *)&in->u[1])[q], 2.0 * u3,
		              2.0 / (root * root), u3, root, straight};
		for (int other = 0; other < 2; other++)
			PART(one_side)(in, q, slopes, other ? -1.0 : 1.0, &rate, sum + other);
		if (in->strips % 2 && slopes)
			PART(strips)(in, q, 4, 1, in->strips / 2, 0.0, &rate, out);
		else if (in->strips % 2)
			PART(strips)(in, q, 1, 1, in->strips / 2, 0.0, &rate, out);
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
#undef AT_LEAST
#undef ABOVE
#undef WHERE
#undef WIDE
