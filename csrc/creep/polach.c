/* SPDX-License-Identifier: BSD-3-Clause */
/* Polach's law (1999) with the reduction factors kA, kS of 2005 (1 and 1: the law of 1999).
 *
 *   e1 = u1/C11, e2 = u2/C22, e3 = (u3/C23) sqrt(a/b)   creepages sx, sy, psi a, times G a b/(mu N)
 *   y = e2 + e3 where that has the larger modulus, else e2      sC = |(e1, y)|
 *   Cj^2 = (C11^2 e1^2 + C22^2 e2^2)/(e1^2 + e2^2)              eps = (pi/4) Cj sC
 *   F = (2/pi) [kA eps/(1 + (kA eps)^2) + atan(kS eps)]
 *   h0 = -F e1/sC    h1 = -F e2/sC - FS e3/sC    h2 = 0
 *   FS = (3/8) KS epsS/(1 + epsS^2)^2, epsS = (8/3) sqrt(b/a) C23 |y|/KS, KS = 1 + 6.3 (1 - exp(-a/b))
 *
 * FS is Polach's (9/16) KS [epsS (-d^3/3 + d^2/2 - 1/6) + sqrt((1 - d^2)^3)/3],
 * d = (epsS^2 - 1)/(epsS^2 + 1), simplified without approximation. The law has no spin moment.
 * Near zero creepage it is homogeneous of degree one but not linear (Cj depends on the direction
 * of the creepage): the slopes at zero are the partial derivatives, those of Kalker's linear
 * theory. The slope jumps where |e2 + e3| = |e2|; the force does not.
 *
 * O. Polach, A fast wheel-rail forces calculation computer code, Veh. Syst. Dyn. 33 Suppl.
 * (1999) 728-739; Creep forces in simulations of traction vehicles running on adhesion limit,
 * Wear 258 (2005) 992-1000.
 */
#include "../creep.h"

#define TINY 1e-290 /* added to squares that divide: 0/0 becomes 0 and nothing else changes */

typedef struct {
	rs_lane e1, e2, e3, y, larger;  /* larger: 1 where y = e2 + e3 */
	rs_lane direction2, sC2, Cj;    /* e1^2 + e2^2, sC^2 */
	rs_lane P, P_Cj, P_sC2;         /* F/sC, and its slopes */
	rs_lane T, T_y, T_sC2;          /* FS/sC, and its slopes */
} polach;

/* atan(x) of eight x >= 0 to the last digit or two: halved twice over,
 * atan x = pi/2 - atan(1/x) above 1, atan t = 2 atan(t/(1 + sqrt(1 + t^2))), then q (1 - q^2/3 + ...)
 * by the polynomial of least largest error (1.3e-18) for q up to tan(pi/8). */
RS_INLINE void arctangent(const rs_lane *x, rs_lane *to)
{
	static const double c[] = {0.99999999999999999874, -0.33333333333333121163, 0.19999999999940891408,
	                           -0.14285714279250239667, 0.11111110744919395758, -0.090908968090564377814,
	                           0.076920453307659118451, -0.066629518120618369597, 0.058468782857870010961,
	                           -0.050351024039430294125, 0.037965256099576568431, -0.017805395704537507381};
	enum { TERMS = sizeof c / sizeof *c };
	rs_lane t = 1.0 / (*x + TINY), root, square, sum = RS_ZERO + c[TERMS - 1];
	RS_EACH(l)
		RS_AT(t, l) = RS_OF(*x, l) > 1.0 ? RS_OF(t, l) : RS_OF(*x, l);
	square = 1.0 + t * t;
	RS_SQRT(root, square);
	rs_lane q = t / (1.0 + root), w = q * q;
	for (int k = TERMS - 2; k >= 0; k--)
		sum = sum * w + c[k];
	sum *= 2.0 * q;
	rs_lane rest = RS_PI / 2.0 - sum;
	RS_EACH(l)
		RS_AT(*to, l) = RS_OF(*x, l) > 1.0 ? RS_OF(rest, l) : RS_OF(sum, l);
}

/* F/sC = Cj B(eps), B = [kA/(1 + (kA eps)^2) + atan(kS eps)/eps]/2; and eps dB/d(eps). */
RS_INLINE void friction_part(const rs_creep_input *in, const rs_lane *eps, rs_lane *bracket, rs_lane *eps_slope)
{
	rs_lane t = in->adhesion * *eps, s = in->slip * *eps, p = 1.0 / (1.0 + t * t), angle, quotient;
	arctangent(&s, &angle);
	quotient = angle / (*eps + TINY);
	RS_EACH(l)
		RS_AT(quotient, l) = RS_OF(s, l) > 0.0 ? RS_OF(quotient, l) : RS_OF(in->slip, l);
	*bracket = 0.5 * (in->adhesion * p + quotient);
	*eps_slope = 0.5 * (in->slip / (1.0 + s * s) - quotient) - in->adhesion * t * t * p * p;
}

RS_INLINE void saturate(const rs_creep_input *in, polach *p)
{
	rs_lane sC, bracket, eps_slope, eps;
	RS_SQRT(sC, p->sC2);
	eps = (RS_PI / 4.0) * p->Cj * sC;
	friction_part(in, &eps, &bracket, &eps_slope);
	p->P = p->Cj * bracket;
	p->P_Cj = bracket + eps_slope;
	p->P_sC2 = 0.5 * p->Cj * eps_slope / (p->sC2 + TINY);

	rs_lane KS, size, inverse = 1.0 / (sC + 1e-145);
	RS_EACH(l) {
		RS_AT(KS, l) = 1.0 + 6.3 * (1.0 - exp(-RS_OF(in->root, l) * RS_OF(in->root, l)));
		RS_AT(size, l) = fabs(RS_OF(p->y, l));
	}
	/* FS = g |y|/(1 + (q y)^2)^2 with g = sqrt(b/a) C23 */
	rs_lane g = in->c23 / in->root, q = (8.0 / 3.0) * g / KS, z = q * q * p->y * p->y, m = 1.0 / (1.0 + z);
	p->T = g * size * m * m * inverse;
	RS_EACH(l)
		RS_AT(p->T_y, l) = RS_OF(p->y, l) < 0.0 ? -1.0 : 1.0;
	p->T_y *= g * m * m * m * (1.0 - 3.0 * z) * inverse;
	p->T_sC2 = -0.5 * p->T * inverse * inverse;
}

RS_INLINE void creepages(const rs_creep_input *in, polach *p)
{
	p->e1 = in->u[0] / in->c11;
	p->e2 = in->u[1] / in->c22;
	p->e3 = in->u[2] / in->c23 * in->root;
	p->direction2 = p->e1 * p->e1 + p->e2 * p->e2;
	rs_lane both = p->e2 + p->e3, square = (in->u[0] * in->u[0] + in->u[1] * in->u[1]) / (p->direction2 + TINY);
	RS_EACH(l) {
		double sum = RS_OF(both, l), alone = RS_OF(p->e2, l);
		RS_AT(p->larger, l) = fabs(sum) >= fabs(alone) ? 1.0 : 0.0;
		RS_AT(p->y, l) = fabs(sum) >= fabs(alone) ? sum : alone;
		RS_AT(square, l) = RS_OF(square, l) > 0.0 ? RS_OF(square, l) : RS_OF(in->c22, l) * RS_OF(in->c22, l);
	}
	p->sC2 = p->e1 * p->e1 + p->y * p->y;
	RS_SQRT(p->Cj, square);
}

/* Pure spin, or nothing at all: the partial derivatives are limits along the axes, where
 * Cj is C11 or C22, and with no spin FS/sC |psi| goes to Kalker's coefficient. */
RS_INLINE void limits(const rs_creep_input *in, const polach *p, rs_creep_value *out)
{
	int any = 0;
	RS_EACH(l)
		any |= !(RS_OF(p->direction2, l) > 0.0);
	if (!any)
		return;
	rs_lane sC, eps, bracket, unused;
	RS_SQRT(sC, p->sC2);
	eps = (RS_PI / 4.0) * in->c11 * sC;
	friction_part(in, &eps, &bracket, &unused);
	RS_EACH(l) {
		if (RS_OF(p->direction2, l) > 0.0)
			continue;
		RS_AT(out->d[0][0], l) = -RS_OF(bracket, l);
		if (RS_OF(sC, l) == 0.0)
			RS_AT(out->d[1][2], l) = -1.0;
	}
}

RS_CLONES void rs_creep_polach(const rs_creep_input *in, int slopes, rs_creep_value *out)
{
	polach p;
	creepages(in, &p);
	saturate(in, &p);
	out->h[0] = -p.P * p.e1;
	out->h[1] = -p.P * p.e2 - p.T * p.e3;
	out->h[2] = RS_ZERO;
	if (!slopes)
		return;
	/* Cj depends on e1, e2; sC^2 on e1, y; y on e2 and, where larger, e3. */
	rs_lane of_Cj = p.P_Cj / (p.Cj * (p.direction2 + TINY)), square = p.Cj * p.Cj;
	rs_lane P_1 = of_Cj * (in->c11 * in->c11 - square) * p.e1 + 2.0 * p.P_sC2 * p.e1;
	rs_lane P_y = 2.0 * p.P_sC2 * p.y, T_y = p.T_y + 2.0 * p.T_sC2 * p.y;
	rs_lane P_2 = of_Cj * (in->c22 * in->c22 - square) * p.e2 + P_y;
	rs_lane to1 = 1.0 / in->c11, to2 = 1.0 / in->c22, to3 = in->root / in->c23;
	out->d[0][0] = -(p.P + P_1 * p.e1) * to1;
	out->d[0][1] = -P_2 * p.e1 * to2;
	out->d[0][2] = -P_y * p.larger * p.e1 * to3;
	out->d[1][0] = -(P_1 * p.e2 + 2.0 * p.T_sC2 * p.e1 * p.e3) * to1;
	out->d[1][1] = -(p.P + P_2 * p.e2 + T_y * p.e3) * to2;
	out->d[1][2] = -(P_y * p.larger * p.e2 + p.T + T_y * p.larger * p.e3) * to3;
	out->d[2][0] = out->d[2][1] = out->d[2][2] = RS_ZERO;
	limits(in, &p, out);
}
