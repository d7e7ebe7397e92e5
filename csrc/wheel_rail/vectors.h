/* SPDX-License-Identifier: BSD-3-Clause */
/* Products of three components, numbers or lanes. */
#ifndef RS_VECTORS_H
#define RS_VECTORS_H

#define DOT(x, y) ((x)[0] * (y)[0] + (x)[1] * (y)[1] + (x)[2] * (y)[2])

/* to = x cross y; to is neither x nor y. */
#define CROSS(to, x, y) \
	do { \
		(to)[0] = (x)[1] * (y)[2] - (x)[2] * (y)[1]; \
		(to)[1] = (x)[2] * (y)[0] - (x)[0] * (y)[2]; \
		(to)[2] = (x)[0] * (y)[1] - (x)[1] * (y)[0]; \
	} while (0)

/* to += x cross y */
#define ADD_CROSS(to, x, y) \
	do { \
		(to)[0] += (x)[1] * (y)[2] - (x)[2] * (y)[1]; \
		(to)[1] += (x)[2] * (y)[0] - (x)[0] * (y)[2]; \
		(to)[2] += (x)[0] * (y)[1] - (x)[1] * (y)[0]; \
	} while (0)

#define EACH_AXIS(i) for (int i = 0; i < 3; i++)

#endif
