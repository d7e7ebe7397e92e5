/* SPDX-License-Identifier: BSD-3-Clause */
/* A model with its pencil in blocks: what an implicit step solves with.
 *
 * Coordinates 0 ... second - 1 are those of bodies, in blocks of at most eight; the rest are
 * internal (Maxwell) coordinates. Each of these belongs to one element, so it is eliminated
 * inside that element before anything is added up: with column c, row w and pivot p of the element's
 * own pencil and residual g of the internal equation,
 *
 *     S = S - c w/p,   r = r - c g/p,   and afterwards   ds = -(g + w dq)/p.
 */
#ifndef RS_SYSTEM_H
#define RS_SYSTEM_H

#include "block_lu.h"
#include "model.h"

typedef struct {
	int internal;          /* the kernel's internal coordinate, or -1 */
	int *row;              /* blocks x coordinates x lanes, place in block vectors */
	int *entry;            /* blocks x entries x lanes, offset in the values of the LU */
	unsigned char *inner;  /* blocks, 1 where any lane has an internal coordinate */
	double *kept;          /* blocks x RS_KEPT x lanes: c/p, w, g, 1/p */
	double *values;        /* blocks x coordinates x lanes, rows of the residual: part of the system's */
} rs_scatter;

/* Which rows make up the residual: row[8 k + i] of term k goes to coordinate i of its block. Sums of eight numbers in
 * registers, where rows that went to their places one by one would wait for each other. */
typedef struct {
	int row_count;
	double *values;        /* rows of all groups, then a zero */
	int *first;            /* blocks + 1, terms of a block */
	int *row;              /* terms x 8 */
	int *lead;             /* blocks, first rows that in every term are coordinates 0, 1 ... of one lane: six, five or none */
} rs_row_sums;

enum { RS_KEPT = 2 * RS_MAX_COORDINATES + 2, RS_KEPT_ROW = RS_MAX_COORDINATES,
       RS_KEPT_G = 2 * RS_MAX_COORDINATES, RS_KEPT_INVERSE = 2 * RS_MAX_COORDINATES + 1 };

/* One row of the residual of one instance, looked at before it is added up: forces of elements. */
typedef struct {
	int kernel, instance, row;
	double value;
} rs_capture;

/* A soft hold of one coordinate: stiffness, damping, and the traction that accelerates a mass with the track frames. */
typedef struct {
	int place, diagonal, coordinate;
	double stiffness, damping, mass;
} rs_hold;

typedef struct {
	rs_model *model;
	rs_block_lu *lu;
	int n, second;        /* coordinates, those of bodies */
	int size;             /* of block vectors: 8 blocks; eight spare ones follow */
	int *place;           /* n, place in block vectors, -1 for an internal coordinate */
	int *coordinate;      /* size, coordinate at a place, -1 for none */
	rs_scatter *scatter;  /* one a kernel */
	rs_row_sums sums;
	double *r;            /* size + 8, residual, then the solution */
	double *base;         /* values of the pencil before it was factored, without the wheels */
	double *force;        /* n, applied generalised forces, N and N m */
	rs_hold *hold;
	int holds;
	double travel_acceleration;  /* m/s^2, of the track frames along the track */
	rs_capture *capture;  /* in the order of kernels and instances */
	int captures;
	int capturing;        /* 1: the next evaluation fills them */
} rs_system;

/* block: second, number of the block of each coordinate, 0 ... blocks - 1. NULL: no memory, a block of more
 * than eight or no coordinates, or an internal coordinate that not exactly one element has. */
rs_system *rs_system_create(rs_model *model, int second, int blocks, const int *block);
void rs_system_free(rs_system *system);

/* Residual, and with seed the pencil, at model->state. inner 0: internal coordinates are held (not eliminated). */
void rs_system_evaluate(rs_system *system, const double *seed, int inner);

/* r = -b in place of a residual, with the pencil and the eliminations as they are. */
void rs_system_load(rs_system *system, const double *b);

/* S d = -r with the factors as they are; d: n. r is overwritten. */
void rs_system_solve(rs_system *system, double *d);

/* A coordinate whose residual is not finite, or where there is one rather one that is not finite itself; -1 for none. */
int rs_system_not_finite(const rs_system *system);

#endif
