# SPDX-License-Identifier: BSD-3-Clause
"""What all drawings share: colours, line styles, axes, labels at line ends.

Matplotlib is imported inside the functions, so that ``import railsym`` stays quick.
"""

from __future__ import annotations

from itertools import cycle, islice

import numpy as np

KMH = 3.6      # km/h of 1 m/s

# Okabe and Ito, Color Universal Design (2008), without the yellow, which is too pale for a line on white
BLACK, ORANGE, SKY, GREEN, BLUE, VERMILION, PURPLE = (
    "#000000", "#E69F00", "#56B4E9", "#009E73", "#0072B2", "#D55E00", "#CC79A7")
GREY, PALE = "#8a8a8a", "#c9c9c9"
_COLOURS = (BLACK, BLUE, VERMILION, GREEN, ORANGE, SKY, PURPLE, GREY)
_MARKERS = "osD^vPX*"
_DASHES = ("-", (0, (5, 2)), (0, (1.5, 1.5)), (0, (6, 2, 1.5, 2)), (0, (8, 2, 2, 2, 2, 2)))      # five for eight colours: 40 combinations


def line_styles(names):
    """Matplotlib line properties by name: colour, marker and dashes differ, so each alone tells the lines apart.

    Parameters
    ----------
    names : sequence of str

    Returns
    -------
    dict of str to dict
    """
    count = len(names)
    parts = zip(names, islice(cycle(_COLOURS), count), islice(cycle(_MARKERS), count), islice(cycle(_DASHES), count))
    return {name: {"color": colour, "marker": marker, "linestyle": dashes, "markersize": 4.5, "linewidth": 1.5}
            for name, colour, marker, dashes in parts}


def new_axes(axes=None, rows=1, columns=1, size=(6.4, 4.2), **options):
    """Axes to draw on: those given, or those of a new figure of ``size`` (inches), as an array (rows, columns).

    Raises
    ------
    ValueError
        If other axes are given than the drawing needs.
    """
    if axes is None:
        import matplotlib.pyplot as plt

        _, made = plt.subplots(rows, columns, figsize=size, layout="constrained", squeeze=False, **options)
        return made
    given = np.atleast_1d(np.asarray(axes, dtype=object)).ravel()
    if given.size != rows * columns:
        raise ValueError(f"{rows * columns} axes are needed, {given.size} were given; leave axes out for a new figure")
    return given.reshape(rows, columns)


def tidy(axes, xlabel="", ylabel="", title=""):
    """Labels, a light grid, no box."""
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    if title:
        axes.set_title(title, loc="left", fontsize=10, pad=9)
    axes.grid(True, color="#e6e6e6", linewidth=0.7)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def label_line_ends(axes, labels, fontsize=8):
    """Write each label beside its line's end, apart from each other by a line's height.

    Parameters
    ----------
    axes : matplotlib Axes
        With its final limits.
    labels : list of (x, y, text, colour)
        Data coordinates of the ends.
    """
    if not labels:
        return
    from matplotlib.patheffects import withStroke

    points = axes.transData.transform([(x, y) for x, y, _, _ in labels])
    height = 1.35 * fontsize * axes.figure.dpi / 72.0
    low, high = axes.bbox.y0, axes.bbox.y1
    order = np.argsort(points[:, 1])
    place = spread(points[order, 1], height, low, high)
    for i, y in zip(order, place):
        x_data, y_data, text, colour = labels[i]
        axes.annotate(text, (x_data, y_data), (6, (y - points[i, 1]) * 72.0 / axes.figure.dpi), textcoords="offset points",
                      color=colour, fontsize=fontsize, va="center", annotation_clip=False, zorder=6,
                      path_effects=[withStroke(linewidth=2.5, foreground="white", alpha=0.85)])


def spread(positions, distance, low=-np.inf, high=np.inf):
    """Ascending positions moved apart to at least ``distance``, with the least squares of shifts, within low..high."""
    groups = []
    for position in positions:
        groups.append([position, 1])          # centre and size of a run of touching labels
        while len(groups) > 1:
            (a, m), (b, n) = groups[-2:]
            if b - a >= 0.5 * (m + n) * distance:
                break
            # members stand `distance` apart: the run's centre is the mean of where each would centre it
            groups[-2:] = [[(m * (a + 0.5 * n * distance) + n * (b - 0.5 * m * distance)) / (m + n), m + n]]
    result = np.concatenate([centre + distance * (np.arange(size) - 0.5 * (size - 1)) for centre, size in groups])
    for i in range(len(result)):
        result[i] = max(result[i], low + (i + 0.5) * distance)
    for i in range(len(result))[::-1]:
        result[i] = min(result[i], high - (len(result) - i - 0.5) * distance)
    return result


def criterion_text(criterion):
    """"real part = 0" or "damping ratio = 5 %" for a criterion given as a damping ratio."""
    return f"damping ratio = {100 * criterion:g} %" if criterion else "real part = 0"


def save(axes, path):
    """Save the figure that ``axes`` (an Axes or array of them) belong to, and close it."""
    import matplotlib.pyplot as plt

    figure = np.atleast_1d(np.asarray(axes, dtype=object)).ravel()[0].figure
    figure.savefig(path, dpi=150)
    plt.close(figure)
