/* SPDX-License-Identifier: BSD-3-Clause */
/* The model's memory: model.c fills it, assemble.c reads it. */
#ifndef RS_MODEL_H
#define RS_MODEL_H

#include "kernels.h"

/* Up to four inputs that stand side by side in the state in every lane: yaw, roll, pitch; or one that does not. */
enum { RS_RUN = 4 };
typedef struct {
	short length, slot[RS_RUN];  /* unused ones: the first */
	int source[8];        /* lanes, where in the state the first one is */
} rs_run;

typedef struct {
	int count;            /* instances */
	int blocks;           /* lanes full of them, the last one padded */
	double *in;           /* blocks x inputs x lanes */
	int *index;           /* blocks x lanes x coordinates of the kernel, -1: not there */
	const rs_law **laws;  /* blocks x lanes */
	rs_run *run;          /* of all blocks, one after the other */
	int *first_run;       /* blocks + 1 */
} rs_group;

struct rs_model {
	int coordinates;          /* n */
	int stride;               /* n rounded up, so that the parts of the state begin on cache lines */
	rs_group *groups;         /* one a kernel */
	unsigned char *is_angle;  /* n */
	int angles;
	int *angle;               /* coordinates that are angles */
	double *state;            /* q u a sin cos: stride each; then zeros and ones, for coordinates that do not exist */
};

/* Sine and cosine of the angles among q into the state (trigonometry.c). */
void rs_model_trigonometry(rs_model *model);

/* Zeros in the state for coordinates that do not exist, and as many ones for their cosines; a run may read beyond. */
enum { RS_SPARE = RS_MAX_COORDINATES + RS_RUN };

/* Finds the runs of a group (gather.c); RS_OK or RS_NO_MEMORY. */
int rs_group_find_runs(rs_group *group, const rs_kernel_info *info, int coordinates);

/* Inputs of one block of a group from the state (gather.c). */
void rs_group_gather(const rs_model *model, const rs_group *group, const rs_kernel_info *info, int block);

#endif
