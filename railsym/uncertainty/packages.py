# SPDX-License-Identifier: BSD-3-Clause
"""Packages that studies need beyond railsym's own."""

from importlib import import_module

from railsym.results.errors import MissingPackageError


def needed(module, what):
    """A module of such a package, imported now.

    Parameters
    ----------
    module : str
        ``"SALib.sample.sobol"``
    what : str
        What needs it, for the error.

    Raises
    ------
    MissingPackageError
    """
    try:
        return import_module(module)
    except ImportError as error:
        raise MissingPackageError(f"{what} need the package {module.partition('.')[0]}, which cannot be imported ({error}): "
                                  "pip install 'railsym[studies]'") from error
