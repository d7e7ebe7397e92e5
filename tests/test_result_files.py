# SPDX-License-Identifier: BSD-3-Clause
"""Runs in files: what is written is what is read, and nothing that was there is lost."""

import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import railsym as rs
from railsym.results import Channel, ChannelWriter, Ending, ResultError, ResultFileError, RunInfo
from railsym.results.matlab import valid_names

INFO = RunInfo(vehicle="pendolino", configuration="noAS_K", parameters={"anti_yaw_damper.series_stiffness": 4e6, "x": [0.1, 1e-300]}, track="switch",
               speed=0.1 + 0.2, time_step=1e-3, creep_law="fastsim", message="wheel climb, \"quoted\", größer",
               ending=Ending("derailed", "wheelset3.left", 1.204, 72.24), extra={"wheel_loads": {"wheelset1.left": 55e3}})
CHANNELS = [Channel("bogie1.y", "m", "lateral position, to the right", "[9.5, 0, -0.55] m"), Channel("wheelset1.left.YQ", "-"),
            Channel("bogie1_y", "m/s^2")]
ODD = np.array([0.0, -0.0, 5e-324, -1.7976931348623157e308, np.inf, -np.inf, 0.1, 1 / 3])
EVERY = (("to_netcdf", "from_netcdf", "nc"), ("to_csv", "from_csv", "csv"), ("to_mat", "from_mat", "mat"))


def odd_run():
    return rs.Run(np.cumsum(np.arange(1, 9) / 3), {"bogie1.y": ODD, "wheelset1.left.YQ": ODD[::-1], "bogie1_y": np.full(8, np.nan)}, CHANNELS, INFO)


def same(one, other):
    assert list(one.channels.values()) == list(other.channels.values())
    assert one.info == other.info
    for name in ("time", *one.channels):
        assert one[name].tobytes() == other[name].tobytes(), name


@pytest.mark.parametrize("write, read, suffix", EVERY)
def test_round_trip_bit_for_bit(tmp_path, write, read, suffix):
    run, path = odd_run(), tmp_path / f"run.{suffix}"
    getattr(run, write)(path)
    same(run, getattr(rs.Run, read)(path))
    assert os.listdir(tmp_path) == [path.name]


@pytest.mark.parametrize("write, read, suffix", EVERY)
def test_round_trip_of_a_run_without_samples(tmp_path, write, read, suffix):
    run, path = rs.Run([], np.empty((0, 3)), CHANNELS, INFO), tmp_path / f"run.{suffix}"
    getattr(run, write)(path)
    same(run, getattr(rs.Run, read)(path))


@settings(max_examples=20, deadline=None)
@given(values=arrays(np.float64, (5, 3), elements=st.floats(allow_nan=False, width=64)), speed=st.floats(0, 1e3),
       text=st.text(max_size=20))
def test_any_number_and_text_survives_netcdf_and_csv(tmp_path_factory, values, speed, text):
    folder = tmp_path_factory.mktemp("any")
    run = rs.Run(np.arange(5.0), values, CHANNELS, RunInfo(speed=speed, message=text.replace("\x00", ""), parameters={"p": speed}))
    run.to_netcdf(folder / "a.nc")
    same(run, rs.Run.from_netcdf(folder / "a.nc"))
    run.to_csv(folder / "a.csv")
    same(run, rs.Run.from_csv(folder / "a.csv"))


def test_netcdf_is_read_by_xarray_and_by_channel(tmp_path):
    import xarray

    run, path = odd_run(), tmp_path / "run.nc"
    run.to_netcdf(path)
    with xarray.open_dataset(path) as dataset:
        assert dataset["bogie1.y"].attrs["units"] == "m" and dataset.attrs["ending"].startswith("derailed (wheelset3.left)")
        assert dataset.attrs["message"].strip() == INFO.message
        np.testing.assert_array_equal(dataset["bogie1.y"], ODD)
        np.testing.assert_array_equal(dataset["time"], run.time)
        assert dataset["time"].dtype == float
    assert list(rs.Run.from_netcdf(path, "bogie1.*").channels) == ["bogie1.y"]
    with pytest.raises(KeyError, match=r"no channel fits 'car\.\*'"):
        rs.Run.from_netcdf(path, "car.*")
    made = run.to_xarray()
    assert made["bogie1.y"].attrs["place"] == "[9.5, 0, -0.55] m" and made.sizes == {"time": 8}
    made["bogie1.y"][0] = 1.0  # a copy: the run stays as it is
    assert run["bogie1.y"][0] == 0.0


def test_csv_of_another_program(tmp_path):
    path = tmp_path / "measured.csv"
    path.write_text("\ufefftime [s], frame.ay [m/s^2]\r\n0, 1.5\r\n0.01,-2\r\n", encoding="utf-8")
    run = rs.Run.from_csv(path)
    np.testing.assert_array_equal(run["frame.ay"], [1.5, -2.0])
    for text, message in (("t,a\n1,2\n", "heading 't' is not a name with a unit"), ("# x\n", "no heading line"),
                          ("t [s],a [m]\n", r"'time \[s\]' is needed"),
                          ("time [s],a [m]\n1,2,3\n", "the table cannot be read"), ("time [s],a [m]\n1,x\n", "the table cannot be read")):
        path.write_text(text)
        with pytest.raises(ResultFileError, match=message):
            rs.Run.from_csv(path)


def test_matlab_names_are_valid_and_all_different(tmp_path):
    from scipy.io import loadmat

    names = ["bogie1.y", "bogie1_y", "_a", "time_", "units", "x" * 80, "x" * 81]
    made = valid_names(names)
    assert made[:5] == ["bogie1_y", "bogie1_y_2", "x_a", "time_", "units_2"]
    assert len(set(made)) == 7 and all(len(n) <= 63 and n.isidentifier() for n in made)
    odd_run().to_mat(tmp_path / "run.mat")
    content = loadmat(tmp_path / "run.mat")
    assert [str(c[0]) for c in content["channel_names"].ravel()] == [c.name for c in CHANNELS]
    np.testing.assert_array_equal(content["bogie1_y"].ravel(), ODD)


@pytest.mark.parametrize("write, read, suffix", EVERY)
def test_unwritable_paths_are_refused_and_named(tmp_path, write, read, suffix):
    run = odd_run()
    with pytest.raises(ResultFileError, match="there is no directory"):
        getattr(run, write)(tmp_path / "nowhere" / f"run.{suffix}")
    with pytest.raises(ResultFileError, match="is a directory"):
        getattr(run, write)(tmp_path)
    with pytest.raises(OSError, match="run2"):
        getattr(rs.Run, read)(tmp_path / f"run2.{suffix}")
    (tmp_path / f"bad.{suffix}").write_bytes(b"\x00\x01 no such file format")
    with pytest.raises(ResultFileError, match="bad"):
        getattr(rs.Run, read)(tmp_path / f"bad.{suffix}")


FULL = """
import resource, sys, numpy as np, railsym as rs
from railsym.results import Channel, ResultFileError
run = rs.Run(np.arange(100_000.0), np.random.default_rng(0).normal(size=(100_000, 4)), [Channel(n, "m") for n in "abcd"])
resource.setrlimit(resource.RLIMIT_FSIZE, (500_000, 500_000))
try:
    getattr(run, sys.argv[2])(sys.argv[1])
except ResultFileError as error:
    print(error)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="file size limits are POSIX")
@pytest.mark.parametrize("write, read, suffix", EVERY)
def test_a_full_disk_leaves_the_old_file(tmp_path, write, read, suffix):
    """A limit on the size of files stands in for the disk: writing fails in the middle, as it does when the disk is full."""
    path = tmp_path / f"run.{suffix}"
    getattr(odd_run(), write)(path)
    before = path.read_bytes()
    done = subprocess.run([sys.executable, "-c", FULL, str(path), write], capture_output=True, text=True, cwd=tmp_path, timeout=60)
    assert done.returncode == 0, done.stderr
    assert "was not written" in done.stdout and f"the file of that name is as it was ({len(before)} bytes)" in done.stdout
    assert path.read_bytes() == before and os.listdir(tmp_path) == [path.name]


def blocks(count=1000, size=7):
    rng = np.random.default_rng(2)
    time, values = np.arange(count) * 1e-3, rng.normal(size=(count, 3))
    return time, values, [slice(k, k + size) for k in range(0, count, size)]


def test_written_in_blocks_is_the_same_as_written_at_once(tmp_path):
    time, values, rows = blocks()
    with ChannelWriter(tmp_path / "run.nc", CHANNELS, INFO, block=64) as writer:
        writer.write(time[0], values[0])
        for row in rows:
            row = slice(max(row.start, 1), row.stop)
            writer.write(time[row], values[row])
        writer.finish(INFO.ending)
    same(rs.Run.from_netcdf(tmp_path / "run.nc"), rs.Run(time, values, CHANNELS, INFO))
    with pytest.raises(ResultError, match="is closed"):
        writer.write(2.0, values[0])


def test_metadata_that_grow_beyond_their_room(tmp_path):
    """A message longer than the room that the header left for it: the records move behind a longer header."""
    time, values, _ = blocks()
    long = "x" * 100_000
    with ChannelWriter(tmp_path / "run.nc", CHANNELS, INFO, block=64) as writer:
        writer.write(time, values)
        writer.finish(INFO.ending, message=long)
    same(rs.Run.from_netcdf(tmp_path / "run.nc"), rs.Run(time, values, CHANNELS, INFO.ended(INFO.ending, long)))
    assert os.listdir(tmp_path) == ["run.nc"]


STREAM = """
import resource, sys, numpy as np
from railsym.results import Channel, ChannelWriter, ResultFileError
resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
writer = ChannelWriter(sys.argv[1], [Channel(n, "m") for n in "abc"], block=100)
try:
    for k in range(100):
        time = (np.arange(100) + 100 * k) * 1e-3
        writer.write(time, np.column_stack([time, 2 * time, 3 * time]))
except ResultFileError as error:
    print(error)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="file size limits are POSIX")
def test_a_disk_that_fills_up_during_a_run_leaves_what_was_written(tmp_path):
    path = tmp_path / "run.nc"
    done = subprocess.run([sys.executable, "-c", STREAM, str(path)], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    run = rs.Run.from_netcdf(tmp_path / "run.nc.part")
    # 100,000 bytes less the header hold between 28 and 29 blocks of 100 samples of 32 bytes
    assert len(run) == 2900 or len(run) == 2800
    assert f"writing stopped after {len(run)} samples: File too large" in done.stdout
    np.testing.assert_array_equal(run["c"], 3 * run.time)
    assert run.status == "interrupted" and not path.exists()


@pytest.mark.parametrize("engine", ["netcdf4", "scipy"])
def test_other_libraries_read_the_file(tmp_path, engine):
    """The netCDF C library reads what is written without it."""
    import xarray

    time, values, rows = blocks()
    with ChannelWriter(tmp_path / "run.nc", CHANNELS, INFO, block=100) as writer:
        for row in rows:
            writer.write(time[row], values[row])
    with xarray.open_dataset(tmp_path / "run.nc", engine=engine) as dataset:
        assert dataset.sizes == {"time": 1000} and list(dataset.data_vars) == [channel.name for channel in CHANNELS]
        for k, channel in enumerate(CHANNELS):
            np.testing.assert_array_equal(dataset[channel.name], values[:, k])
            assert dataset[channel.name].attrs["units"] == channel.unit
        assert dataset.attrs["vehicle"] == "pendolino" and dataset.attrs["ending"].strip() == "completed at t = 0.999 s"


@pytest.mark.parametrize("error, detail", [(KeyboardInterrupt(), "by the user"), (ZeroDivisionError("in the controller"), "in the controller")])
def test_an_interrupted_run_keeps_its_data(tmp_path, error, detail):
    time, values, _ = blocks()
    with pytest.raises(type(error)):
        with ChannelWriter(tmp_path / "run.nc", CHANNELS, INFO, block=64) as writer:
            writer.write(time[:333], values[:333])
            raise error
    run = rs.Run.from_netcdf(tmp_path / "run.nc")
    assert run.status == "interrupted" and detail in str(run.info.ending) and run.info.ending.time == time[332]
    np.testing.assert_array_equal(run["bogie1.y"], values[:333, 0])


KILLED = """
import os, signal, sys, numpy as np
from railsym.results import Channel, ChannelWriter
writer = ChannelWriter(sys.argv[1], [Channel(n, "m") for n in "abc"], block=50)
time = np.arange(230) * 1e-3
writer.write(time, np.column_stack([time, 2 * time, 3 * time]))
os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL is POSIX")
def test_a_killed_run_keeps_its_blocks_and_the_old_file(tmp_path):
    path = tmp_path / "run.nc"
    odd_run().to_netcdf(path)
    for k in range(2):
        done = subprocess.run([sys.executable, "-c", KILLED, str(path)], timeout=60)
        assert done.returncode == -signal.SIGKILL
    same(rs.Run.from_netcdf(path), odd_run())
    for part in ("run.nc.part", "run.nc.part2"):
        run = rs.Run.from_netcdf(tmp_path / part)
        assert len(run) == 200 and run.status == "interrupted" and "before the file was finished" in str(run.info.ending)
        np.testing.assert_array_equal(run["c"], 3 * run.time)
    os.unlink(path)
    with pytest.raises(ResultFileError, match=r"a run that was not finished left .*run\.nc\.part, .*run\.nc\.part2"):
        rs.Run.from_netcdf(path)


def test_a_run_that_wrote_nothing_yet_can_be_read(tmp_path):
    writer = ChannelWriter(tmp_path / "run.nc", CHANNELS, INFO)
    writer.write(0.0, [1.0, 2.0, 3.0])
    assert len(rs.Run.from_netcdf(writer.part)) == 0
    writer.flush()
    assert len(rs.Run.from_netcdf(writer.part)) == 1
    writer.finish()


def test_a_writer_refuses_what_does_not_fit(tmp_path):
    with ChannelWriter(tmp_path / "run.nc", CHANNELS) as writer:
        with pytest.raises(ResultError, match=r"\(1, 3\) is needed"):
            writer.write(0.0, [1.0, 2.0])
        writer.write([0.0, 1.0], np.zeros((2, 3)))
        with pytest.raises(ResultError, match="1 s is followed by 1 s"):
            writer.write(1.0, np.zeros(3))
        with pytest.raises(ResultError, match="time does not increase"):
            writer.write([2.0, np.nan], np.zeros((2, 3)))
    assert len(rs.Run.from_netcdf(tmp_path / "run.nc")) == 2


MEMORY = r"""
import re, sys, numpy as np
from railsym.results import Channel, ChannelWriter

def peak():
    return int(re.search(r"VmHWM:\s*(\d+) kB", open("/proc/self/status").read())[1])

names = [Channel(f"c{k}", "m") for k in range(100)]
values = np.random.default_rng(0).normal(size=(1000, 100))
peaks = []
with ChannelWriter(sys.argv[1], names, block=1000) as writer:
    for block in range(60):
        writer.write((np.arange(1000) + 1000 * block) * 1e-3, values)
        if block in (9, 59):
            peaks.append(peak())
print(*peaks)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_memory_of_a_minute_of_a_hundred_channels_is_constant(tmp_path):
    done = subprocess.run([sys.executable, "-c", MEMORY, str(tmp_path / "run.nc")], capture_output=True, text=True, check=True, timeout=60)
    early, late = map(int, done.stdout.split())
    assert (tmp_path / "run.nc").stat().st_size > 48e6
    assert late - early < 10_000 and late < 200_000  # kB


def test_a_missing_package_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(ImportError, match=r"pip install 'railsym\[io\]'; netCDF, CSV and \.mat files need no further package"):
        odd_run().to_xarray()


def test_netcdf_of_something_else_is_refused(tmp_path):
    from scipy.io import netcdf_file

    with netcdf_file(tmp_path / "other.nc", "w") as dataset:
        dataset.title = "weather"
    with pytest.raises(ResultFileError, match="not a run of railsym: it has no attribute railsym_format; there are title"):
        rs.Run.from_netcdf(tmp_path / "other.nc")
    (tmp_path / "hdf.nc").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
    with pytest.raises(ResultFileError, match=r"it is netCDF-4 \(HDF5\)"):
        rs.Run.from_netcdf(tmp_path / "hdf.nc")
    for cut in (0, 3, 40, 200, -8):
        odd_run().to_netcdf(tmp_path / "run.nc")
        (tmp_path / "cut.nc").write_bytes((tmp_path / "run.nc").read_bytes()[:cut])
        with pytest.raises(ResultFileError, match="cut.nc cannot be read"):
            rs.Run.from_netcdf(tmp_path / "cut.nc")
