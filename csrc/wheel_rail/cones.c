/* SPDX-License-Identifier: BSD-3-Clause */
/* Cones on round rails, in closed form: a contact that takes the place of a table.
 *
 * A zone of the wheel is a cone of slope lam, radius R at b0 along the axle; its rail is a circle of radius Rr, a prism along
 * ex. Right-hand wheel; D = rail's centre - wheelset's centre, axle a, e = ex x a, m = a ex, k^2 = 1 - m^2, tan g = lam.
 * The rail's line of centres is eta along the axle and rho from it, and the least distance from the cone is at
 *
 *   h = D e/k    eps = lam m/k    rho = h/sqrt(1 - eps^2)    t = -eps rho/k    eta = D a/k^2 + m t    x = m D a/k^2 + t
 *   S = cos g [h sqrt(1 - eps^2) + lam (D a/k^2 - b0) - R]        penetration p = Rr - S
 *   n = cos g [(h e/k + k t (ex - m a)/k)/rho + lam a], square to ex
 *
 * Load = stiffness p^(3/2), semi-axes = (a, b) sqrt(p); the contact is the point of the wheel nearest to the rail. The load
 * has the potential 2/5 stiffness p^(5/2). Values carry their four slopes along (forward differentiation).
 */
#include <math.h>
#include <string.h>

#include "motion.h"

typedef struct {
	double v[5];  /* value, slopes over y roll drop yaw */
} jet;

static jet constant(double value)
{
	jet to = {{value}};
	return to;
}

static jet variable(const double *place, int number)
{
	jet to = constant(place[number]);
	to.v[1 + number] = 1.0;
	return to;
}

/* f(x) from its value and slope. */
static jet of(jet x, double value, double slope)
{
	jet to = {{value}};
	for (int i = 1; i < 5; i++)
		to.v[i] = slope * x.v[i];
	return to;
}

/* p x + q y */
static jet mix(double p, jet x, double q, jet y)
{
	jet to;
	for (int i = 0; i < 5; i++)
		to.v[i] = p * x.v[i] + q * y.v[i];
	return to;
}

static jet add(jet x, jet y)
{
	return mix(1.0, x, 1.0, y);
}

static jet mul(jet x, jet y)
{
	jet to = {{x.v[0] * y.v[0]}};
	for (int i = 1; i < 5; i++)
		to.v[i] = x.v[0] * y.v[i] + x.v[i] * y.v[0];
	return to;
}

static jet scale(double p, jet x)
{
	return mix(p, x, 0.0, x);
}

static jet quotient(jet x, jet y)
{
	return mul(x, of(y, 1.0 / y.v[0], -1.0 / (y.v[0] * y.v[0])));
}

static jet root(jet x)
{
	double value = sqrt(x.v[0]);
	return of(x, value, 0.5 / value);
}

static jet product(const jet *x, const jet *y)
{
	return add(add(mul(x[0], y[0]), mul(x[1], y[1])), mul(x[2], y[2]));
}

/* Forward, axle, down of the wheel in the rail's axes, and the wheelset's centre. */
typedef struct {
	jet f[3], a[3], d[3], y, z;
} wheel_axes;

static void axes_of(const rs_contact_cones *shape, const double *place, wheel_axes *to)
{
	jet roll = variable(place, 1), yaw = variable(place, 3);
	jet sr = of(roll, sin(place[1]), cos(place[1])), cr = of(roll, cos(place[1]), -sin(place[1]));
	jet sy = of(yaw, sin(place[3]), cos(place[3])), cy = of(yaw, cos(place[3]), -sin(place[3]));
	to->f[0] = cy;
	to->f[1] = sy;
	to->f[2] = constant(0.0);
	to->a[0] = scale(-1.0, mul(sy, cr));
	to->a[1] = mul(cy, cr);
	to->a[2] = sr;
	to->d[0] = mul(sy, sr);
	to->d[1] = scale(-1.0, mul(cy, sr));
	to->d[2] = cr;
	to->y = variable(place, 0);
	to->z = add(variable(place, 2), constant(-shape->r0));
}

static void fill(const rs_cone *cone, const wheel_axes *w, const jet *n, jet x, jet dy, jet dz, jet S, jet p, rs_patch *to)
{
	jet size = root(p), arm[3];
	arm[0] = x;
	arm[1] = add(dy, scale(-1.0, mul(S, n[1])));
	arm[2] = add(dz, scale(-1.0, mul(S, n[2])));
	jet rows[] = {scale(cone->stiffness, mul(p, size)), product(arm, w->f), product(arm, w->a), product(arm, w->d),
	              of(n[1], atan2(n[1].v[0], n[2].v[0]), 1.0 / n[2].v[0]), scale(cone->a, size), scale(cone->b, size)};
	memcpy(to->load, rows, sizeof rows);
}

/* Penetration, and where it is positive the patch. */
static double touch(const rs_cone *cone, const wheel_axes *w, rs_patch *to)
{
	double lam = cone->slope, cosine = 1.0 / sqrt(1.0 + lam * lam);
	jet dy = add(constant(cone->rail_y), scale(-1.0, w->y)), dz = add(constant(cone->rail_z), scale(-1.0, w->z));
	jet m = w->a[0], k2 = add(constant(1.0), scale(-1.0, mul(m, m))), k = root(k2);
	jet height = quotient(add(mul(dz, w->a[1]), scale(-1.0, mul(dy, w->a[2]))), k);
	jet along = quotient(add(mul(dy, w->a[1]), mul(dz, w->a[2])), k2);
	jet eps = scale(lam, quotient(m, k)), rest = root(add(constant(1.0), scale(-1.0, mul(eps, eps))));
	jet rho = quotient(height, rest), t = scale(-1.0, quotient(mul(eps, rho), k));
	jet S = scale(cosine, add(mul(height, rest), add(scale(lam, along), constant(-lam * cone->b0 - cone->radius))));
	jet p = add(constant(cone->rail_radius), scale(-1.0, S));
	if (!(p.v[0] > 0.0))
		return p.v[0];
	jet up = quotient(height, mul(rho, k)), forth = scale(-1.0, quotient(mul(t, m), rho)), n[3];
	n[0] = constant(0.0);
	n[1] = scale(cosine, add(add(scale(-1.0, mul(up, w->a[2])), mul(forth, w->a[1])), scale(lam, w->a[1])));
	n[2] = scale(cosine, add(add(mul(up, w->a[1]), mul(forth, w->a[2])), scale(lam, w->a[2])));
	fill(cone, w, n, add(mul(m, along), t), dy, dz, S, p, to);
	return p.v[0];
}

int rs_contact_cones_lookup(const rs_contact_table *shape, const double *place, rs_patch *patch, int *count, int *beyond)
{
	const rs_contact_cones *cones = (const rs_contact_cones *)shape;
	wheel_axes w;
	*count = 0;
	for (int k = 0; k < 2; k++)
		if (!(fabs(place[k]) <= cones->limit[k])) {
			*beyond = k;
			return RS_OUT_OF_TABLE;
		}
	axes_of(cones, place, &w);
	for (int zone = 0; zone < cones->cones; zone++) {
		double penetration = touch(&cones->cone[zone], &w, &patch[*count]);
		if (!(penetration <= cones->limit[2])) {
			*beyond = 2;
			return RS_OUT_OF_TABLE;
		}
		if (penetration > 0.0)
			patch[(*count)++].zone = zone;
	}
	return RS_OK;
}
