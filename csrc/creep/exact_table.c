/* SPDX-License-Identifier: BSD-3-Clause */
/* Exact half-space theory of steady rolling from a table (derive/exact_contact), interpolated with slopes.
 *
 *   v = (u1, u2, k u3/C23)    k = 0.6 sqrt((C22^2 a/b + C11^2 b/a)/2)    s = v/(r0 + |v|), r0 = 3/2: |s| = 1 is full slip
 *   z = v (e + |v|)/(|v|^2 + (e + 1) |v| + f), e = 0.4, f = 3/2: the spline's coordinates, finer where slip spreads
 *   q = -(r0/3) (s1, s2 + s3 C23/k) + |s|^2 (Tx, Ty)    (h0, h1) = q (3 - 3 |q| + |q|^2) for |q| < 1, else q/|q|
 *   h2 = r0 (1 - |s|) (s2 C23/C22 - s3 C33/k) + |s|^2 sqrt((a/b + b/a)/2) Tm
 *
 * So slopes at zero are Kalker's and |(h0, h1)| <= 1, whatever the table holds; with T = 0 and |v| << r0 the force is that
 * of Shen, Hedrick and Elkins. T is a quadratic spline in z and in log(a/b), continuous with its slopes, and mirrored:
 * (-s1): Tx changes sign; (-s2, -s3): Ty and Tm do. Slopes of h are those of this interpolation. Outside the table's
 * a/b T is that of its end; Kalker's coefficients, k and the arm go on.
 *
 * Table: [z1][z2][a/b][z3][3] = Tx, Ty, Tm, and one number more at the end: three are read as four. The coefficient
 * before each plane z1 = 0, z3 = 0 is stored too.
 */
#include <stddef.h>

#include "../creep.h"

#define RADIUS 1.5
#define SPIN_SHARE 0.6
#define LINEAR 0.4
#define MIDDLE 1.5
#define TINY 1e-290 /* added to squares that divide */

#if defined(__GNUC__)
#define PARTS 4
typedef double part __attribute__((vector_size(8 * PARTS), may_alias));
typedef double stored __attribute__((vector_size(8 * PARTS), may_alias, aligned(8)));
#else
#define PARTS 1
typedef double part, stored;
#endif

typedef struct {
	rs_lane side, turn;              /* signs of u1 and u3 */
	rs_lane per;                     /* dv3/du3 */
	rs_lane v[3], along[3];          /* v; v/|v| */
	rs_lane shrink, square, growth;  /* 1/(r0 + |v|), |s|^2 and its slope with respect to |v| */
	rs_lane z[3], narrow, turned;    /* z; z/v; |v| times the slope of z/v with respect to |v| */
	rs_lane T[3], d[3][3];           /* values, and slopes with respect to v */
} point;

/* v, s and z, of creepages turned to u1 >= 0, u3 >= 0. */
RS_INLINE void locate(const rs_creep_input *in, point *p)
{
	rs_lane ratio = in->root * in->root, k, size, square;
	square = 0.5 * (in->c22 * in->c22 * ratio + in->c11 * in->c11 / ratio);
	RS_SQRT(k, square);
	p->per = SPIN_SHARE * k / in->c23;
	RS_EACH(l) {
		RS_AT(p->side, l) = copysign(1.0, RS_OF(in->u[0], l));
		RS_AT(p->turn, l) = copysign(1.0, RS_OF(in->u[2], l));
	}
	p->v[0] = p->side * in->u[0];
	p->v[1] = p->turn * in->u[1];
	p->v[2] = p->turn * p->per * in->u[2];
	square = p->v[0] * p->v[0] + p->v[1] * p->v[1] + p->v[2] * p->v[2] + TINY;
	RS_SQRT(size, square);
	p->shrink = 1.0 / (RADIUS + size);
	rs_lane rho = size * p->shrink, below = 1.0 / (square + (LINEAR + 1.0) * size + MIDDLE), inverse = 1.0 / size;
	p->square = rho * rho;
	p->growth = 2.0 * RADIUS * rho * p->shrink * p->shrink;
	p->narrow = (LINEAR + size) * below;
	p->turned = size * below * (1.0 - p->narrow * (2.0 * size + LINEAR + 1.0));
	for (int j = 0; j < 3; j++) {
		p->along[j] = p->v[j] * inverse;
		p->z[j] = p->v[j] * p->narrow;
	}
}

/* Weights of three coefficients, and their slopes with respect to z where pieces is the number of them a unit. */
RS_INLINE int weights(double at, int last, double pieces, double *w, double *d)
{
	int first = (int)at;
	first = first < last ? first : last;
	double t = at - first, r = 1.0 - t;
	w[0] = 0.5 * r * r;
	w[1] = 0.5 + t * r;
	w[2] = 0.5 * t * t;
	d[0] = -pieces * r;
	d[1] = pieces * (r - t);
	d[2] = pieces * t;
	return first;
}

/* T and its slopes at one contact. */
RS_INLINE void look_up(const rs_creep_table *table, int slopes, const double *place, double (*to)[4])
{
	int n = table->pieces, row = 3 * (n + 2), sheet = row * (table->ratio_pieces + 2), block = sheet * (2 * n + 2);
	double w[4][3], d[4][3];
	int i = weights(place[0], n - 1, n, w[0], d[0]), j = weights(place[1], 2 * n - 1, n, w[1], d[1]);
	int m = weights(place[2], n - 1, n, w[2], d[2]), r = weights(place[3], table->ratio_pieces - 1, 0.0, w[3], d[3]);
	const double *corner = table->coefficients + (size_t)i * block + (size_t)j * sheet + r * row + 3 * m;
	for (int c = 0; c < 3; c += PARTS) {
		part all = {0}, d1 = {0}, d2 = {0}, d3 = {0};
		for (int x = 0; x < 3; x++) {
			part over = {0}, over_2 = {0}, over_3 = {0};
			for (int y = 0; y < 3; y++) {
				const double *at = corner + x * block + y * sheet + c;
				part sum = {0}, slope = {0};
				for (int z = 0; z < 3; z++) {
					const stored *low = (const stored *)(at + 3 * z), *mid = (const stored *)(at + row + 3 * z);
					part a = w[3][0] * *low + w[3][1] * *mid + w[3][2] * *(const stored *)(at + 2 * row + 3 * z);
					sum += w[2][z] * a;
					slope += d[2][z] * a;
				}
				over += w[1][y] * sum;
				over_2 += d[1][y] * sum;
				over_3 += w[1][y] * slope;
			}
			all += w[0][x] * over;
			d1 += d[0][x] * over;
			d2 += w[0][x] * over_2;
			d3 += w[0][x] * over_3;
		}
		*(stored *)(to[0] + c) = all;
		if (!slopes)
			continue;
		*(stored *)(to[1] + c) = d1;
		*(stored *)(to[2] + c) = d2;
		*(stored *)(to[3] + c) = d3;
	}
}

RS_INLINE void interpolate(const rs_creep_table *table, int slopes, const rs_lane *root, point *p)
{
	int n = table->pieces;
	double stretch = table->ratio_pieces / log(table->largest / table->least), start = log(table->least);
	RS_EACH(l) {
		double found[4][4], at = stretch * (2.0 * log(RS_OF(*root, l)) - start);
		at = at > 0.0 ? at : 0.0;
		at = at < table->ratio_pieces ? at : table->ratio_pieces;
		double place[4] = {n * RS_OF(p->z[0], l), n * (1.0 + RS_OF(p->z[1], l)), n * RS_OF(p->z[2], l), at};
		look_up(table, slopes, place, found);
		for (int i = 0; i < 3; i++) {
			RS_AT(p->T[i], l) = found[0][i];
			for (int j = 0; slopes && j < 3; j++)
				RS_AT(p->d[i][j], l) = found[1 + j][i];
		}
	}
	for (int i = 0; slopes && i < 3; i++) {
		rs_lane radial = p->turned * (p->d[i][0] * p->along[0] + p->d[i][1] * p->along[1] + p->d[i][2] * p->along[2]);
		for (int j = 0; j < 3; j++)
			p->d[i][j] = p->narrow * p->d[i][j] + radial * p->along[j];
	}
}

/* Slopes with respect to u from those with respect to v, of a component with its sign. */
RS_INLINE void chain(const point *p, const rs_lane *d, const rs_lane *sign, rs_lane *to)
{
	to[0] = *sign * p->side * d[0];
	to[1] = *sign * p->turn * d[1];
	to[2] = *sign * p->turn * p->per * d[2];
}

/* h0, h1 from q; d: dq/dv on entry, dh/dv on return. */
RS_INLINE void saturate(int slopes, const rs_lane *q, rs_lane *h, rs_lane (*d)[3])
{
	rs_lane x = q[0], y = q[1], square = x * x + y * y + TINY, size, R, slope_over_size;
	RS_SQRT(size, square);
	RS_EACH(l) {
		double z = RS_OF(size, l), inverse = 1.0 / z;
		RS_AT(R, l) = z < 1.0 ? 3.0 - 3.0 * z + z * z : inverse;
		RS_AT(slope_over_size, l) = z < 1.0 ? 2.0 - 3.0 * inverse : -inverse * inverse * inverse;
	}
	h[0] = R * x;
	h[1] = R * y;
	for (int j = 0; slopes && j < 3; j++) {
		rs_lane along = slope_over_size * (x * d[0][j] + y * d[1][j]);
		d[0][j] = R * d[0][j] + along * x;
		d[1][j] = R * d[1][j] + along * y;
	}
}

RS_INLINE void evaluate(const rs_creep_input *in, int slopes, rs_creep_value *out)
{
	point p;
	rs_lane d[3][3], h[2];
	locate(in, &p);
	interpolate(in->table, slopes, &in->root, &p);
	rs_lane per = 1.0 / p.per, ratio = in->root * in->root, size = 0.5 * (ratio + 1.0 / ratio), arm;
	RS_SQRT(arm, size);
	rs_lane of_lateral = in->c23 / in->c22, of_spin = -in->c33 / in->c23 * per;
	rs_lane share = -RADIUS / 3 * p.shrink, fade = RADIUS * RADIUS * p.shrink * p.shrink;
	rs_lane lateral = p.v[1] + per * p.v[2], moment = fade * (of_lateral * p.v[1] + of_spin * p.v[2]);
	rs_lane q[2] = {share * p.v[0] + p.square * p.T[0], share * lateral + p.square * p.T[1]};
	for (int j = 0; slopes && j < 3; j++) {
		rs_lane back = p.shrink * p.along[j];
		for (int i = 0; i < 3; i++)
			d[i][j] = p.growth * p.along[j] * p.T[i] + p.square * p.d[i][j];
		d[0][j] -= share * p.v[0] * back;
		d[1][j] -= share * lateral * back;
		d[2][j] = arm * d[2][j] - 2.0 * moment * back;
	}
	if (slopes) {
		d[0][0] += share;
		d[1][1] += share;
		d[1][2] += share * per;
		d[2][1] += fade * of_lateral;
		d[2][2] += fade * of_spin;
	}
	saturate(slopes, q, h, d);
	out->h[0] = p.side * h[0];
	out->h[1] = p.turn * h[1];
	out->h[2] = p.turn * (moment + p.square * arm * p.T[2]);
	if (!slopes)
		return;
	chain(&p, d[0], &p.side, out->d[0]);
	chain(&p, d[1], &p.turn, out->d[1]);
	chain(&p, d[2], &p.turn, out->d[2]);
}

RS_CLONES void rs_creep_exact_table(const rs_creep_input *in, int slopes, rs_creep_value *out)
{
	if (slopes)
		evaluate(in, 1, out);
	else
		evaluate(in, 0, out);
}
