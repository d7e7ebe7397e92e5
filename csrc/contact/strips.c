/* SPDX-License-Identifier: BSD-3-Clause */
/* Elastic contact of two bodies whose gap is A x^2 along the track and any function across it.
 *
 * The patch is RS_STRIPS strips of width w along x. Strip j has the half length a_j and carries the pressure
 * p0_j sqrt(1 - x^2/a_j^2) with p0_j = k a_j, as every strip of a Hertzian ellipse does with
 *
 *   k = 3 E' A (a/b) / R_D(0, (b/a)^2, 1)      (a, b: ellipse of the largest a_j and the area of the patch)       (1)
 *
 * On the line x = 0 the bodies touch where there is pressure (influence.c),
 *
 *   sum over j of k/(pi E') [H((s_i - s_j + w/2)/a_j) - H((s_i - s_j - w/2)/a_j)] a_j^2 = u_i   where a_i > 0     (2)
 *                                                                                        >= u_i  elsewhere
 *
 * Newton's iteration over z_j = a_j^2, which the arguments of H move too: with v = face/a_j, H - v H'/2 in place of H and
 *
 *   sum over j of k/(pi E') [H - v H'/2] z_j = u_i - sum over j of k/(pi E') [v H'/2] a_j^2                       (3)
 *
 * with the a_j of the round before on the right; k is taken along. Exact for Hertz as w -> 0. For other patches the assumption is that of strips of elliptic pressure with one k (K. Knothe, Le The Hung,
 * Proc. ISMES 1984, relaxed; W. Kik, J. Piotrowski 1996 assume the shape of the patch as well).
 */
#include <math.h>
#include <string.h>

#include "../dispatch.h"
#include "../railsym.h"
#include "strips.h"

#define PI 3.14159265358979323846
#define LEAST_LENGTH 0.1    /* of the width: H of shorter strips is that of this one (their load is negligible) */
#define TOLERANCE 1e-2      /* on a_j, of the longest, in the last round; rounds square the error */
#define SLACK 1e-4          /* of the largest u: overlap that adds a strip to the contact */
#define RELAXED 1e-6        /* on a_j^2, of the largest */
enum { FULL_ROUNDS = 15, MOST_ROUNDS = 60, MOST_SETS = 12, MOST_SWEEPS = 2000 };

typedef struct {
	double m[RS_STRIPS][RS_STRIPS];
	double u[RS_STRIPS];
	double z[RS_STRIPS];
	int active[RS_STRIPS];
} workspace;

/* Equation (1). */
static RS_ALWAYS_INLINE double pressure_gradient(const rs_strip_patch *p)
{
	double longest = 0.0, sum = 0.0;
	for (int j = 0; j < RS_STRIPS; j++) {
		longest = p->a[j] > longest ? p->a[j] : longest;
		sum += p->a[j];
	}
	double ratio = 2.0 * sum * p->width / (PI * longest) / longest; /* b/a */
	return 3.0 * p->modulus * p->curvature / (ratio * rs_elliptic_rd(ratio * ratio, 1.0));
}

/* One column of the matrix of (3), and its share in the right-hand side; strips of one run lie at multiples of their width, so
 * their faces are shared. */
static RS_ALWAYS_INLINE void fill_column(const rs_influence *table, const rs_strip_patch *p, int j, double factor, workspace *w)
{
	double length = p->a[j] > LEAST_LENGTH * p->width ? p->a[j] : LEAST_LENGTH * p->width, inverse = 1.0 / length;
	double half = 0.5 * p->width, square = p->a[j] * p->a[j], above, below;
	if (!p->together) {
		for (int i = 0; i < RS_STRIPS; i++) {
			double away = p->s[i] - p->s[j];
			double faces = rs_influence_at(table, (away + half) * inverse, &above) - rs_influence_at(table, (away - half) * inverse, &below);
			w->m[i][j] = factor * (faces - above + below);
			w->u[i] -= factor * (above - below) * square;
		}
		return;
	}
	int far = j > RS_STRIPS - 1 - j ? j : RS_STRIPS - 1 - j;
	double value[RS_STRIPS], turned[RS_STRIPS], before = 0.0, turned_before = 0.0;
	for (int k = 0; k <= far; k++) {
		double face = rs_influence_at(table, (k * p->width + half) * inverse, &above);
		value[k] = factor * (face - before - above + turned_before);
		turned[k] = factor * (above - turned_before) * square;
		before = face;
		turned_before = above;
	}
	value[0] *= 2.0;
	turned[0] *= 2.0;
	for (int i = 0; i < RS_STRIPS; i++) {
		int k = i > j ? i - j : j - i;
		w->m[i][j] = value[k];
		w->u[i] -= turned[k];
	}
}

static RS_ALWAYS_INLINE void fill(const rs_influence *table, const rs_strip_patch *p, workspace *w)
{
	double factor = p->gradient / (PI * p->modulus);
	memcpy(w->u, p->u, sizeof w->u);
	for (int j = 0; j < RS_STRIPS; j++)
		fill_column(table, p, j, factor, w);
}

/* z of the active strips, by elimination; the diagonal is the largest of its row. Rows are taken whole, zeros and all: two
 * vectors each. */
static RS_ALWAYS_INLINE void solve_active(const double (*m)[RS_STRIPS], const double *u, const int *active, double *z)
{
	double lu[RS_STRIPS][RS_STRIPS] = {{0.0}}, right[RS_STRIPS];
	int index[RS_STRIPS], n = 0;
	for (int i = 0; i < RS_STRIPS; i++) {
		z[i] = 0.0;
		if (active[i])
			index[n++] = i;
	}
	for (int i = 0; i < n; i++) {
		for (int j = 0; j < n; j++)
			lu[i][j] = m[index[i]][index[j]];
		right[i] = u[index[i]];
	}
	for (int k = 0; k < n; k++) {
		double inverse = 1.0 / lu[k][k];
		for (int i = k + 1; i < n; i++) {
			double factor = lu[i][k] * inverse;
			for (int j = 0; j < RS_STRIPS; j++)
				lu[i][j] -= factor * lu[k][j];
			right[i] -= factor * right[k];
		}
	}
	for (int i = n - 1; i >= 0; i--) {
		double sum = right[i];
		for (int j = i + 1; j < n; j++)
			sum -= lu[i][j] * z[index[j]];
		z[index[i]] = sum / lu[i][i];
	}
}

/* Strips that pull leave the contact; those that overlap without pressure come back. 0 when nothing changed. */
static RS_ALWAYS_INLINE int revise(workspace *w, double slack)
{
	int changed = 0;
	for (int i = 0; i < RS_STRIPS; i++)
		if (w->active[i] && w->z[i] < 0.0) {
			w->active[i] = 0;
			changed = 1;
		}
	for (int i = 0; !changed && i < RS_STRIPS; i++) {
		if (w->active[i])
			continue;
		double deflection = 0.0;
		for (int j = 0; j < RS_STRIPS; j++)
			deflection += w->m[i][j] * w->z[j];
		if (w->u[i] - deflection > slack)
			w->active[i] = changed = 1;
	}
	return changed;
}

/* Contact that goes round in circles, as at an edge of a profile: strip by strip, each pressed until it touches. */
static int relax(workspace *w)
{
	for (int sweep = 0; sweep < MOST_SWEEPS; sweep++) {
		double change = 0.0, largest = 0.0;
		for (int i = 0; i < RS_STRIPS; i++) {
			double left = w->u[i];
			for (int j = 0; j < RS_STRIPS; j++)
				left -= w->m[i][j] * w->z[j];
			double z = fmax(w->z[i] + left / w->m[i][i], 0.0);
			change = fmax(change, fabs(z - w->z[i]));
			largest = fmax(largest, z);
			w->z[i] = z;
		}
		if (change < RELAXED * largest)
			return RS_OK;
	}
	return RS_NOT_CONVERGED;
}

static RS_ALWAYS_INLINE int solve_contact(const rs_strip_patch *p, workspace *w)
{
	double largest = 0.0;
	for (int i = 0; i < RS_STRIPS; i++)
		largest = p->u[i] > largest ? p->u[i] : largest;
	for (int set = 0; set < MOST_SETS; set++) {
		solve_active((const double (*)[RS_STRIPS])w->m, w->u, w->active, w->z);
		if (!revise(w, SLACK * largest))
			return RS_OK;
	}
	for (int i = 0; i < RS_STRIPS; i++)
		w->z[i] = p->a[i] * p->a[i];
	int status = relax(w);
	for (int i = 0; i < RS_STRIPS; i++)
		w->active[i] = w->z[i] > 0.0;
	return status;
}

/* With k of the lengths found in place of that of the guess all of them would be longer or shorter: load grows about as k a^(3/2),
 * and k as a^(3/4). */
static RS_ALWAYS_INLINE double rescale(const rs_strip_patch *p)
{
	return pow(p->gradient / pressure_gradient(p), 0.45);
}

/* One round: lengths from (3), a share of the way to them; the largest change, over the longest. Negative: none are found. */
static RS_ALWAYS_INLINE double improve(const rs_influence *table, rs_strip_patch *p, workspace *w, double share)
{
	double before[RS_STRIPS], largest = 0.0, longest = 0.0;
	p->gradient = pressure_gradient(p);
	fill(table, p, w);
	if (solve_contact(p, w) != RS_OK)
		return -1.0;
	memcpy(before, p->a, sizeof before);
	for (int i = 0; i < RS_STRIPS; i++) {
		p->a[i] = w->z[i] > 0.0 ? sqrt(w->z[i]) : 0.0;
		longest = fmax(longest, p->a[i]);
	}
	if (!(longest > 0.0))
		return -1.0;
	double scale = rescale(p);
	for (int i = 0; i < RS_STRIPS; i++) {
		p->a[i] = before[i] + share * (scale * p->a[i] - before[i]);
		largest = fmax(largest, fabs(p->a[i] - before[i]));
	}
	return largest / longest;
}

RS_CLONES int rs_strip_contact(const rs_influence *table, rs_strip_patch *p)
{
	workspace w;
	for (int i = 0; i < RS_STRIPS; i++)
		w.active[i] = p->u[i] > 0.0;
	for (int round = 0; round < MOST_ROUNDS; round++) {
		double change = improve(table, p, &w, round < FULL_ROUNDS ? 1.0 : 0.5);
		if (change < 0.0)
			return RS_NOT_CONVERGED;
		if (change < TOLERANCE)
			return RS_OK;
	}
	return RS_NOT_CONVERGED;
}
