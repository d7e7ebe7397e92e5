/* SPDX-License-Identifier: BSD-3-Clause */
/* The model's memory: model.c fills it, assemble.c reads it. */
#ifndef RS_MODEL_H
#define RS_MODEL_H

#include "kernels.h"

typedef struct {
	int count;            /* instances */
	int blocks;           /* lanes full of them, the last one padded */
	double *in;           /* blocks x inputs x lanes */
	int *index;           /* blocks x lanes x coordinates of the kernel, -1: not there */
	const rs_law **laws;  /* blocks x lanes */
	int slots;            /* inputs that come from the state */
	short *slot;          /* slots, their numbers */
	int *source;          /* blocks x slots x lanes, where in the state each comes from */
} rs_group;

struct rs_model {
	int coordinates;          /* n */
	rs_group *groups;         /* one a kernel */
	unsigned char *is_angle;  /* n */
	int angles;
	int *angle;               /* coordinates that are angles */
	double *state;            /* q u a sin cos: n each; then 0 and 1, for coordinates that do not exist */
};

/* Sine and cosine of the angles among q into the state (trigonometry.c). */
void rs_model_trigonometry(rs_model *model);

/* Inputs of one block of a group from the state (assemble.c). */
void rs_group_gather(const rs_model *model, const rs_group *group, const rs_kernel_info *info, int block);

#endif
