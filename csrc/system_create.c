/* SPDX-License-Identifier: BSD-3-Clause */
/* A system's places: which row of which block each coordinate is, and where in the blocks every
 * row and entry of every instance goes. Found once, so that a step only adds numbers up. */
#include <stdlib.h>
#include <string.h>

#include "system.h"

/* The internal coordinate of a kernel with a force law is its last one. */
static int internal_of(const rs_kernel_info *info)
{
	return info->has_law ? info->coordinates - 1 : -1;
}

/* Number of the block of a coordinate in the caller's order; -1: none. */
static int block_of(const rs_system *system, const int *block, int coordinate)
{
	return coordinate < 0 || coordinate >= system->second ? -1 : block[coordinate];
}

static void couple(const rs_system *system, int blocks, const int *block, unsigned char *coupled)
{
	for (int kernel = 0; kernel < rs_kernel_count(); kernel++) {
		const rs_group *group = system->model->groups + kernel;
		int size = rs_kernel_describe(kernel)->coordinates;
		for (int k = 0; k < group->count; k++)
			for (int i = 0; i < size; i++)
				for (int j = 0; j < size; j++) {
					int row = block_of(system, block, group->index[k * size + i]);
					int column = block_of(system, block, group->index[k * size + j]);
					if (row >= 0 && column >= 0)
						coupled[row * blocks + column] = 1;
				}
	}
}

/* Sizes of blocks; 0 where one is empty or holds more than eight. */
static int count_sizes(int second, int blocks, const int *block, int *size)
{
	for (int k = 0; k < second; k++) {
		if (block[k] < 0 || block[k] >= blocks || ++size[block[k]] > RS_BLOCK)
			return 0;
	}
	for (int k = 0; k < blocks; k++)
		if (!size[k])
			return 0;
	return 1;
}

static int order_blocks(rs_system *system, int blocks, const int *block)
{
	unsigned char *coupled = calloc((size_t)blocks * (size_t)blocks, 1);
	int *size = calloc((size_t)blocks, sizeof(int));
	if (coupled && size && count_sizes(system->second, blocks, block, size)) {
		couple(system, blocks, block, coupled);
		system->lu = rs_block_lu_create(blocks, size, coupled);
	}
	free(coupled);
	free(size);
	return system->lu != NULL;
}

static int number_places(rs_system *system, int blocks, const int *block)
{
	int *position = malloc((size_t)blocks * sizeof(int)), *filled = calloc((size_t)blocks, sizeof(int));
	int fine = position && filled;
	if (fine) {
		for (int k = 0; k < blocks; k++)
			position[system->lu->block_at[k]] = k;
		for (int k = 0; k < system->size; k++)
			system->coordinate[k] = -1;
		for (int k = 0; k < system->n; k++)
			system->place[k] = -1;
		for (int k = 0; k < system->second; k++) {
			system->place[k] = RS_BLOCK * position[block[k]] + filled[block[k]]++;
			system->coordinate[system->place[k]] = k;
		}
	}
	free(position);
	free(filled);
	return fine;
}

/* Place of a coordinate; the spare one when it does not exist or is internal. */
static int place_of(const rs_system *system, int coordinate)
{
	return coordinate >= 0 && coordinate < system->second ? system->place[coordinate] : system->size;
}

static int offset_of(const rs_system *system, int row, int column)
{
	int i = place_of(system, row), j = place_of(system, column);
	if (i == system->size || j == system->size)
		return system->lu->values_size;
	return rs_block_lu_offset(system->lu, i / RS_BLOCK, j / RS_BLOCK) + RS_BLOCK * (j % RS_BLOCK) + i % RS_BLOCK;
}

static int allocate_scatter(rs_scatter *scatter, const rs_kernel_info *info, size_t blocks)
{
	size_t lanes = (size_t)rs_kernel_lanes();
	scatter->row = malloc(blocks * (size_t)info->coordinates * lanes * sizeof(int));
	scatter->entry = malloc(blocks * (size_t)info->entries * lanes * sizeof(int));
	scatter->inner = calloc(blocks, 1);
	scatter->kept = calloc(blocks * RS_KEPT * lanes, sizeof(double));
	return scatter->row && scatter->entry && scatter->inner && scatter->kept;
}

static void fill_scatter(const rs_system *system, rs_scatter *scatter, const rs_kernel_info *info, const rs_group *group)
{
	int lanes = rs_kernel_lanes(), size = info->coordinates;
	for (int k = 0; k < group->blocks * lanes; k++) {
		const int *own = group->index + k * size;
		int *row = scatter->row + k / lanes * size * lanes + k % lanes;
		int *entry = scatter->entry + (size_t)(k / lanes) * (size_t)(info->entries * lanes) + k % lanes;
		for (int c = 0; c < size; c++)
			row[c * lanes] = place_of(system, own[c]);
		for (int e = 0; e < info->entries; e++)
			entry[e * lanes] = offset_of(system, own[info->row[e]], own[info->column[e]]);
		if (scatter->internal >= 0 && own[scatter->internal] >= 0)
			scatter->inner[k / lanes] = 1;
	}
}

/* Every internal coordinate stands once, as the internal coordinate of an element. */
static int internal_are_inner(const rs_system *system)
{
	int found = 0, fine = 1;
	for (int kernel = 0; kernel < rs_kernel_count(); kernel++) {
		const rs_group *group = system->model->groups + kernel;
		int size = rs_kernel_describe(kernel)->coordinates;
		for (int k = 0; k < group->count * size; k++) {
			int internal = group->index[k] >= system->second;
			found += internal;
			fine &= !internal || k % size == system->scatter[kernel].internal;
			fine &= internal || k % size != system->scatter[kernel].internal || group->index[k] < 0;
		}
	}
	return fine && found == system->n - system->second;
}

static int make_scatters(rs_system *system)
{
	system->scatter = calloc((size_t)rs_kernel_count(), sizeof *system->scatter);
	for (int kernel = 0; system->scatter && kernel < rs_kernel_count(); kernel++) {
		const rs_kernel_info *info = rs_kernel_describe(kernel);
		const rs_group *group = system->model->groups + kernel;
		rs_scatter *scatter = system->scatter + kernel;
		scatter->internal = group->count ? internal_of(info) : -1;
		if (group->count && !allocate_scatter(scatter, info, (size_t)group->blocks))
			return 0;
		if (group->count)
			fill_scatter(system, scatter, info, group);
	}
	return system->scatter && internal_are_inner(system);
}

/* Visits every row that has a place, in the order in which they are summed up; with fill, writes it down as the next term. */
static void visit_rows(rs_system *system, int *terms, int fill)
{
	int lanes = rs_kernel_lanes(), offset = 0;
	for (int kernel = 0; kernel < rs_kernel_count(); kernel++) {
		const rs_group *group = system->model->groups + kernel;
		rs_scatter *scatter = system->scatter + kernel;
		int rows = group->blocks * lanes * rs_kernel_describe(kernel)->coordinates;
		for (int k = 0; k < rows; k++) {
			int place = scatter->row[k];
			if (place == system->size)
				continue;
			if (fill)
				system->sums.row[RS_BLOCK * (system->sums.first[place / RS_BLOCK] + terms[place]) + place % RS_BLOCK] = offset + k;
			terms[place]++;
		}
		if (fill && rows)
			scatter->values = system->sums.values + offset;
		offset += rows;
	}
	system->sums.row_count = offset;
}

static void number_terms(rs_system *system, const int *terms)
{
	int *first = system->sums.first, blocks = system->size / RS_BLOCK;
	first[0] = 0;
	for (int block = 0; block < blocks; block++) {
		int most = 0;
		for (int i = 0; i < RS_BLOCK; i++)
			most = terms[RS_BLOCK * block + i] > most ? terms[RS_BLOCK * block + i] : most;
		first[block + 1] = first[block] + most;
	}
}

static int leads(const rs_row_sums *sums, int block, int rows)
{
	for (int k = sums->first[block]; k < sums->first[block + 1]; k++)
		for (int i = 0; i < rows; i++)
			if (sums->row[RS_BLOCK * k + i] != sums->row[RS_BLOCK * k] + i * rs_kernel_lanes())
				return 0;
	return rows;
}

static void find_leads(const rs_system *system)
{
	const rs_row_sums *sums = &system->sums;
	for (int block = 0; RS_BLOCK * block < system->size; block++) {
		sums->lead[block] = system->lu->size[block] == 6 ? leads(sums, block, 6) : 0;
		if (!sums->lead[block])
			sums->lead[block] = leads(sums, block, 5);
	}
}

static int make_sums(rs_system *system)
{
	rs_row_sums *sums = &system->sums;
	int blocks = system->size / RS_BLOCK, fine = 0;
	int *terms = calloc((size_t)system->size, sizeof *terms);
	sums->first = malloc((size_t)(blocks + 1) * sizeof *sums->first);
	sums->lead = malloc((size_t)(blocks + 1) * sizeof *sums->lead);
	if (terms && sums->first && sums->lead) {
		visit_rows(system, terms, 0);
		number_terms(system, terms);
		size_t count = (size_t)sums->first[blocks] * RS_BLOCK, bytes = ((size_t)sums->row_count + 1) * sizeof(double);
		sums->row = malloc((count + 1) * sizeof *sums->row);
		sums->values = aligned_alloc(64, (bytes + 63) / 64 * 64);
		fine = sums->row && sums->values;
		for (size_t k = 0; fine && k < count; k++)
			sums->row[k] = sums->row_count;
		memset(terms, 0, (size_t)system->size * sizeof *terms);
		if (fine) {
			sums->values[sums->row_count] = 0.0;
			visit_rows(system, terms, 1);
			find_leads(system);
		}
	}
	free(terms);
	return fine;
}

static int build(rs_system *system, int blocks, const int *block)
{
	system->place = malloc((size_t)system->n * sizeof(int));
	system->coordinate = malloc((size_t)system->size * sizeof(int));
	system->force = calloc((size_t)system->n, sizeof(double));
	system->r = aligned_alloc(64, (size_t)(system->size + RS_BLOCK) * sizeof(double));
	if (!system->place || !system->coordinate || !system->force || !system->r)
		return 0;
	memset(system->r, 0, (size_t)(system->size + RS_BLOCK) * sizeof(double));
	if (!order_blocks(system, blocks, block))
		return 0;
	system->base = malloc((size_t)system->lu->values_size * sizeof(double));
	return system->base && number_places(system, blocks, block) && make_scatters(system) && make_sums(system);
}

rs_system *rs_system_create(rs_model *model, int second, int blocks, const int *block)
{
	if (second <= 0 || second > model->coordinates || blocks <= 0 || blocks > second)
		return NULL;
	rs_system *system = calloc(1, sizeof *system);
	if (!system)
		return NULL;
	system->model = model;
	system->n = model->coordinates;
	system->second = second;
	system->size = RS_BLOCK * blocks;
	if (!build(system, blocks, block)) {
		rs_system_free(system);
		return NULL;
	}
	return system;
}

void rs_system_free(rs_system *system)
{
	if (!system)
		return;
	for (int kernel = 0; system->scatter && kernel < rs_kernel_count(); kernel++) {
		free(system->scatter[kernel].row);
		free(system->scatter[kernel].entry);
		free(system->scatter[kernel].inner);
		free(system->scatter[kernel].kept);
	}
	free(system->scatter);
	free(system->sums.values);
	free(system->sums.first);
	free(system->sums.lead);
	free(system->sums.row);
	rs_block_lu_free(system->lu);
	free(system->place);
	free(system->coordinate);
	free(system->force);
	free(system->r);
	free(system->base);
	free(system->hold);
	free(system->capture);
	free(system);
}
