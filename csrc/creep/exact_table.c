/* SPDX-License-Identifier: BSD-3-Clause */
/* Exact half-space theory of steady rolling from a table (derive/exact_contact), interpolated with slopes.
 *
 *   v = (u1, u2, k u3/C23)    k = 0.6 sqrt((C22^2 a/b + C11^2 b/a)/2)    s = v/(r0 + |v|), r0 = 3/2: |s| = 1 is full slip
 *   q = -(r0/3) (s1, s2 + s3 C23/k) + |s|^2 (Tx, Ty)    (h0, h1) = q (3 - 3 |q| + |q|^2) for |q| < 1, else q/|q|
 *   h2 = r0 (1 - |s|) (s2 C23/C22 - s3 C33/k) + |s|^2 sqrt((a/b + b/a)/2) Tm
 *
 * So slopes at zero are Kalker's and |(h0, h1)| <= 1, whatever the table holds; with T = 0 and |v| << r0 the force is that
 * of Shen, Hedrick and Elkins. T is a quadratic spline in s and in log(a/b), continuous with its slopes, and mirrored:
 * (-s1): Tx changes sign; (-s2, -s3): Ty and Tm do. Slopes of h are those of this interpolation. Outside the table's
 * a/b T is that of its end; Kalker's coefficients, k and the arm go on.
 *
 * Table: [s1][s2][a/b][s3][3] = Tx, Ty, Tm, and one number more at the end: three are read as four. The coefficient
 * before each plane s1 = 0, s3 = 0 is stored too.
 */
#include <stddef.h>

#include "../creep.h"

#define RADIUS 1.5
#define SPIN_SHARE 0.6
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
	rs_lane s[3], along[3];          /* s; v/|v| */
	rs_lane shrink, rho, square;     /* 1/(r0 + |v|), |s|, |s|^2 */
	rs_lane place[4];                /* in pieces of the spline: s1 s2 s3 log(a/b) */
	rs_lane T[3], d[3][3];           /* values, and slopes with respect to s */
} point;

/* v and s, of creepages turned to u1 >= 0, u3 >= 0. */
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
	rs_lane v[3] = {p->side * in->u[0], p->turn * in->u[1], p->turn * p->per * in->u[2]};
	square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + TINY;
	RS_SQRT(size, square);
	p->shrink = 1.0 / (RADIUS + size);
	p->rho = size * p->shrink;
	p->square = p->rho * p->rho;
	for (int j = 0; j < 3; j++) {
		p->along[j] = v[j] / size;
		p->s[j] = v[j] * p->shrink;
	}
}

/* Weights of three coefficients, and their slopes with respect to s where pieces is the number of them a unit. */
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
		*(part *)(to[0] + c) = all;
		if (!slopes)
			continue;
		*(part *)(to[1] + c) = d1;
		*(part *)(to[2] + c) = d2;
		*(part *)(to[3] + c) = d3;
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
		double place[4] = {n * RS_OF(p->s[0], l), n * (1.0 + RS_OF(p->s[1], l)), n * RS_OF(p->s[2], l), at};
		look_up(table, slopes, place, found);
		for (int i = 0; i < 3; i++) {
			RS_AT(p->T[i], l) = found[0][i];
			for (int j = 0; slopes && j < 3; j++)
				RS_AT(p->d[i][j], l) = found[1 + j][i];
		}
	}
}

/* Slopes with respect to u from those with respect to s, of component i; sign: of that component. */
RS_INLINE void chain(const point *p, const rs_lane *d, const rs_lane *sign, rs_lane *to)
{
	rs_lane radial = d[0] * p->s[0] + d[1] * p->s[1] + d[2] * p->s[2], turned = *sign * p->shrink;
	to[0] = turned * p->side * (d[0] - radial * p->along[0]);
	to[1] = turned * p->turn * (d[1] - radial * p->along[1]);
	to[2] = turned * p->turn * p->per * (d[2] - radial * p->along[2]);
}

/* h0, h1 from q; d: dq/ds on entry of x and y, dh/ds on return. */
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
	rs_lane of_lateral = in->c23 / in->c22, of_spin = -in->c33 / in->c23 * per, left = 1.0 - p.rho;
	rs_lane q[2] = {-RADIUS / 3 * p.s[0] + p.square * p.T[0], -RADIUS / 3 * (p.s[1] + per * p.s[2]) + p.square * p.T[1]};
	rs_lane linear = RADIUS * (of_lateral * p.s[1] + of_spin * p.s[2]);
	for (int j = 0; slopes && j < 3; j++) {
		for (int i = 0; i < 3; i++)
			d[i][j] = 2.0 * p.s[j] * p.T[i] + p.square * p.d[i][j];
		d[2][j] = arm * d[2][j] - linear * p.along[j];
	}
	if (slopes) {
		d[0][0] -= RADIUS / 3;
		d[1][1] -= RADIUS / 3;
		d[1][2] -= RADIUS / 3 * per;
		d[2][1] += RADIUS * left * of_lateral;
		d[2][2] += RADIUS * left * of_spin;
	}
	saturate(slopes, q, h, d);
	out->h[0] = p.side * h[0];
	out->h[1] = p.turn * h[1];
	out->h[2] = p.turn * (left * linear + p.square * arm * p.T[2]);
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
