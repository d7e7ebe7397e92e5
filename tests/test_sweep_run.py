# SPDX-License-Identifier: BSD-3-Clause
"""Running studies: the same bytes by any number of workers, nothing lost, nothing mixed."""

import os
import subprocess
import sys
import textwrap
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from sweep_analysis import Logged, numbers

import railsym as rs
from railsym import sweep
from railsym.sweep.journal import Journal, journal_of
from railsym.sweep.run import header_of

TESTS = Path(__file__).parent
FACTORS = {"contact.conicity": sweep.Grid(0.2, 0.4, 4), "wheelset.mass": sweep.Normal(100, 5, unit="%")}


def speeds(cases=12, **changes):
    """A small study of critical speeds."""
    return rs.Study("wheelset", sweep.CriticalSpeed(), FACTORS, sweep.LatinHypercube(cases), **{"seed": 1} | changes)


def logged(folder, cases=30, **options):
    """A study that logs its cases: x = 0, 1, 2, ..."""
    return rs.Study("wheelset", Logged(log=str(folder / "log"), **options), {"x": [float(k) for k in range(cases)]}, sweep.FullGrid())


def script(folder, *lines):
    """Run Python in a process of its own, with the study of `logged` at hand; returns what it prints."""
    head = ["import resource, sys", "from pathlib import Path", "import railsym as rs", "from railsym import sweep", "from test_sweep_run import logged",
            f"folder = Path({str(folder)!r})"]
    done = subprocess.run([sys.executable, "-c", "\n".join([*head, *map(textwrap.dedent, lines)])], capture_output=True, text=True,
                          env=os.environ | {"PYTHONPATH": str(TESTS)})
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_outputs_are_those_of_critical_speed(tmp_path):
    results = speeds().run(tmp_path / "r.nc")
    for k in range(0, 12, 5):
        case = results.study.case(k)
        found = rs.critical_speed(case.vehicle, case.settings["contact.conicity"])
        # both polish by Newton's method until a step below 1e-7, which leaves its square; they sum in different orders
        np.testing.assert_allclose(results["speed"][k], found.speed.filled(np.nan), rtol=1e-11)
        assert case.vehicle.parameters["wheelset.mass"].value == results["wheelset.mass"][k]
    assert (results.status == "done").all() and not results.errors and results.unit("speed") == "m/s"


def test_bytes_do_not_depend_on_workers(tmp_path):
    for workers in (1, 2):
        speeds().run(tmp_path / f"{workers}.nc", workers=workers)
    assert (tmp_path / "1.nc").read_bytes() == (tmp_path / "2.nc").read_bytes()


def test_a_store_is_read_back(tmp_path):
    results = speeds().run(tmp_path / "r.nc")
    again = sweep.load(tmp_path / "r.nc")
    assert again.study.hash == results.study.hash
    for name in (*results.names, *results.outputs):
        np.testing.assert_array_equal(again[name], results[name])


def test_other_programs_read_the_store(tmp_path):
    xarray = pytest.importorskip("xarray")
    results = logged(tmp_path, 6, fail=(2.0,)).run(tmp_path / "r.nc")
    with xarray.open_dataset(tmp_path / "r.nc", engine="netcdf4") as file:
        np.testing.assert_array_equal(file["y"], results["y"])
        assert file["word"].values[5] == b"x is 5" and file["y"].attrs["units"] == "-"
        assert file["error_case"].values.tolist() == [2] and file["error_text"].values[0].decode() == results.errors[2]


def test_a_failing_case_is_recorded_and_the_study_goes_on(tmp_path):
    results = logged(tmp_path, fail=(4.0, 17.0)).run(tmp_path / "r.nc")
    assert results.errors == {4: "ValueError: x = 4 will not do (in solve)", 17: "ValueError: x = 17 will not do (in solve)"}
    assert results.message == "30 cases: 28 done, 2 failed" and np.isnan(results["y"][4]) and results["y"][18] == 324.0
    assert sweep.load(tmp_path / "r.nc").errors == results.errors


def test_a_complete_study_computes_nothing(tmp_path):
    study = logged(tmp_path, 5, fail=(1.0,))
    study.run(tmp_path / "r.nc")
    study.run(tmp_path / "r.nc")
    assert numbers(tmp_path / "log") == [0.0, 1.0, 2.0, 3.0, 4.0]


def test_failed_cases_alone_are_tried_again(tmp_path):
    """Where the reason was the machine's (a licence, a mount): the analysis has no setting that says so, so the log is swapped."""
    study = logged(tmp_path, 5)
    (tmp_path / "log").mkdir()                        # no log can be written: every case fails
    assert len(study.run(tmp_path / "r.nc").errors) == 5
    (tmp_path / "log").rmdir()
    results = study.run(tmp_path / "r.nc", retry_failed=True)
    assert results.message == "5 cases: 5 done" and not results.errors and not sweep.load(tmp_path / "r.nc").errors
    study.run(tmp_path / "r.nc", retry_failed=True)
    assert len(numbers(tmp_path / "log")) == 5


@pytest.mark.parametrize("cut", [1, 7, 60, 200])
def test_a_torn_journal_loses_the_torn_chunk_alone(tmp_path, cut):
    study = logged(tmp_path, 10)
    study.run(tmp_path / "whole.nc")
    with pytest.raises(KeyboardInterrupt):
        interrupted(study, tmp_path / "r.nc", 6)
    journal = journal_of(tmp_path / "r.nc")
    whole = journal.read_bytes()
    journal.write_bytes(whole[:-cut])
    before = (sweep.load(tmp_path / "r.nc").status == "done").sum()
    assert 0 < before < 6
    (tmp_path / "log").unlink()
    results = study.run(tmp_path / "r.nc")
    assert len(numbers(tmp_path / "log")) == 10 - before and results.complete
    assert (tmp_path / "r.nc").read_bytes() == (tmp_path / "whole.nc").read_bytes() and not journal.exists()


def test_damage_inside_a_journal_costs_what_was_damaged(tmp_path):
    study = logged(tmp_path, 10)
    with pytest.raises(KeyboardInterrupt):
        interrupted(study, tmp_path / "r.nc", 6)
    journal = journal_of(tmp_path / "r.nc")
    whole = bytearray(journal.read_bytes())
    third = [place for place in range(len(whole)) if whole[place:place + 4] == b"RSJ1"][3]
    whole[third + 20] ^= 0xFF
    journal.write_bytes(whole)
    assert (sweep.load(tmp_path / "r.nc").status == "done").tolist() == [True, True, False, True, True, True, False, False, False, False]
    assert study.run(tmp_path / "r.nc").complete


def interrupted(study, path, after):
    """Run a study case by case, and end it by Ctrl-C after some."""
    from railsym.sweep import dispatch, journal

    append, calls = journal.Journal.append, []

    def counting(self, chunk):
        if len(calls) == after:
            raise KeyboardInterrupt
        calls.append(chunk)
        append(self, chunk)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(journal.Journal, "append", counting)
        patch.setattr(dispatch, "_MOST", 1)
        study.run(path)


def test_another_study_is_refused_and_the_store_intact(tmp_path):
    speeds().run(tmp_path / "r.nc")
    before = (tmp_path / "r.nc").read_bytes()
    with pytest.raises(sweep.StoreError, match="another study.*study.seed there: 1, here: 2"):
        speeds(seed=2).run(tmp_path / "r.nc")
    assert (tmp_path / "r.nc").read_bytes() == before


def test_a_journal_of_another_study_is_refused_and_intact(tmp_path):
    with pytest.raises(KeyboardInterrupt):
        interrupted(logged(tmp_path, 10), tmp_path / "r.nc", 3)
    before = journal_of(tmp_path / "r.nc").read_bytes()
    with pytest.raises(sweep.StoreError, match="another study"):
        logged(tmp_path, 11).run(tmp_path / "r.nc")
    assert journal_of(tmp_path / "r.nc").read_bytes() == before


@pytest.mark.parametrize("content", [b"hello, world", b"CDF\x02garbage"])
def test_a_file_that_is_no_store_is_refused_and_intact(tmp_path, content):
    for path in (tmp_path / "r.nc", journal_of(tmp_path / "s.nc")):
        path.write_bytes(content)
        with pytest.raises(sweep.StoreError, match="cannot be read as a store|not a journal"):
            logged(tmp_path).run(tmp_path / path.name.removesuffix(".journal"))
        assert path.read_bytes() == content


def test_results_of_two_versions_are_not_mixed(tmp_path, monkeypatch):
    with pytest.raises(KeyboardInterrupt):
        interrupted(logged(tmp_path, 10), tmp_path / "r.nc", 3)
    monkeypatch.setitem(vars(rs), "__version__", "99.0")
    with pytest.raises(sweep.StoreError, match="begun by railsym .* this is 99.0"):
        logged(tmp_path, 10).run(tmp_path / "r.nc")


def test_two_runs_on_one_store(tmp_path):
    study = logged(tmp_path, 3)
    with closing(Journal(tmp_path / "r.nc", header_of(study))):
        with pytest.raises(sweep.StoreError, match="being computed by another run"):
            study.run(tmp_path / "r.nc")
    assert study.run(tmp_path / "r.nc").complete


def test_a_full_disk_stops_the_study_and_keeps_what_it_has(tmp_path):
    logged(tmp_path, 200).run(tmp_path / "whole.nc")
    (tmp_path / "log").unlink()
    said = script(tmp_path, "from railsym.sweep import dispatch; dispatch._MOST = 3",
                  "resource.setrlimit(resource.RLIMIT_FSIZE, (6000, resource.RLIM_INFINITY))",
                  """
                  try:
                      logged(folder, 200).run(folder / 'r.nc')
                  except sweep.StoreError as error:
                      print(error)
                  """)
    assert "cannot take more results: File too large. What it holds is intact" in said
    done = int((sweep.load(tmp_path / "r.nc").status == "done").sum())
    begun = len(numbers(tmp_path / "log"))
    assert 0 < begun - 3 <= done < 200              # at most the chunk that found no room is computed again
    logged(tmp_path, 200).run(tmp_path / "r.nc")
    assert len(numbers(tmp_path / "log")) == begun + 200 - done
    assert (tmp_path / "r.nc").read_bytes() == (tmp_path / "whole.nc").read_bytes()


def test_a_disk_too_full_for_the_store_keeps_the_journal(tmp_path, monkeypatch):
    study = logged(tmp_path, 200)
    with monkeypatch.context() as patch:
        patch.setattr(Journal, "remove", lambda self: None)
        study.run(tmp_path / "r.nc")
    (tmp_path / "r.nc").rename(tmp_path / "whole.nc")
    before = journal_of(tmp_path / "r.nc").read_bytes()
    said = script(tmp_path, "resource.setrlimit(resource.RLIMIT_FSIZE, (3000, resource.RLIM_INFINITY))",
                  """
                  try:
                      logged(folder, 200).run(folder / 'r.nc')
                  except sweep.StoreError as error:
                      print(error)
                  """)
    assert "All results are in the journal" in said and journal_of(tmp_path / "r.nc").read_bytes() == before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["log", "r.nc.journal", "whole.nc"]
    study.run(tmp_path / "r.nc")
    assert len(numbers(tmp_path / "log")) == 200 and (tmp_path / "r.nc").read_bytes() == (tmp_path / "whole.nc").read_bytes()


def test_a_case_that_ends_its_worker_is_recorded(tmp_path):
    results = logged(tmp_path, 40, die=(11.0,), seconds=0.003).run(tmp_path / "r.nc", workers=2)
    assert list(results.errors) == [11] and "ended without a word" in results.errors[11]
    assert results.message == "40 cases: 39 done, 1 failed" and results["y"][39] == 39.0**2


def test_a_worker_that_is_lost_once_costs_no_case(tmp_path):
    results = logged(tmp_path, 40, die_once=(11.0,), seconds=0.003).run(tmp_path / "r.nc", workers=2)
    assert results.message == "40 cases: 40 done"


def test_workers_that_never_finish_a_case_stop_the_study(tmp_path):
    with pytest.raises(sweep.WorkersLostError, match="before any case is finished"):
        logged(tmp_path, 20, die=tuple(map(float, range(20)))).run(tmp_path / "r.nc", workers=2)
    assert (sweep.load(tmp_path / "r.nc").status == "missing").all()         # it is not the cases' fault


def test_an_executor_of_ones_own(tmp_path):
    """Also one without initializer, whose workers learn of the study from the chunks."""
    from concurrent.futures import ThreadPoolExecutor

    logged(tmp_path).run(tmp_path / "1.nc")
    with ThreadPoolExecutor(2) as executor:
        logged(tmp_path).run(tmp_path / "2.nc", executor=executor)
    assert (tmp_path / "1.nc").read_bytes() == (tmp_path / "2.nc").read_bytes()


class Counting:
    """An executor in this process that counts how often the study travels; every so often it works as a worker that has just come."""

    def __init__(self, new_every=None):
        self.calls = self.travelled = 0
        self.new_every = new_every

    def submit(self, function, key, version, payload, *rest):
        from concurrent.futures import Future

        from railsym.sweep import worker

        self.calls += 1
        self.travelled += payload is not None
        if self.new_every and self.calls % self.new_every == 0:
            worker._studies.clear()
        future = Future()
        try:
            future.set_result(function(key, version, payload, *rest))
        except Exception as error:
            future.set_exception(error)
        return future


def test_the_study_travels_once_to_a_worker(tmp_path, monkeypatch):
    monkeypatch.setattr("railsym.sweep.dispatch._MOST", 1)
    study = logged(tmp_path, 60)
    study.run(tmp_path / "whole.nc")
    steady, changing = Counting(), Counting(new_every=10)
    for name, executor in (("steady", steady), ("changing", changing)):
        executor._max_workers = 1
        study.run(tmp_path / f"{name}.nc", executor=executor)
        assert (tmp_path / f"{name}.nc").read_bytes() == (tmp_path / "whole.nc").read_bytes()
    assert steady.calls == 60 and steady.travelled == 2            # with the two chunks that may be under way at once
    again = changing.calls - 60
    assert 0 < again <= 2 * (changing.calls // 10) and changing.travelled == 2 + again


@pytest.mark.parametrize("what, words", [({"workers": 0}, "workers = 0"), ({"executor": "slurm"}, "'mpi' or the address"),
                                         ({"executor": 3}, "executor 3")])
def test_places_that_are_none(tmp_path, what, words):
    with pytest.raises(sweep.SweepError, match=words):
        logged(tmp_path).run(tmp_path / "r.nc", **what)
    assert not (tmp_path / "r.nc").exists()
