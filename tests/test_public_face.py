# SPDX-License-Identifier: BSD-3-Clause
"""What ``import railsym`` offers, and what it does not drag in."""

import json
import subprocess
import sys
from types import ModuleType

import pytest

import railsym


def fresh(code, directory):
    """What a new interpreter prints as JSON."""
    done = subprocess.run([sys.executable, "-c", code], cwd=directory, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


@pytest.mark.parametrize("name", railsym.__all__)
def test_every_public_name_exists_and_says_what_it_is(name):
    thing = getattr(railsym, name)
    assert name in dir(railsym)
    if name != "__version__":
        assert thing.__doc__ and len(thing.__doc__.strip()) > 10


def test_functions_are_functions_and_not_the_modules_of_their_names():
    for name in set(railsym.__all__) - {"__version__", *railsym._SUBMODULES}:
        assert callable(getattr(railsym, name)) and not isinstance(getattr(railsym, name), ModuleType)


def test_importing_a_module_first_does_not_hide_the_function(tmp_path):
    code = ("import json, railsym.critical_speed, railsym.stability_map, railsym.sensitivity, railsym.linear_model, railsym as rs\n"
            "print(json.dumps([callable(getattr(rs, n)) for n in ('critical_speed', 'stability_map', 'sensitivity', 'linear_model')]))")
    assert fresh(code, tmp_path) == [True] * 4


def test_import_brings_no_heavy_package(tmp_path):
    code = "import json, sys, railsym; print(json.dumps(sorted({n.split('.')[0] for n in sys.modules})))"
    loaded = fresh(code, tmp_path)
    assert "railsym" in loaded
    assert not {"scipy", "matplotlib", "sympy", "tqdm", "cffi"} & set(loaded)


def test_linearising_needs_no_scipy_interpolation_or_drawing(tmp_path):
    code = ("import json, sys, railsym as rs; rs.linearise(rs.load_vehicle('wheelset'), 30.0)\n"
            "print(json.dumps(sorted({n.split('.')[0] for n in sys.modules})))")
    assert not {"matplotlib", "sympy"} & set(fresh(code, tmp_path))


def test_unknown_name_lists_what_there_is():
    with pytest.raises(AttributeError, match="load_vehicle"):
        railsym.load_vehcle


def test_public_exceptions_are_those_that_people_expect():
    with pytest.raises(ValueError, match="pendolino"):
        railsym.load_vehicle("pendolin")
    assert issubclass(railsym.RailsymError, Exception)
