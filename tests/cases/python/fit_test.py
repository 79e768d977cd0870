"""`fit`: values that a recording was made with, the same numbers as the command line's, and what the data cannot tell."""
import json
import math
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import rigor
from rigor.program import program

FRICTION = "scene.contact_default.friction"
VERLET = "core:velocity-verlet"


def slide(folder, friction=0.5, trials=6, **values):
    """A block that slid with a friction of 0.3: x = v t - 0.3 g t^2 / 2, seen with noise of 0.1 mm. `friction` is the case's own."""
    noise, rows = np.random.default_rng(1), ["trial,time,body,px,py,pz,vx,vy,vz"]
    for trial in range(trials):
        speed = noise.uniform(0.8, 1.2)
        for t in np.arange(41) * 0.005:
            x, y, z = noise.normal(0, 1e-4 if t > 0 else 0, 3) + (speed * t - 0.3 * 9.81 * t**2 / 2, 0, 0.05)
            rows.append(f"t{trial},{t:.9f},block,{x!r},{y!r},{z!r},{speed - 0.3 * 9.81 * t!r},0,0")
    (folder / "slide.csv").write_text("\n".join(rows) + "\n")
    return rigor.Case.from_dict({
        "title": "a block slides",
        "scene": {"gravity": [0, 0, -9.81],
                  "body": [{"name": "block", "mass": 1, "position": [0, 0, 0.05], "velocity": [1, 0, 0], "shape": {"type": "box", "size": [0.4, 0.4, 0.1]}},
                           {"name": "ground", "shape": {"type": "plane", "normal": [0, 0, 1], "offset": 0}}],
                  "contact_default": {"friction": friction, "restitution": 0}},
        "run": {"duration": 0.2, "dt": 0.005},
        "truth": {"kind": "recording", "file": "slide.csv", "group": "trial", "position_noise": 1e-4, "orientation_noise": 1e-3, **values}}, name="slide", folder=folder)


def test_a_known_friction_is_found_and_is_that_of_the_command_line(tmp_path):
    case = slide(tmp_path, trials=8)
    found = rigor.fit(case, engine=VERLET, vary={FRICTION: (0.05, 0.9)}, hold_out=0.25, seed=7, progress=False)
    friction = found[FRICTION]
    assert found and friction.known and friction.unit == "1" and found.engine == VERLET
    # 40 samples of 0.1 mm noise over a way of mu g t^2 / 2 = 0.059 m: a percent at most, and a tenth of it for a trial's mean.
    assert friction == pytest.approx(0.3, abs=0.003) and friction.interval[0] <= friction <= friction.interval[1] < friction.interval[0] + 0.006
    assert found.error.trials == 6 and found.held_out.trials == 2 and found.error.position_unit == "m"
    # Noise alone: 1.6 times 0.1 mm, 20 % for 80 samples. No orientation is known.
    assert found.held_out.position == pytest.approx(1.6e-4, rel=0.2) and math.isnan(found.held_out.rotation)
    assert found.correlations.tolist() == [[1.0]]

    (tmp_path / "same.toml").write_text(case.to_toml())
    words = [program(), "fit", "same.toml", "--engine", VERLET, "--vary", f"{FRICTION}=0.05..0.9", "--hold-out", "0.25", "--seed", "7"]
    told = json.loads(subprocess.run([*words, "--json"], capture_output=True, text=True, cwd=tmp_path, check=True).stdout)[0]
    assert told.pop("cases") == [{"case": "same.toml", "dt": "0.005"}] and found.json.pop("cases") == [{"case": "slide", "dt": "0.005"}]
    assert told == found.json
    text = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, check=True).stdout
    assert f"  {friction.told()}\n" in text and text.splitlines()[:2] == repr(found).splitlines()[:2], text


def test_the_fitted_case_has_the_value(tmp_path):
    case = slide(tmp_path)
    found = rigor.fit(case, engine=VERLET, vary={FRICTION: "0.05..0.9:log"}, jobs=1, out=tmp_path / "fitted.toml", progress=False)
    again = case.replace(**found.values)
    assert again.scene.contact_default["friction"] == found[FRICTION]
    assert rigor.Case.from_file(tmp_path / "fitted.toml").scene.rows == again.scene.rows
    # It moves as the first trial does: x = v t - 0.3 g t^2 / 2.
    moved = rigor.trace(again, engine=VERLET, dt=0.005).body("block")
    assert moved["px"][-1] - moved["px"][0] == pytest.approx(moved["vx"][0] * 0.2 - 0.3 * 9.81 * 0.2**2 / 2, abs=5e-4)


def test_what_the_data_cannot_tell_is_said(tmp_path):
    found = rigor.fit(slide(tmp_path), engine=VERLET, vary={FRICTION: (0.4, 0.9), "scene.body.block.velocity[1]": (-1, 1)}, progress=False)
    assert not found and found[FRICTION].at_bound and not found[FRICTION].known and found[FRICTION] == pytest.approx(0.4, abs=1e-3)
    # The start comes from the recording.
    start = found["scene.body.block.velocity[1]"]
    assert start.unknown == "it changes nothing here" and start.interval is None and start.unit == "m/s" and not start.at_bound
    assert "at the end of its range" in repr(found) and "the data cannot tell it: it changes nothing here" in repr(found)
    with pytest.raises(rigor.InputError, match="was not fitted; there is: scene.contact_default.friction, scene.body"):
        found["friction"]


def test_a_single_trial_has_the_interval_of_its_parabola(tmp_path):
    found = rigor.fit(slide(tmp_path, trials=1), engine=VERLET, vary={FRICTION: (0.05, 0.9)}, progress=False)
    # mu g/2 is the last coefficient of a parabola through 41 samples with 0.1 mm noise, of which the others are unknown, too.
    times = np.arange(41) * 0.005
    powers = np.stack([np.ones(41), times, 9.81 * times**2 / 2], axis=1)
    error = 1e-4 * np.linalg.inv(powers.T @ powers)[2, 2] ** 0.5
    low, high = found[FRICTION].interval
    assert found and found.intervals == "profile" and found.why_no_intervals == "" and found.caveats == []
    assert (high - low) / 2 == pytest.approx(1.96 * error, rel=0.05) and found[FRICTION] == pytest.approx(0.3, abs=3 * error)
    assert found[FRICTION].open_ends == (False, False) and f"95 %: {low:.4g} to {high:.4g}" in repr(found)


@pytest.mark.parametrize("options, words", [
    ({"vary": {"scene.contact_default.fricton": (0.1, 0.9)}}, "did you mean 'friction'?"),
    ({"vary": {"contcat": (0.1, 0.9)}}, "did you mean 'contact'?"),
    ({"vary": {FRICTION: (0.9, 0.1)}}, "the wrong way round; give 0.1..0.9"),
    ({"vary": {FRICTION: (0.1, 0.1)}}, "begins where it ends"),
    ({"vary": {FRICTION: (-0.5, 0.2)}}, "friction"),
    ({"vary": {FRICTION: "0.1,0.2"}}, "allowed: a range"),
    ({"vary": {FRICTION: (0.1, float("nan"))}}, "no range of numbers"),
    ({"vary": {FRICTION: (0.1, 0.2, 0.3)}}, "allowed: two numbers, as"),
    ({"vary": {FRICTION: 0.3}}, "allowed: two numbers, as"),
    ({"vary": {FRICTION: (False, True)}}, "allowed: two numbers, as"),
    ({"vary": {"duration": (0.1, 0.2)}}, "cannot be fitted"),
    ({"vary": {}}, "vary is a dict"),
    ({"vary": [FRICTION]}, "vary is a dict"),
    ({"hold_out": 0.01}, "leaves one side"),
    ({"hold_out": 1}, "between 0 and 1"),
    ({"seed": "x"}, "--seed"),
    ({"dt": [0.005, 0.01]}, "at most one --dt"),
    ({"engine": "core:velocity-verlt"}, "did you mean"),
    ({"engine": ["ode", "bullet"]}, "takes one engine, and there are 2"),
    ({"engine": None}, "takes one engine, and there are 0"),
    ({"colour": "red"}, "has no option '--colour'"),
])
def test_a_wrong_call_says_what_is_allowed(tmp_path, options, words):
    with pytest.raises(rigor.InputError, match=words) as caught:
        rigor.fit(slide(tmp_path, trials=2), **{"engine": VERLET, "vary": {FRICTION: (0.1, 0.9)}, "progress": False, **options})
    assert "\n" not in str(caught.value) and sorted(os.listdir(tmp_path)) == ["slide.csv"]


def test_a_case_without_truth_is_refused(fall):
    with open(fall, encoding="utf-8") as file:
        case = rigor.Case.from_toml(file.read().replace('kind = "projectile"', 'kind = "none"').split("[[gate]]")[0], name="fall")
    with pytest.raises(rigor.InputError, match="states no truth to fit to"):
        rigor.fit(case, engine="core:rk4", vary={"scene.gravity[2]": (-12, -8)})


def test_progress_is_told_and_is_no_note(tmp_path):
    told = []
    found = rigor.fit(slide(tmp_path), engine=VERLET, vary={FRICTION: (0.05, 0.9)}, jobs=1, progress=lambda done, all_: told.append((done, all_)))
    assert told and all(0 <= done <= found.points and all_ == 0 for done, all_ in told) and max(told) > (0, 0) and found.notes == ()


INTERRUPTED = """
import pathlib, rigor, sys
try:
    rigor.fit(rigor.Case.from_file("slide.toml"), engine="core:velocity-verlet", vary={"scene.contact_default.friction": (0.05, 0.9)}, dt=2e-6, jobs=1,
              progress=lambda done, all_: pathlib.Path("told").touch())
except rigor.Interrupted as error:
    print("interrupted", error.out)
"""


def test_ctrl_c_ends_it(tmp_path):
    (tmp_path / "slide.toml").write_text(slide(tmp_path).to_toml())
    process = subprocess.Popen([sys.executable, "-c", INTERRUPTED], stdout=subprocess.PIPE, text=True, cwd=tmp_path)
    for _ in range(600):
        if (tmp_path / "told").exists():
            break
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=60)[0] == "interrupted None\n" and process.returncode == 0
