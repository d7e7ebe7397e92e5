/* SPDX-License-Identifier: BSD-3-Clause */
/* Residual and pencil of the whole vehicle: system and wheels.
 *
 * The slopes of the creep forces change from step to step, those of everything else hardly. So the
 * pencil without the wheels is kept beside its factors, and most factorisations take new
 * slopes of the wheels alone, which saves the evaluation of the pencil of bodies and elements.
 */
#include <stdlib.h>
#include <string.h>

#include "integrator.h"

int rs_integrator_wheels(rs_integrator *it, rs_wheel_rail *wheels, int wheelsets, const int *first)
{
	size_t count = (size_t)(wheelsets > 0 ? wheelsets : 0);
	size_t sizes[4] = {6 * count, 36 * count, 2 * count * RS_WHEEL_OUTPUTS, 2 * count * RS_ZONES * RS_PATCH_OUTPUTS};
	for (size_t k = 0; k < count; k++)
		if (first[k] < 0 || first[k] + 6 > it->second)
			return RS_BAD_INDEX;
	double *memory = calloc(sizes[0] + sizes[1] + sizes[2] + sizes[3] + 1, sizeof(double));
	int *kept = malloc((count + 1) * sizeof(int));
	if (!memory || !kept) {
		free(memory);
		free(kept);
		return RS_NO_MEMORY;
	}
	memcpy(kept, first, count * sizeof(int));
	free(it->wheelset);
	free(it->wheel_rows);
	it->wheels = wheels;
	it->wheelsets = (int)count;
	it->wheelset = kept;
	it->wheel_rows = memory;
	it->wheel_blocks = memory + sizes[0];
	it->wheel_output = it->wheel_blocks + sizes[1];
	it->patch_output = it->wheel_output + sizes[2];
	it->factored = 0.0;
	return RS_OK;
}

static void add_wheelset(rs_integrator *it, int k, int with_blocks)
{
	rs_system *system = it->system;
	const double *rows = it->wheel_rows + 6 * k, *block = it->wheel_blocks + 36 * k;
	int place = system->place[it->wheelset[k]], row = place % RS_BLOCK;
	double *diagonal = system->lu->values + system->lu->diagonal[place / RS_BLOCK] + RS_BLOCK * row + row;
	for (int i = 0; i < 6; i++)
		system->r[place + i] += rows[i];
	for (int i = 0; with_blocks && i < 6; i++)
		for (int j = 0; j < 6; j++)
			diagonal[RS_BLOCK * j + i] += block[6 * i + j];
}

int rs_integrator_evaluate(rs_integrator *it, const double *seed, int inner, int wheels_only)
{
	rs_system *system = it->system;
	size_t bytes = (size_t)system->lu->values_size * sizeof(double);
	rs_system_evaluate(system, wheels_only ? NULL : seed, inner);
	if (!it->wheels)
		return RS_OK;
	const rs_travel *travel = it->travel;
	const double *q = system->model->state, *rail = travel->track ? travel->rail : NULL;
	int with_blocks = seed && (seed[0] != 0.0 || seed[1] != 0.0);
	int status = rs_wheel_rail_rows(it->wheels, q, q + system->model->stride, travel->V, travel->w, rail, seed, it->wheel_rows,
	                                with_blocks ? it->wheel_blocks : NULL);
	if (status)
		return status;
	if (with_blocks && wheels_only)
		memcpy(system->lu->values, system->base, bytes);
	else if (with_blocks)
		memcpy(system->base, system->lu->values, bytes);
	for (int k = 0; k < it->wheelsets; k++)
		add_wheelset(it, k, with_blocks);
	return RS_OK;
}
