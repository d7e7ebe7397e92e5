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
} rs_group;

struct rs_model {
	int coordinates;          /* n */
	rs_group *groups;         /* one a kernel */
	unsigned char *is_angle;  /* n */
	double *sine, *cosine;    /* n, filled by each evaluation where is_angle */
};

#endif
