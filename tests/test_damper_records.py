# SPDX-License-Identifier: BSD-3-Clause
"""Reading of bench records: units, headings, formats; defects named with the test."""

import numpy as np
import pytest

import railsym as rs
from railsym.dampers import Record, RecordError, read_records, shipped_records
from tests.oracles.damper_records import SHIPPED_TESTS, write_csv

TIME = np.arange(0.0, 5.0, 0.002)
MOTION, FORCE = 1e-3 * np.sin(2 * np.pi * TIME), 2e3 * np.cos(2 * np.pi * TIME)


def test_csv_units_are_those_of_the_heading(tmp_path):
    write_csv(tmp_path / "one.csv", TIME, MOTION, FORCE)
    record, = read_records(tmp_path / "one.csv")
    # the file is written to 1e-5 mm and 1e-5 kN
    assert record.name == "one"
    assert np.allclose(record.displacement, MOTION, rtol=0, atol=5.1e-9)
    assert np.allclose(record.force, FORCE, rtol=0, atol=5.1e-3)


def test_semicolons_with_decimal_commas_and_a_velocity(tmp_path):
    rows = ["# bench 3", "Time (ms);Force [N];Displacement [mm];Velocity [mm/s]"]
    rows += [f"{1e3 * t:.1f};{f:.2f};{1e3 * x:.5f};0".replace(".", ",") for t, x, f in zip(TIME, MOTION, FORCE)]
    (tmp_path / "two.csv").write_text("\n".join(rows))
    record, = read_records(tmp_path)
    assert record.time[-1] == pytest.approx(TIME[-1]) and record.velocity is not None
    assert np.allclose(record.force, FORCE, rtol=0, atol=5.1e-3)


def test_matlab_file_and_arrays(tmp_path):
    from scipy.io import savemat

    savemat(tmp_path / "three.mat", {"t": TIME, "x": 1e3 * MOTION, "F_load": FORCE[:, None], "nominal_frequency": 1.0})
    record, = read_records(tmp_path / "three.mat", units={"displacement": "mm"}, columns={"force": "F_load"})
    same, = read_records({"time": TIME, "displacement": MOTION, "force": -FORCE, "name": "same"}, force_sign=-1)
    assert np.allclose(record.displacement, MOTION) and record.nominal_frequency == 1.0
    assert np.allclose(record.force, same.force)


@pytest.mark.parametrize("heading, message", [
    ("time [s],displacement,force [kN]", "test 'bad': column 'displacement' says no unit"),
    ("time [s],displacement [kg],force [kN]", "test 'bad': displacement: unit 'kg' has the wrong dimension"),
    ("time [s],travel [mm],force [kN]", "test 'bad': no column for displacement; there are time"),
    ("time [s],displacement [mm]", "2 headings, but 3 columns"),
])
def test_bad_headings_are_named(tmp_path, heading, message):
    write_csv(tmp_path / "bad.csv", TIME, MOTION, FORCE)
    text = (tmp_path / "bad.csv").read_text().split("\n", 1)[1]
    (tmp_path / "bad.csv").write_text(heading + "\n" + text)
    with pytest.raises(RecordError) as raised:
        read_records(tmp_path / "bad.csv")
    assert message in str(raised.value)


def test_other_files_and_options_that_cannot_be_used(tmp_path):
    (tmp_path / "empty.csv").write_text("time [s],displacement [mm],force [kN]\n")
    (tmp_path / "hole.csv").write_text("time [s],displacement [mm],force [kN]\n0,1,2\n1,,2\n")
    (tmp_path / "no.mat").write_text("not MATLAB")
    for source, message in ((tmp_path / "empty.csv", "holds no samples"), (tmp_path / "hole.csv", "not a table of numbers"),
                            (tmp_path / "no.mat", "MATLAB file"), (tmp_path / "absent.csv", "there is no file"), ([], "no record")):
        with pytest.raises(RecordError, match=message):
            read_records(source)
    with pytest.raises(RecordError, match="nearest: 'force'"):
        read_records(tmp_path, units={"forces": "kN"})
    with pytest.raises(RecordError, match="force_sign"):
        read_records(tmp_path, force_sign=0)


@pytest.mark.parametrize("change, message", [
    ({"force": FORCE[:-1]}, "force has 2499 samples, time has 2500"),
    ({"time": np.r_[TIME[:100], TIME[99:-1]]}, "time does not increase"),
    ({"time": TIME[::-1]}, "time does not increase"),
    ({"force": np.where(TIME == TIME[7], np.nan, FORCE)}, "force is not a finite number in 1 of 2500 samples, the first is sample 7"),
    ({"displacement": ["a"] * 2500}, "displacement is not an array of numbers"),
    ({"nominal_frequency": -1.0}, "nominal_frequency -1.0 is not above 0"),
])
def test_arrays_that_are_no_record(change, message):
    with pytest.raises(RecordError) as raised:
        Record(**{"time": TIME, "displacement": MOTION, "force": FORCE, "name": "array", **change})
    assert "test 'array'" in str(raised.value) and message in str(raised.value)


def test_a_record_does_not_change_with_its_arrays():
    time = TIME.copy()
    record = Record(time, MOTION, FORCE)
    time[0] = -1.0
    assert record.time[0] == 0.0 and not record.time.flags.writeable


def test_shipped_records_are_there():
    records = read_records(shipped_records())
    assert [record.name for record in records] == [f"{f:g}Hz_{a:g}mm" for f, a in sorted(SHIPPED_TESTS)]
    assert rs.dampers.RecordError is RecordError
