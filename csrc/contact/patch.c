/* SPDX-License-Identifier: BSD-3-Clause */
/* The patch of one zone. Lowered by P, the bodies would overlap by P (cos(roll) - r' sin(roll)) - g; times the cosine of the
 * slope this is the overlap along the normal, over the arc length of the rail. Its runs are cut into strips of one width, which
 * strips.c turns into loads q_j; place, radius and angle are means over q_j, so that force and moment are those of the strips:
 *
 *   load |sum q n|    across sum q Y'/sum q    radius sum q r/sum q    angle that of sum q n
 *   a = sum q a / sum q over 9 pi/32 (exact for an ellipse),  b so that pi a b is the area
 */
#include <math.h>
#include <string.h>

#include "posture.h"

#define PI 3.14159265358979323846
#define MEAN_LENGTH (9.0 * PI / 32.0)
enum { MOST_RUNS = 8 };

typedef struct {
	double from[MOST_RUNS], to[MOST_RUNS]; /* rail samples, with fractions */
	int count;
	double total;
} runs;

typedef struct {
	double across, slope;
} strip_place;

static double overlap(const rs_posture *p, int k, double depth)
{
	return depth * (p->cosine - p->slope[k] * p->sine) - p->gap[k];
}

static int inside(const rs_posture *p, int k, double depth, rs_zone zone)
{
	return p->across[k] >= zone.low && p->across[k] < zone.high && overlap(p, k, depth) > 0.0;
}

/* Where between a sample inside and the next one, which is not, the overlap or the zone ends. */
static double edge(const rs_posture *p, int in, int out, double depth, rs_zone zone)
{
	double a = overlap(p, in, depth), b = overlap(p, out, depth), t = 1.0;
	if (!isfinite(b))
		return in;
	if (b < 0.0)
		t = a / (a - b);
	double cut = p->across[out] < zone.low ? zone.low : zone.high;
	if (p->across[out] < zone.low || p->across[out] >= zone.high)
		t = fmin(t, (cut - p->across[in]) / (p->across[out] - p->across[in]));
	return in + t * (out - in);
}

void rs_limit_search(rs_posture *p, double depth)
{
	int last = p->from->rail_count - 1;
	p->first = last;
	p->last = 1;
	for (int k = 1; k < last; k++)
		if (overlap(p, k, depth) > 0.0) {
			p->first = k < p->first ? k : p->first;
			p->last = k + 1;
		}
}

static void find_runs(const rs_posture *p, double depth, rs_zone zone, runs *out)
{
	int before = 0;
	out->count = 0;
	out->total = 0.0;
	for (int k = p->first; k <= p->last && out->count < MOST_RUNS; k++) {
		int now = k < p->last && inside(p, k, depth, zone);
		if (now && !before)
			out->from[out->count] = edge(p, k, k - 1, depth, zone);
		if (before && !now) {
			out->to[out->count] = edge(p, k - 1, k, depth, zone);
			out->total += out->to[out->count] - out->from[out->count];
			out->count++;
		}
		before = now;
	}
}

static void lay_strips(const rs_posture *p, const runs *found, double depth, rs_strip_patch *strips, strip_place *place)
{
	double cell = found->total / RS_STRIPS, at = -0.5 * cell;
	strips->width = cell * p->from->rail_step;
	strips->together = found->count == 1;
	for (int j = 0, run = 0; j < RS_STRIPS; j++) {
		at += cell;
		while (run < found->count - 1 && at > found->to[run] - found->from[run]) {
			at -= found->to[run] - found->from[run];
			run++;
		}
		double Y, Z, sample = found->from[run] + at;
		rs_rail_at(p->from, sample, &Y, &Z);
		double gap = rs_gap_at(p, Y, Z, &place[j].across, &place[j].slope), slope = place[j].slope;
		strips->s[j] = sample * p->from->rail_step;
		strips->u[j] = (depth * (p->cosine - slope * p->sine) - gap) / sqrt(1.0 + slope * slope);
	}
}

static void gather(const rs_strip_patch *strips, const strip_place *place, const rs_posture *p, double normal, double *field)
{
	double load = 0.0, across = 0.0, radius = 0.0, down = 0.0, aside = 0.0, length = 0.0, area = 0.0;
	for (int j = 0; j < RS_STRIPS; j++) {
		double q = 0.5 * PI * strips->gradient * strips->a[j] * strips->a[j] * strips->width;
		double cosine = 1.0 / sqrt(1.0 + place[j].slope * place[j].slope);
		load += q;
		across += q * place[j].across;
		radius += q * rs_wheel_radius(p->from, place[j].across);
		down += q * cosine;
		aside -= q * cosine * place[j].slope;
		length += q * strips->a[j];
		area += 2.0 * strips->a[j] * strips->width;
	}
	double a = length / load / MEAN_LENGTH, root = sqrt(normal);
	field[RS_STIFFNESS] = sqrt(down * down + aside * aside) / (normal * root);
	field[RS_ACROSS] = across / load;
	field[RS_RADIUS] = radius / load;
	field[RS_ANGLE] = atan2(aside, down);
	field[RS_LENGTH] = a / root;
	field[RS_WIDTH] = area / (PI * a) / root;
}

/* Straight on over the root of the penetration from the two patches before; from one, in proportion to the root; from none, half
 * of where the surfaces would cut. */
static void guess_lengths(rs_strip_patch *strips, const rs_patch_guess *g, double root)
{
	double step = g->known < 2 ? 0.0 : (root - g->root[0]) / (g->root[0] - g->root[1]);
	for (int j = 0; j < RS_STRIPS; j++) {
		double last = g->length[0][j], scaled = g->known ? last * root / g->root[0] : 0.0;
		if (!g->known)
			strips->a[j] = strips->u[j] > 0.0 ? sqrt(0.5 * strips->u[j] / strips->curvature) : 0.0;
		else
			strips->a[j] = g->known < 2 ? scaled : fmax(last + step * (last - g->length[1][j]), 0.5 * scaled);
	}
}

static void keep_lengths(const rs_strip_patch *strips, double root, rs_patch_guess *g)
{
	memcpy(g->length[1], g->length[0], sizeof g->length[0]);
	memcpy(g->length[0], strips->a, sizeof g->length[0]);
	g->root[1] = g->root[0];
	g->root[0] = root;
	g->known = g->known < 2 ? g->known + 1 : 2;
}

int rs_patch_fields(const rs_posture *p, const rs_influence *influence, double modulus, rs_zone zone, double depth, double normal,
                    rs_patch_guess *guess, double *field)
{
	rs_strip_patch strips = {.modulus = modulus};
	strip_place place[RS_STRIPS];
	runs found;
	find_runs(p, depth, zone, &found);
	if (!found.count || !(found.total > 0.0))
		return RS_NOT_CONVERGED;
	lay_strips(p, &found, depth, &strips, place);
	int top = 0;
	for (int j = 1; j < RS_STRIPS; j++)
		top = strips.u[j] > strips.u[top] ? j : top;
	if (!(strips.u[top] > 0.0))
		return RS_NOT_CONVERGED;
	strips.curvature = 0.5 / (rs_wheel_radius(p->from, place[top].across) * sqrt(1.0 + place[top].slope * place[top].slope));
	guess_lengths(&strips, guess, sqrt(normal));
	if (rs_strip_contact(influence, &strips) != RS_OK)
		return RS_NOT_CONVERGED;
	keep_lengths(&strips, sqrt(normal), guess);
	gather(&strips, place, p, normal, field);
	return RS_OK;
}
