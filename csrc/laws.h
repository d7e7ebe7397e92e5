/* SPDX-License-Identifier: BSD-3-Clause */
/* Scalar force laws of line and axis elements, for real lanes and for a complex number.
 *
 *   spring and damper   f = f0 + k e + K(e) + c v + C(v)
 *   Maxwell             f = f0 + k (e - s),  0 = c w + C(w) - k (e - s),  k = k0 + K(|v|)
 *   bump stop           f = f0 + sign(e) [k d + K(d)],  d = |e| - gap > 0
 *   actuator, force     f = F sat((c v - d)/F)               (positive command pushes the ends apart)
 *   actuator, length    f = F sat((f0 + k (e - d) + c v)/F)
 *       d = command, or with a lag T the state s that follows it: 0 = z T (w - R sat((command - s)/(T R))), z = k or 1
 *       stuck: 0 = z T w; free: f = 0; damped: f = F sat(c_bypass v/F)
 *
 * e elongation, v its rate, s elongation of the Maxwell damper, w = ds/dt; K and C are
 * monotone cubic tables, optional. A positive f pulls the two ends together. sat(x) = x up to 0.8, then
 * 0.8 + 0.2 tanh((x - 0.8)/0.2) and likewise below: smooth to its second derivative, never beyond 1.
 */
#include "lanes.h"

typedef struct {
	rs_scalar f, g;                     /* force; state residual */
	rs_scalar f_e, f_v, f_s, f_w;       /* slopes of f */
	rs_scalar g_e, g_v, g_s, g_w;       /* slopes of g */
} RS_NAME(law_value);

/* Value and slope of a table: cubic inside, straight on beyond its ends. */
static void RS_NAME(curve)(const rs_curve *curve, rs_scalar x, rs_scalar *value, rs_scalar *slope)
{
	if (!curve) {
		*value = *slope = 0.0;
		return;
	}
	int last = curve->n - 2, piece = 0;
	while (piece < last && RS_REAL(x) >= curve->x[piece + 1])
		piece++;
	const double *c = curve->c + 4 * piece;
	double width = curve->x[curve->n - 1] - curve->x[curve->n - 2];
	rs_scalar t = x - curve->x[piece];
	int below = RS_REAL(x) < curve->x[0], above = RS_REAL(x) > curve->x[curve->n - 1];
	double at = above ? width : 0.0;
	rs_scalar t0 = below || above ? at : t;
	*slope = c[1] + t0 * (2.0 * c[2] + 3.0 * t0 * c[3]);
	*value = c[0] + t0 * (c[1] + t0 * (c[2] + t0 * c[3])) + (t - t0) * *slope;
}

static void RS_NAME(spring_damper)(const rs_law *law, rs_scalar e, rs_scalar v, RS_NAME(law_value) *out)
{
	rs_scalar spring, spring_slope, damper, damper_slope;
	RS_NAME(curve)(law->stiffness_curve, e, &spring, &spring_slope);
	RS_NAME(curve)(law->damping_curve, v, &damper, &damper_slope);
	out->f = law->preload + law->stiffness * e + spring + law->damping * v + damper;
	out->f_e = law->stiffness + spring_slope;
	out->f_v = law->damping + damper_slope;
}

static void RS_NAME(maxwell)(const rs_law *law, rs_scalar e, rs_scalar v, rs_scalar s, rs_scalar w,
                             RS_NAME(law_value) *out)
{
	rs_scalar extra, extra_slope, damper, damper_slope;
	double sign = RS_REAL(v) < 0.0 ? -1.0 : 1.0;
	RS_NAME(curve)(law->stiffness_curve, sign * v, &extra, &extra_slope);
	RS_NAME(curve)(law->damping_curve, w, &damper, &damper_slope);
	rs_scalar k = law->stiffness + extra, spring = k * (e - s);
	out->f = law->preload + spring;
	out->f_e = k;
	out->f_v = sign * extra_slope * (e - s);
	out->f_s = -k;
	out->g = law->damping * w + damper - spring;
	out->g_e = -k;
	out->g_v = -out->f_v;
	out->g_s = k;
	out->g_w = law->damping + damper_slope;
}

static void RS_NAME(bump_stop)(const rs_law *law, rs_scalar e, RS_NAME(law_value) *out)
{
	double sign = RS_REAL(e) < 0.0 ? -1.0 : 1.0;
	rs_scalar depth = sign * e - law->clearance, curve, slope;
	out->f = law->preload;
	if (RS_REAL(depth) <= 0.0)
		return;
	RS_NAME(curve)(law->stiffness_curve, depth, &curve, &slope);
	out->f += sign * (law->stiffness * depth + curve);
	out->f_e = law->stiffness + slope;
}

/* F sat(x/F) and its slope; F = 0: no limit. */
static rs_scalar RS_NAME(limited)(rs_scalar x, double limit, rs_scalar *slope)
{
	const double linear = 0.8, rest = 1.0 - linear;
	double sign = RS_REAL(x) < 0.0 ? -1.0 : 1.0;
	*slope = 1.0;
	if (!(limit > 0.0) || sign * RS_REAL(x) <= linear * limit)
		return x;
	rs_scalar bend = RS_TANH((sign * x / limit - linear) / rest);
	*slope = 1.0 - bend * bend;
	return sign * limit * (linear + rest * bend);
}

/* The state with which an actuator follows its command. */
static void RS_NAME(follow)(const rs_law *law, double size, rs_scalar s, rs_scalar w, RS_NAME(law_value) *out)
{
	double scale = size * law->lag;
	rs_scalar slope = 0.0, wanted = 0.0;
	if (law->fault == RS_FAULT_NONE)
		wanted = RS_NAME(limited)((law->command - s) / law->lag, law->rate_limit, &slope);
	out->g = scale * (w - wanted);
	out->g_s = size * slope;
	out->g_w = scale;
}

static void RS_NAME(actuator)(const rs_law *law, rs_scalar e, rs_scalar v, rs_scalar s, rs_scalar w,
                              RS_NAME(law_value) *out)
{
	int length = law->kind == RS_LAW_ACTUATOR_LENGTH, lags = law->lag > 0.0;
	int works = law->fault == RS_FAULT_NONE || law->fault == RS_FAULT_STUCK;
	double k = length ? law->stiffness : 0.0, per_demand = length ? -k : -1.0, c = law->damping, preload = length ? law->preload : 0.0;
	rs_scalar demand = lags ? s : (rs_scalar)law->command, slope, force;
	if (lags)
		RS_NAME(follow)(law, length ? k : 1.0, s, w, out);
	if (!works) {
		k = per_demand = preload = 0.0;
		c = law->fault == RS_FAULT_DAMPED ? law->bypass_damping : 0.0;
	}
	force = preload + k * e + per_demand * demand + c * v;
	out->f = RS_NAME(limited)(force, law->force_limit, &slope);
	out->f_e = slope * k;
	out->f_v = slope * c;
	out->f_s = lags ? slope * per_demand : 0.0;
}

static void RS_NAME(one_law)(const rs_law *law, rs_scalar e, rs_scalar v, rs_scalar s, rs_scalar w,
                             RS_NAME(law_value) *out)
{
	switch (law->kind) {
	case RS_LAW_SPRING_DAMPER:
		RS_NAME(spring_damper)(law, e, v, out);
		break;
	case RS_LAW_MAXWELL:
		RS_NAME(maxwell)(law, e, v, s, w, out);
		break;
	case RS_LAW_BUMP_STOP:
		RS_NAME(bump_stop)(law, e, out);
		break;
	case RS_LAW_ACTUATOR_FORCE:
	case RS_LAW_ACTUATOR_LENGTH:
		RS_NAME(actuator)(law, e, v, s, w, out);
		break;
	default: /* padding of an unfilled lane */
		break;
	}
}

/* Law of each lane. Arguments e v s w; returned f g and their slopes. */
static void RS_NAME(law)(const rs_law *const *laws, const rs_lane *e, const rs_lane *v, const rs_lane *s,
                         const rs_lane *w, rs_lane *f, rs_lane *g, rs_lane *f_e, rs_lane *f_v,
                         rs_lane *f_s, rs_lane *f_w, rs_lane *g_e, rs_lane *g_v, rs_lane *g_s, rs_lane *g_w)
{
	for (int i = 0; i < RS_WIDTH; i++) {
#define AT(x) (((const rs_scalar *)(x))[i])
#define TO(x) (((rs_scalar *)(x))[i])
		RS_NAME(law_value) out = {0};
		RS_NAME(one_law)(laws[i], AT(e), AT(v), AT(s), AT(w), &out);
		if (laws[i]->seen) {
			laws[i]->seen[RS_SEEN_LENGTH] = RS_REAL(AT(e));
			laws[i]->seen[RS_SEEN_RATE] = RS_REAL(AT(v));
			laws[i]->seen[RS_SEEN_FORCE] = RS_REAL(out.f);
		}
		TO(f) = out.f;
		TO(g) = out.g;
		TO(f_e) = out.f_e;
		TO(f_v) = out.f_v;
		TO(f_s) = out.f_s;
		TO(f_w) = out.f_w;
		TO(g_e) = out.g_e;
		TO(g_v) = out.g_v;
		TO(g_s) = out.g_s;
		TO(g_w) = out.g_w;
#undef AT
#undef TO
	}
}
