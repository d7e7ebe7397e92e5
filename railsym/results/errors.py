# SPDX-License-Identifier: BSD-3-Clause
"""Errors of results and of their files, and the optional packages that files need."""

from importlib import import_module

from railsym.errors import RailsymError


class ResultError(RailsymError, ValueError):
    """Channels, times or metadata that do not make a result, or a question that a result cannot answer."""


class UnknownChannelError(RailsymError, KeyError):
    """A channel name that the result does not have; the message gives near names and what there is."""

    def __str__(self):
        return self.args[0]  # KeyError shows its argument in quotes, with the line breaks escaped


class ResultFileError(RailsymError, OSError):
    """A file of results that cannot be written or read; what was there before is untouched."""


class MissingPackageError(RailsymError, ImportError):
    """An optional package that is not installed; the message says how to install it."""


def optional(package, what):
    """An optional package, imported now.

    Raises
    ------
    MissingPackageError
    """
    try:
        return import_module(package)
    except ImportError as error:
        raise MissingPackageError(f"{what} needs the package {package}, which is not installed ({error}): pip install 'railsym[io]'; "
                                  "netCDF, CSV and .mat files need no further package") from error
