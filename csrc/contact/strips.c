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
 * (2) is linear in a_j^2 but for the arguments of H, which hardly move: solve, put in the new a_j, repeat. Exact for Hertz
 * as w -> 0. For other patches the assumption is that of strips of elliptic pressure with one k (K. Knothe, Le The Hung,
 * Proc. ISMES 1984, relaxed; W. Kik, J. Piotrowski 1996 assume the shape of the patch as well).
 */
#include <math.h>

#include "../dispatch.h"
#include "../railsym.h"
#include "strips.h"

#define PI 3.14159265358979323846
#define LEAST_LENGTH 0.1    /* of the width: H of shorter strips is that of this one (their load is negligible) */
#define TOLERANCE 1e-3      /* on a_j, of the largest */
#define SLACK 1e-4          /* of the largest u: overlap that adds a strip to the contact */
#define RELAXED 1e-6        /* on a_j^2, of the largest */
enum { FULL_ROUNDS = 15, MOST_ROUNDS = 60, MOST_SETS = 12, MOST_SWEEPS = 2000 };

typedef struct {
	double m[RS_STRIPS][RS_STRIPS];
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

/* One column of the matrix of (2); strips of one run lie at multiples of their width, so their faces are shared. */
static void fill_column(const rs_influence *table, const rs_strip_patch *p, int j, double factor, workspace *w)
{
	double length = p->a[j] > LEAST_LENGTH * p->width ? p->a[j] : LEAST_LENGTH * p->width, inverse = 1.0 / length;
	double half = 0.5 * p->width;
	if (!p->together) {
		for (int i = 0; i < RS_STRIPS; i++) {
			double away = p->s[i] - p->s[j];
			w->m[i][j] = factor * (rs_influence_at(table, (away + half) * inverse) - rs_influence_at(table, (away - half) * inverse));
		}
		return;
	}
	int far = j > RS_STRIPS - 1 - j ? j : RS_STRIPS - 1 - j;
	double value[RS_STRIPS], before = 0.0;
	for (int k = 0; k <= far; k++) {
		double face = rs_influence_at(table, (k * p->width + half) * inverse);
		value[k] = factor * (face - before);
		before = face;
	}
	value[0] *= 2.0;
	for (int i = 0; i < RS_STRIPS; i++)
		w->m[i][j] = value[i > j ? i - j : j - i];
}

static void fill(const rs_influence *table, const rs_strip_patch *p, workspace *w)
{
	double factor = p->gradient / (PI * p->modulus);
	for (int j = 0; j < RS_STRIPS; j++)
		fill_column(table, p, j, factor, w);
}

/* z of the active strips, by elimination; the diagonal is the largest of its row. */
static RS_ALWAYS_INLINE void solve_active(const double (*m)[RS_STRIPS], const double *u, const int *active, double *z)
{
	double lu[RS_STRIPS][RS_STRIPS + 1];
	int index[RS_STRIPS], n = 0;
	for (int i = 0; i < RS_STRIPS; i++) {
		z[i] = 0.0;
		if (active[i])
			index[n++] = i;
	}
	for (int i = 0; i < n; i++) {
		for (int j = 0; j < n; j++)
			lu[i][j] = m[index[i]][index[j]];
		lu[i][n] = u[index[i]];
	}
	for (int k = 0; k < n; k++)
		for (int i = k + 1; i < n; i++) {
			double factor = lu[i][k] / lu[k][k];
			for (int j = k + 1; j <= n; j++)
				lu[i][j] -= factor * lu[k][j];
		}
	for (int i = n - 1; i >= 0; i--) {
		double sum = lu[i][n];
		for (int j = i + 1; j < n; j++)
			sum -= lu[i][j] * z[index[j]];
		z[index[i]] = sum / lu[i][i];
	}
}

/* Strips that pull leave the contact; those that overlap without pressure come back. 0 when nothing changed. */
static RS_ALWAYS_INLINE int revise(const rs_strip_patch *p, workspace *w, double slack)
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
		if (p->u[i] - deflection > slack)
			w->active[i] = changed = 1;
	}
	return changed;
}

/* Contact that goes round in circles, as at an edge of a profile: strip by strip, each pressed until it touches. */
static int relax(const rs_strip_patch *p, workspace *w)
{
	for (int sweep = 0; sweep < MOST_SWEEPS; sweep++) {
		double change = 0.0, largest = 0.0;
		for (int i = 0; i < RS_STRIPS; i++) {
			double left = p->u[i];
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
		solve_active((const double (*)[RS_STRIPS])w->m, p->u, w->active, w->z);
		if (!revise(p, w, SLACK * largest))
			return RS_OK;
	}
	for (int i = 0; i < RS_STRIPS; i++)
		w->z[i] = p->a[i] * p->a[i];
	int status = relax(p, w);
	for (int i = 0; i < RS_STRIPS; i++)
		w->active[i] = w->z[i] > 0.0;
	return status;
}

RS_CLONES int rs_strip_contact(const rs_influence *table, rs_strip_patch *p)
{
	workspace w;
	for (int i = 0; i < RS_STRIPS; i++)
		w.active[i] = p->u[i] > 0.0;
	for (int round = 0; round < MOST_ROUNDS; round++) {
		double change = 0.0, longest = 0.0;
		p->gradient = pressure_gradient(p);
		fill(table, p, &w);
		if (solve_contact(p, &w) != RS_OK)
			return RS_NOT_CONVERGED;
		for (int i = 0; i < RS_STRIPS; i++) {
			double a = w.z[i] > 0.0 ? sqrt(w.z[i]) : 0.0;
			change = fmax(change, fabs(a - p->a[i]));
			longest = fmax(longest, a);
			p->a[i] = round < FULL_ROUNDS ? a : 0.5 * (p->a[i] + a);
		}
		if (!(longest > 0.0))
			return RS_NOT_CONVERGED;
		if (change < TOLERANCE * longest)
			return RS_OK;
	}
	return RS_NOT_CONVERGED;
}
