# SPDX-License-Identifier: BSD-3-Clause
"""Packages whose public names are imported when they are first used, so that importing the package costs next to nothing."""

import sys
from importlib import import_module
from types import ModuleType


class _Package(ModuleType):
    """A public function keeps its place when the module of the same name (`railsym.critical_speed`) is imported."""

    def __setattr__(self, name, value):
        if not (name in self.__dict__.get("_MODULE_OF", ()) and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


def lazy(package, module_of, submodules=()):
    """Make a package's `__getattr__` and `__dir__`.

    Parameters
    ----------
    package : str
        ``__name__`` of the package, whose ``_MODULE_OF`` this is called with.
    module_of : dict of str to str
        Public name to the module inside the package that has it; ``module:name`` where it has another name there.
    submodules : iterable of str
        Modules and packages inside that are public themselves.

    Returns
    -------
    tuple
        ``__getattr__``, ``__dir__``, ``__all__``.
    """
    names = [*module_of, *submodules]
    module = sys.modules[package]

    def get(name):
        if name in submodules:
            return import_module(f"{package}.{name}")
        if name not in module_of:
            raise AttributeError(f"module {package!r} has no attribute {name!r}; it offers {', '.join(names)}")
        place, _, other = module_of[name].partition(":")
        value = getattr(import_module(f"{package}.{place}"), other or name)
        vars(module)[name] = value
        return value

    def listed():
        return sorted({*vars(module), *names})

    module.__class__ = _Package
    return get, listed, names
