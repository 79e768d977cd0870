"""Traces and truths as arrays, against the CSV of the command line and against closed forms."""
import csv
import fractions
import io
import subprocess
import warnings

import numpy as np
import pytest

import rigor
from rigor import _native
from rigor.motion import STATE
from rigor.program import program


def test_a_trace_has_the_numbers_of_the_csv_bit_for_bit():
    traj = rigor.trace("springs/fixed-spring", engine="core:rk4", dt="1/240", duration=1)
    text = subprocess.run([program(), "trace", "springs/fixed-spring", "--engine", "core:rk4", "--dt", "1/240", "--duration", "1"], capture_output=True,
                          text=True, check=True).stdout
    rows = list(csv.DictReader(io.StringIO(text)))
    assert len(rows) == len(traj) == 241
    for name in ("time", *STATE):
        assert [float(row[name]) for row in rows] == traj[name].tolist()
    assert [row["body"] for row in rows] == traj["body"].tolist()
    # The reader of cells' trajectories, on the same text.
    again = _native.read_states(text.encode())
    assert again.dtype == traj.dtype and (again == np.asarray(traj)).all()


def test_a_fall_is_where_its_formula_says(fall):
    traj = rigor.trace(fall, engine="core:rk4", dt=fractions.Fraction(1, 50))
    stone = traj.body("stone")
    t = traj.times
    assert t[-1] == pytest.approx(1) and len(stone) == len(t) == 51
    # rk4 is exact on a parabola, but for rounding.
    assert np.allclose(stone["pz"], -5 * t**2, atol=1e-12) and np.allclose(traj.position[:, 0, 0], t, atol=1e-12)
    assert traj.names == ["stone", "wheel"] and traj.state().shape == (51, 2, 13)
    assert np.allclose(np.linalg.norm(traj.orientation, axis=2), 1, atol=1e-14)
    assert np.allclose(traj.angular_velocity[:, 1], [0, 0, 3], atol=1e-12) and (traj.velocity[-1, 0] == stone.state()[-1, 0, 7:10]).all()


def test_rows_are_not_copied_and_can_be_changed(fall):
    traj = rigor.trace(fall, engine="core:rk4", dt="1/50", every=5)
    assert len(traj.times) == 11 and not traj.flags.owndata
    assert np.shares_memory(traj.state(), traj)
    view = traj.body("wheel")
    del traj
    view["px"] += 1  # the memory outlives the array that was mapped
    assert (view["px"] == 6).all()


def test_a_truth_has_its_own_error(fall):
    truth = rigor.truth(fall, times=[0, 0.5, 1])
    assert truth.error.max() < 1e-12 and truth.body("stone")["pz"].tolist() == pytest.approx([0, -1.25, -5], abs=1e-12)
    traj = rigor.trace(fall, engine="core:rk4", dt="1/10")
    assert (rigor.truth(fall, times=traj)["time"] == traj["time"]).all()
    with pytest.raises(AttributeError, match="only a truth"):
        traj.error


def test_times_beyond_one_command_line_are_joined(fall):
    times = np.linspace(0, 1, 20001)
    truth = rigor.truth(fall, times=times)
    assert len(truth) == 2 * len(times) and (truth.times == times).all()
    assert np.allclose(truth.body("stone")["pz"], -5 * times**2, atol=1e-12)


def test_a_frame_has_the_same_columns_and_units(fall):
    traj = rigor.trace(fall, engine="core:rk4", dt="1/10")
    frame = traj.to_dataframe()
    assert list(frame.columns) == ["time", "body", *STATE] and frame.attrs["units"]["vx"] == "m/s"
    assert (frame["pz"].to_numpy() == traj["pz"]).all() and frame["body"].tolist() == traj["body"].tolist()


def test_a_run_that_blows_up_warns():
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        traj = rigor.trace("springs/stiff-1", engine="core:explicit-euler", dt=0.1, duration=1000)
    assert any(issubclass(one.category, rigor.RigorWarning) and "blown up" in str(one.message) for one in told)
    assert any("blown up" in note for note in traj.notes) and np.isfinite(traj.state()).all()


@pytest.mark.parametrize("options, words", [
    ({"engine": "od"}, "did you mean"),
    ({"dt": "1/0"}, "--dt"),
    ({"dt": -1}, "--dt"),
    ({"dt": float("nan")}, "--dt"),
    ({"dt": True}, "a time in s"),
    ({"dt": None}, "a time in s"),
    ({"dt": ["1/30", "1/60"]}, "exactly one --dt"),
    ({"every": 0}, "--every"),
    ({"duration": "long"}, "--duration"),
    ({"engine": 3}, "class of rigor.Engine"),
])
def test_a_wrong_call_says_what_is_allowed(fall, options, words):
    with pytest.raises(rigor.InputError, match=words) as caught:
        rigor.trace(fall, **{"engine": "core:rk4", "dt": "1/10", **options})
    assert "Traceback" not in str(caught.value)


def test_an_unsupported_scene_is_an_exception_of_its_own():
    with pytest.raises(rigor.UnsupportedError, match="unsupported"):
        rigor.trace("contact/galton", engine="core:adams", dt="1/30")


def test_a_case_without_truth_has_none():
    case = rigor.Case.from_dict({"title": "t", "scene": {"body": [{"name": "a", "mass": 1, "inertia": [1, 1, 1]}]}, "run": {"duration": 1, "dt": ["1/10"]}})
    with pytest.raises(rigor.InputError, match="states no truth") as caught:
        rigor.truth(case)
    assert "/tmp" not in str(caught.value)


def test_close_tells_the_worst_instant(fall):
    traj = rigor.trace(fall, engine="core:semi-implicit-euler", dt="1/10")
    truth = rigor.truth(fall, times=traj)
    near = rigor.close(traj, truth, within="0.6m")
    # The scheme is g t dt / 2 behind: 0.5 m at the end.
    assert near and near.distance == pytest.approx(0.5, abs=1e-9) and near.time == pytest.approx(1) and near.body == "stone"
    far = rigor.close(traj, truth, within="499mm")
    assert not far and repr(far) == "not close: at most 0.5 m at t = 1 s, body 'stone'; allowed: 0.499 m; the truth may be off by " + repr(far).split("by ")[1]
    with pytest.raises(AssertionError, match="at t = 1 s, body 'stone'"):
        assert far, far


def test_close_of_orientations_is_the_angle(fall):
    traj = rigor.trace(fall, engine="core:rk4", dt="1/10")
    other = traj.copy()
    half = np.radians(2.0) / 2
    q = other.body("wheel")
    w, z = q["qw"].copy(), q["qz"].copy()
    q["qw"], q["qz"] = w * np.cos(half) - z * np.sin(half), w * np.sin(half) + z * np.cos(half)
    found = rigor.close(other, traj, within="1deg")
    assert not found and found.distance == pytest.approx(np.radians(2.0), rel=1e-9)
    for name in ("qw", "qx", "qy", "qz"):
        other[name] *= -1  # the same orientations
    assert rigor.close(other, traj, within="2.001deg")


def test_what_the_truth_cannot_vouch_for_is_not_close(fall):
    truth = rigor.truth(fall, times=[0, 1])
    vague = truth.copy()
    vague["error"] = 0.01
    answer = rigor.close(truth, vague, within="1mm")
    assert not answer and "the truth itself may be off by" in repr(answer)
    lost = truth.copy()
    lost["px"][1] = np.nan
    assert not rigor.close(lost, truth) and "no finite number" in repr(rigor.close(lost, truth))


@pytest.mark.parametrize("within, words", [("1", "no distance"), ("1 parsec", "no distance"), ("0mm", "not above zero"), (3, "no distance")])
def test_a_wrong_bound_is_named(fall, within, words):
    truth = rigor.truth(fall, times=[1])
    with pytest.raises(rigor.InputError, match=words):
        rigor.close(truth, truth, within=within)


def test_motions_of_other_rows_are_refused(fall):
    truth = rigor.truth(fall, times=[0, 1])
    for other in (truth[:2], truth[::-1], np.zeros(3), truth[:0]):
        with pytest.raises(rigor.InputError, match="close: "):
            rigor.close(other, truth)


@pytest.mark.parametrize("text", [b"", b"a,b\n1,2\n", b"time,body,px\n1\n", b"time,body,px\n1,a\n", b"time,body,px\n1,a,x\n", b"time,body,px\n1,a,1,2\n"])
def test_a_table_that_is_none_is_an_exception(text):
    with pytest.raises(ValueError):
        _native.read_states(text)


@pytest.mark.parametrize("times, words", [
    ([float("nan")], "--times"), ([-1], "--times"), (["soon"], "--times"), ([], "is empty"), (np.array([1 + 2j]), "not a complex"), ([True], "not a bool"),
    ([None], "not a NoneType"), (np.array(["2026-01-01"], dtype="datetime64[D]"), "not a date"), (np.ma.masked_array([0.5, 1], mask=[0, 1]), "masked"),
])
def test_times_that_are_none_are_named(fall, times, words):
    with pytest.raises(rigor.InputError, match=words):
        rigor.truth(fall, times=times)


def test_times_of_any_strides_keep_their_order(fall):
    assert rigor.truth(fall, times=np.linspace(0, 1, 5)[::-2]).times.tolist() == [1, 0.5, 0]
    assert rigor.truth(fall, times=np.asfortranarray([[0, 0.5], [1, 0.25]])).times.tolist() == [0, 0.5, 1, 0.25]


def test_a_part_of_a_trajectory_never_mixes_bodies(fall):
    traj = rigor.trace(fall, engine="core:rk4", dt="1/10")
    stone, wheel = traj["px"][::2].tolist(), traj["px"][1::2].tolist()
    assert traj[2:].position[:, 1, 0].tolist() == wheel[1:] and traj[::2].position[:, 0, 0].tolist() == stone
    assert traj[::-1].position[:, 0, 0].tolist() == wheel[::-1] and traj.body("wheel").position[:, 0, 0].tolist() == wheel
    for part in (traj[1:], traj[:-1], traj[:0], traj[[0, 1, 0, 1]], traj[[0, 0]], traj[[0, 2, 3, 4, 5, 6]]):
        with pytest.raises(rigor.InputError, match="no whole trajectory"):
            part.position


def test_names_with_commas_and_other_letters_are_read():
    rows = _native.read_states('time,body,px\n0,"a, ""b""",1\n0,Würfel,-2.5e-3\n'.encode())
    assert rows["body"].tolist() == ['a, "b"', "Würfel"] and rows["px"].tolist() == [1, -2.5e-3]
    name = 'Würfel, "b" 球 😀'
    case = rigor.Case.from_dict({"title": "t", "scene": {"body": [{"name": name, "mass": 1, "inertia": [1, 1, 1]}]}, "run": {"duration": 1, "dt": ["1/10"]}})
    assert set(rigor.trace(case, engine="core:rk4", dt="1/10")["body"]) == {name}
