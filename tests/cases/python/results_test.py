"""Runs and gates: results as objects, series and sweeps."""
import math
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import rigor


@pytest.fixture(scope="module")
def springs(tmp_path_factory):
    """A family on three engines, one of which lacks what some scenes need."""
    out = tmp_path_factory.mktemp("springs") / "out"
    return rigor.run(["springs/fixed-spring", "contact/bounce-half"], engines=["core:semi-implicit-euler", "ode", "core:adams"], dt=["1/30", "1/240"],
                     duration=1, out=out, progress=False)


def test_a_cell_has_its_metrics_with_what_belongs_to_them(springs):
    cell = springs.cell("springs/fixed-spring", "ode", "1/30")
    error = cell.metric("position_error")
    assert error > 0 and error.unit == "m" and 0 < error.worst_time <= 1 and error.worst_body == "cube"
    assert cell is springs.cell("springs/fixed-spring", "ode", 1 / 30)
    missing = cell.metric("restitution_error")
    assert math.isnan(missing) and missing.why
    with pytest.raises(rigor.InputError, match="there is no metric 'positon_error'"):
        cell.metric("positon_error")
    with pytest.raises(rigor.InputError, match="there is no cell of"):
        springs.cell("springs/fixed-spring", "ode", "1/31")


def test_a_cell_has_its_run(springs):
    cell = springs.cell("springs/fixed-spring", "ode", "1/30")
    traj = cell.trajectory()
    again = rigor.trace("springs/fixed-spring", engine="ode", dt="1/30", duration=1)
    assert (np.asarray(traj) == np.asarray(again)).all() and isinstance(traj, rigor.Trajectory)
    unsupported = next(cell for cell in springs.cells if cell.status == "unsupported")
    with pytest.raises(rigor.RigorError, match="has no trajectory"):
        unsupported.trajectory()
    assert math.isnan(unsupported.metric("position_error")) and "unsupported" in unsupported.metric("position_error").why


@pytest.mark.parametrize("text", ["", "time,body,px\n1,a,x\n", None])
def test_a_trajectory_that_was_changed_is_an_error(fall, text):
    cell = rigor.run(fall, engines="core:rk4", dt="1/10", progress=False).cells[0]
    path = os.path.join(cell._folder, "trajectories", cell.row["trajectory"])
    if text is None:
        os.remove(path)
    else:
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    with pytest.raises(rigor.RigorError, match="trajectories/"):
        cell.trajectory()


def test_a_series_is_the_metric_over_time(springs):
    cell = springs.cell("springs/fixed-spring", "ode", "1/30")
    series = cell.series("position_error")
    assert series["value"].max() == cell.metric("position_error")
    assert series["time"][np.argmax(series["value"])] == pytest.approx(cell.metric("position_error").worst_time, abs=1e-12)
    # Worked out again from the run and the truth.
    traj = cell.trajectory()
    truth = rigor.truth("springs/fixed-spring", times=traj)
    distance = np.linalg.norm(traj.position - truth.position, axis=2).max(axis=1)
    assert np.allclose(distance[:len(series)], series["value"], rtol=1e-9, atol=1e-9)
    with pytest.raises(rigor.InputError, match="has no series here"):
        cell.series("cost")
    with pytest.raises(rigor.InputError, match="there is no metric"):
        cell.series("nothing")
    with pytest.raises(rigor.RigorError, match="series=True"):
        rigor.run("springs/fixed-spring", engines="ode", dt="1/30", duration=1, series=False, progress=False).cells[0].series("position_error")


def test_reports_are_written_where_one_asks(springs, tmp_path):
    page = springs.report(tmp_path / "copy")
    assert os.path.isfile(page) and {"results.json", "report.md", "junit.xml", "trajectories"} <= set(os.listdir(tmp_path / "copy"))


def test_a_temporary_folder_goes_with_the_last_object_that_needs_it(fall):
    results = rigor.run(fall, engines="core:rk4", progress=False)
    folder, cell = results.folder, results.cells[0]
    del results
    assert len(cell.trajectory()) > 0
    del cell
    assert not os.path.exists(folder)


def test_a_gate_tells_what_fell_short(fall):
    good = rigor.gate(fall, engines="core:semi-implicit-euler", progress=False)
    assert good.passed and good.failures() == [] and good.exit_code == 0
    with open(fall, encoding="utf-8") as file:
        case = rigor.Case.from_toml(file.read().replace("max = 0.6", "max = 0.4"), name="strict")
    bad = rigor.gate(case, engines="core:semi-implicit-euler", progress=False)
    assert not bad.passed and bad.exit_code == 1
    assert len(bad.failures()) == 1 and bad.failures()[0].startswith("strict core:semi-implicit-euler dt = 1/10: "), bad.failures()
    assert "0.5" in bad.failures()[0] and "stone" in bad.failures()[0]


@pytest.mark.parametrize("call, words", [
    (lambda: rigor.run([], engines="ode"), "list of cases is empty"),
    (lambda: rigor.run("springs/fixed-spring", engines="odee"), "odee"),
    (lambda: rigor.run("springs/fixed-spring", engines="ode", dt="fast"), "--dt"),
    (lambda: rigor.run("springs/fixed-spring", engines="ode", jobs=0), "--jobs"),
    (lambda: rigor.run("springs/fixed-spring", engines="ode", progress=3), "progress is"),
    (lambda: rigor.run("springs/fixed-spring", engines="ode", colour="red"), "has no option '--colour'"),
    (lambda: rigor.run("springs/fixed-spring", engines=3), "class of rigor.Engine"),
    (lambda: rigor.run("no/such-case", engines="ode"), "no/such-case"),
    (lambda: rigor.sweep("springs/stiff-1", vary=[]), "vary is a dict"),
    (lambda: rigor.sweep("springs/stiff-1", engines="ode", vary={"dtt": [1]}), "dtt"),
    (lambda: rigor.tune("springs/fixed-spring", engine="ode", within="1 furlong"), "--within"),
    (lambda: rigor.command("dance"), "there is no command 'dance'"),
])
def test_a_wrong_call_is_an_input_error(call, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(rigor.InputError, match=words):
        call()
    assert os.listdir(tmp_path) == []


def test_old_results_do_not_look_like_new_ones(fall, tmp_path):
    out = tmp_path / "out"
    rigor.run(fall, engines="core:rk4", out=out, progress=False)
    with pytest.raises(rigor.InputError):
        rigor.run(fall, engines="core:rk4", dt="5", out=out, progress=False)


def test_progress_is_told(fall):
    told = []
    rigor.run("springs/fixed-spring", engines=["core:rk4", "core:adams", "ode", "bullet"], jobs=1, progress=lambda done, all_: told.append((done, all_)))
    assert told and all(0 <= done <= all_ for done, all_ in told)


def test_an_error_in_ones_own_progress_ends_the_run(fall):
    def fails(done, all_):
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        rigor.run("springs/fixed-spring", jobs=1, progress=fails)


INTERRUPTED = """
import rigor, sys
try:
    rigor.run(["springs", "tops"], engines=["core:rk4", "core:adams", "ode"], out=sys.argv[1], jobs=1, progress=False)
except rigor.Interrupted as error:
    print("interrupted", error.out)
"""


def test_ctrl_c_leaves_finished_cells(tmp_path):
    out = tmp_path / "out"
    process = subprocess.Popen([sys.executable, "-c", INTERRUPTED, str(out)], stdout=subprocess.PIPE, text=True)
    journals = out / ".rigor-partial" / "journals"
    for _ in range(600):
        if journals.is_dir() and sum(path.stat().st_size for path in journals.iterdir()) > 5000:
            break
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    said, _ = process.communicate(timeout=60)
    assert said.strip() == f"interrupted {out}" and process.returncode == 0
    kept = sum(path.stat().st_size for path in journals.iterdir())
    assert kept > 5000
    told = []
    results = rigor.run(["springs/fixed-spring"], engines=["core:rk4"], dt="1/30", out=tmp_path / "other", progress=lambda *a: told.append(a))
    assert results.cells


def test_a_sweep_is_a_frame(tmp_path):
    sweep = rigor.sweep("springs/stiff-1", engines=["core:rk4", "core:adams"], vary={"dt": ["1/30", "1/240"], "scene.spring[0].stiffness": [100.0, 200.0]},
                        duration=1, progress=False)
    frame = sweep.to_dataframe()
    assert len(frame) == len(sweep.rows) == 8 and {"scene.spring[0].stiffness", "position_error"} <= set(frame.columns)
    assert frame.attrs["units"]["scene.spring[0].stiffness"] == "N/m" and frame.attrs["units"]["position_error"] == "m"
    for (_, found), row in zip(frame.iterrows(), sweep.rows):
        assert found["position_error"] == row["position_error"]
    assert frame["scene.spring[0].stiffness"].tolist() == [row["scene.spring[0].stiffness"] for row in sweep.rows]


def test_tune_finds_a_setting_that_runs():
    tuned = rigor.tune("springs/stiff-1", engine="core:rk4", within="1mm", duration=0.5, progress=False)
    assert tuned and tuned.engine.startswith("core:rk4") and tuned.dt
    assert rigor.run("springs/stiff-1", engines=tuned.engine, dt=tuned.dt, duration=0.5, progress=False).cells[0].metric("position_error") <= 1e-3


def test_a_command_that_prints_no_json_has_none(fall, tmp_path):
    done = rigor.command("repeat", fall, engines="core:rk4", dt="1/10", record=tmp_path / "hashes.jsonl")
    assert done and done.json is None and (tmp_path / "hashes.jsonl").is_file()


def test_the_module_is_the_command_line(tmp_path):
    said = subprocess.run([sys.executable, "-m", "rigor", "trace", "springs/fixed-spring"], capture_output=True, text=True, cwd=tmp_path)
    assert said.returncode == 2 and said.stderr == "rigor: rigor trace: takes exactly one --engine; see rigor list engines\n"


def test_the_import_is_brief_and_without_numpy():
    code = "import sys, rigor; assert 'numpy' not in sys.modules; print(sorted(rigor.__all__) == rigor.__all__ and all(hasattr(rigor, n) for n in rigor.__all__))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout == "True\n"
