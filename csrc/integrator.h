/* SPDX-License-Identifier: BSD-3-Clause */
/* Fixed-step integration of a model: the contracts, and the memory between its files.
 *
 * Generalised-alpha for first-order equations (Jansen, Whiting and Hulbert 2000, Comput. Methods Appl.
 * Mech. Eng. 190, eqs. 13-22) on the states q, u and s alike, as Kadapa, Dettmer and Peric (2017,
 * Comput. Struct. 193, eqs. 20-27) do for structures: y = (q, u, s), with y' an unknown of its own,
 *
 *     r(q_f, u_f, a_m, s_f, s'_m) = 0,   q'_m = u_f,   u'_m = a_m
 *     y_f  = y_n + af (y_n+1 - y_n),      y'_m = y'_n + am (y'_n+1 - y'_n)
 *     y_n+1 = y_n + h ((1 - gamma) y'_n + gamma y'_n+1)
 *     am = (3 - rho)/(2 (1 + rho)),  af = 1/(1 + rho),  gamma = 1/2 + am - af.
 *
 * Second order; A-stable; rho = 1 is the trapezoidal rule, 0 is BDF2; rho is what is left of a motion much
 * faster than the step after one step. All states share tau = gamma h af/am, so that the matrix of the
 * iteration is the pencil for (1, 1/tau, 1/tau^2) and internal states need no scheme of their own. No
 * overshoot, other than Chung and Hulbert's scheme for second-order equations.
 *
 * rs_integrator_create   an integrator at rest; the model is kept, not copied, and is its work space
 *   Given     second     coordinates 0 ... second - 1 are those of bodies, the rest internal (Maxwell) ones
 *             block      second: number of the body of each coordinate, 0 ... blocks - 1, at most eight each
 *             step       s, > 0
 *             rho        0 ... 1
 *             tolerance  m/s^2 (rad/s^2 on a lever of 1 m): acceleration that an iteration may leave wrong; a thousandth of
 *                        the largest acceleration where that is less, but not below 1e-6 unless the tolerance is
 *   Returned  the integrator, or NULL (no memory, or a value or block outside its range)
 * rs_integrator_start    state at a time; accelerations and rates of internal states follow from it
 *   Status    RS_OK, RS_SINGULAR (mass matrix), RS_NOT_FINITE, RS_NOT_CONVERGED (rate of an internal state),
 *             and those of the track and the wheels
 * rs_integrator_set_step another step (s), from the next start on; RS_BAD_SIZE where it is not positive and finite
 * rs_integrator_hold     soft springs and dampers on single coordinates, and the force that gives a mass (kg) the
 *                        acceleration of the track frames; replaces those before
 * rs_integrator_force    n applied generalised forces, N or N m, constant in a step; write to it between runs
 * rs_integrator_kinks    times where the equations are not smooth; steps end there and begin anew
 *   Given     time       count, s, increasing
 * rs_integrator_channels what a sample holds; replaces those before. Elements in the order of kernels and instances
 * rs_integrator_controller   called before every `every`-th step; a return other than 0 stops the run (RS_STOPPED)
 * rs_integrator_watcher  called before every step, ahead of the controller: it sees the state and changes nothing that acts on the vehicle
 * rs_integrator_run      steps with samples after every `every`-th step, counted from the start
 *   Returned  samples    rows x channels
 *             sampled    rows written; also after a failure
 *   Status    RS_OK; RS_NOT_CONVERGED, RS_NOT_FINITE, RS_SINGULAR and those of the track and the wheels: the state
 *             is that of the end of the last good step, rs_integrator_report says more. RS_STOPPED by the controller.
 *   Notes     No allocation. The same steps in one run or in ten: the same bytes.
 * rs_integrator_restart  a force has jumped: accelerations and rates of internal states anew from the state as it is; status as start
 * rs_integrator_follow   actuators with a lag have a new command or fault: the rates of what they follow jump at once, instead of
 *                        ringing over the next steps. Called after every controller in C
 * rs_integrator_look     everything is evaluated at the end of the last step: laws with a `seen` have seen it, body inputs are of that time
 * rs_integrator_inertial what an inertial unit feels at the end of the last step
 *   Given     kernel, instance   of a body
 *             arm        3, m, of the unit from the body's centre at the design position, axes of the body
 *   Returned  felt       6: acceleration less gravity (m/s^2) and angular velocity (rad/s), axes of the body; of a wheelset those of
 *                        its axle, which does not spin
 *   Status    RS_OK, RS_BAD_INDEX, those of the track
 *   Notes     No allocation. A controller in C may call both.
 * rs_integrator_residual r(q, u, a) with holds, forces, wheels and track at a time; n
 * rs_integrator_solve    S x = b with the pencil at a state, by blocks: to compare with other solvers; the
 *                        integrator must be started again before it runs
 * rs_integrator_travel   how the track frames move; the caller keeps it alive. NULL: as the model's inputs say
 * rs_integrator_wheels   wheel-rail forces that join the residual; needs a travel with these wheelsets
 *   Given     first      wheelsets, first coordinate (x) of each
 * rs_integrator_fill     size of the factors: block operations of a factorisation, doubles
 */
#ifndef RS_INTEGRATOR_H
#define RS_INTEGRATOR_H

#include "travel.h"
#include "railsym.h"
#include "system.h"
#include "wheel_rail.h"

struct rs_integrator {
	rs_system *system;
	rs_travel *travel;         /* the caller's, or NULL: nothing moves that the model's inputs do not say */
	rs_wheel_rail *wheels;     /* the caller's, or NULL */
	int wheelsets, *wheelset;  /* first coordinate of each */
	double *wheel_rows, *wheel_blocks, *wheel_output, *patch_output;
	int n, second;
	double step, am, af, gamma, tolerance;
	double start;              /* s */
	double *q, *u, *a;         /* n: u of an internal coordinate is its rate, a is not used */
	double *v;                 /* n: rate of q as the scheme carries it */
	double *before;            /* n: a (internal: u) of one step earlier */
	double before_step;        /* s, length of that step; 0: none */
	double *d;                 /* n */
	double factored;           /* s, tau of the factors; 0: none */
	double contraction;        /* of an iteration with these factors */
	double largest;            /* m/s^2, acceleration at the last step */
	double seen;               /* the same as the last step measured it; 0: it did not */
	double *kink;
	int kinks, next_kink;
	rs_channel *channel;
	int channels, looks;       /* looks: 1 where a sample needs the residual */
	double *sample_u, *sample_a;  /* n */
	rs_controller controller, watcher;
	void *context, *watched;
	int every;                 /* steps between calls of the controller */
	rs_run_report report;
};

/* Accelerations and rates of internal states that fit q, u and s just after a time (integrator_start.c). */
int rs_integrator_begin(rs_integrator *integrator, double time);

/* Rates and accelerations (n each) at the end of the last step. */
void rs_integrator_at_end(const rs_integrator *integrator, double *u, double *a);

/* One step of integrator->step, in pieces at kinks (integrator_step.c). */
int rs_integrator_one_step(rs_integrator *integrator);

/* State into the model's; a may be NULL (zero). */
void rs_integrator_place(rs_integrator *integrator, const double *q, const double *u, const double *a);

/* Track and speed at a time; RS_OK without motion. */
int rs_integrator_move(rs_integrator *integrator, double time);

/* The whole residual at the model's state, with seed the pencil, or (wheels_only) the pencil as it was with new slopes
 * of the wheels; status of the wheels. */
int rs_integrator_evaluate(rs_integrator *integrator, const double *seed, int inner, int wheels_only);

#endif
