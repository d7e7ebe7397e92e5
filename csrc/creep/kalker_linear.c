/* SPDX-License-Identifier: BSD-3-Clause */
/* Kalker's linear theory: full adhesion, forces without bound.
 *
 *   h0 = -u1    h1 = -(u2 + u3)    h2 = (C23/C22) u2 - (C33/C23) u3
 *
 * J.J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, Kluwer 1990, section 2.2.2.
 */
#include <string.h>

#include "../creep.h"

RS_CLONES void rs_creep_kalker_linear(const rs_creep_input *in, int slopes, rs_creep_value *out)
{
	rs_lane of_lateral = in->c23 / in->c22, of_spin = -in->c33 / in->c23;
	out->h[0] = -in->u[0];
	out->h[1] = -(in->u[1] + in->u[2]);
	out->h[2] = of_lateral * in->u[1] + of_spin * in->u[2];
	if (!slopes)
		return;
	memset(out->d, 0, sizeof out->d);
	out->d[0][0] = RS_ZERO - 1.0;
	out->d[1][1] = RS_ZERO - 1.0;
	out->d[1][2] = RS_ZERO - 1.0;
	out->d[2][1] = of_lateral;
	out->d[2][2] = of_spin;
}
