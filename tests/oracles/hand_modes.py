# SPDX-License-Identifier: BSD-3-Clause
"""Car-body frequencies and static wheel loads of a symmetric coach, from textbook formulas.

Heights h are positive downwards from the body's own centre of mass to the plane of the springs (so a spring below
the car has h > 0 seen from the car).  Undamped; springs stand symmetrically about both vertical planes.  W h is the
inverted-pendulum moment of a weight W that stands on springs h below its centre.
See Wickens, Fundamentals of Rail Vehicle Dynamics (2003), chapters 3 and 6, for the bounce and sway modes.
"""

from dataclasses import dataclass

import numpy as np

GRAVITY = 9.81


@dataclass(frozen=True)
class SpringPlane:
    """All springs of one suspension stage together.

    longitudinal, lateral, vertical : N/m, sums
    half_spacing, half_base : m, lateral and longitudinal distance of the vertical springs from the middle
    roll, pitch : N m/rad, sums of bars and bending
    """

    longitudinal: float
    lateral: float
    vertical: float
    half_spacing: float
    half_base: float
    roll: float = 0.0
    pitch: float = 0.0


def frequencies(mass, stiffness):
    """Natural frequencies (Hz), rising, of M q'' + K q = 0."""
    squares = np.linalg.eigvals(np.linalg.solve(np.atleast_2d(mass), np.atleast_2d(stiffness)))
    return np.sqrt(np.sort(squares.real)) / (2.0 * np.pi)


def bounce(mass, secondary):
    """Car-body bounce over held bogies: f = sqrt(Kz/m) / 2 pi."""
    return np.sqrt(secondary.vertical / mass) / (2.0 * np.pi)


def bounce_with_bogies(car_mass, bogies_mass, secondary, primary):
    """Bounce of car and bogies in phase, wheelsets held: two masses on two springs."""
    above, below = secondary.vertical, primary.vertical
    return frequencies(np.diag([car_mass, bogies_mass]), [[above, -above], [-above, above + below]])


def pitch(mass, inertia, secondary, height, gravity=GRAVITY):
    """Surge and pitch over held bogies, (2,) Hz: springs `height` below the car's centre.

    Longitudinal deformation at the springs x + h pitch, vertical -+ a pitch.
    """
    along, stiff = secondary.longitudinal, secondary.vertical * secondary.half_base**2 + secondary.pitch
    turning = along * height**2 + stiff - mass * gravity * height
    return frequencies(np.diag([mass, inertia]), [[along, along * height], [along * height, turning]])


def sway(mass, inertia, secondary, height, gravity=GRAVITY):
    """Lower and upper sway over held bogies, (2,) Hz: springs `height` below the car's centre.

    Lateral deformation at the springs y - h roll, vertical +- b roll.
    """
    across, stiff = secondary.lateral, secondary.vertical * secondary.half_spacing**2 + secondary.roll
    turning = across * height**2 + stiff - mass * gravity * height
    return frequencies(np.diag([mass, inertia]), [[across, -across * height], [-across * height, turning]])


def sway_with_bogies(car, bogies, secondary, primary, heights, gravity=GRAVITY):
    """Sway of car and bogies in phase over held wheelsets, (4,) Hz, lowest two the car's lower and upper sway.

    car, bogies : (mass, roll inertia), both bogies together
    heights : (car centre down to secondary, secondary down to bogie centre, bogie centre down to primary), m
    The springs' axes turn with the bogie (secondary) and with the axle (primary).
    """
    (car_mass, car_inertia), (bogie_mass, bogie_inertia) = car, bogies
    upper, middle, lower = heights
    slide = np.array([1.0, -upper, -1.0, -middle])  # secondary shear over (y car, roll car, y bogie, roll bogie)
    lean = np.array([0.0, 1.0, 0.0, -1.0])
    shift = np.array([0.0, 0.0, 1.0, -lower])
    roll = np.array([0.0, 0.0, 0.0, 1.0])
    stiffness = secondary.lateral * np.outer(slide, slide) + primary.lateral * np.outer(shift, shift)
    stiffness += (secondary.vertical * secondary.half_spacing**2 + secondary.roll) * np.outer(lean, lean)
    stiffness += (primary.vertical * primary.half_spacing**2 + primary.roll) * np.outer(roll, roll)
    # The car's weight acts along the bogie's vertical: potential W (-roll_b slide - h_c roll_c^2/2 - h_b roll_b^2/2).
    weight = car_mass * gravity
    stiffness -= weight * (np.outer(roll, slide) + np.outer(slide, roll))
    stiffness -= weight * np.diag([0.0, upper, 0.0, middle])
    stiffness -= (weight + bogie_mass * gravity) * lower * np.outer(roll, roll)
    return frequencies(np.diag([car_mass, car_inertia, bogie_mass, bogie_inertia]), stiffness)


def wheel_load(car_mass, bogie_mass, own_mass, gravity=GRAVITY):
    """Static load of one wheel of a symmetric four-axle coach, N.

    Moment balance: each bogie carries half the car, each of its two axles half of that and of the bogie, each wheel
    half of its axle; `own_mass` is the wheelset with its axleboxes and all links that hang on them and on the frame.
    """
    return gravity * (car_mass / 8.0 + bogie_mass / 4.0 + own_mass / 2.0)
