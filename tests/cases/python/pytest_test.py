"""The plug-in of pytest, as a project of a user would run it."""
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).parent


def pytest_of(folder, *words):
    said = subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *words], capture_output=True, text=True, cwd=folder,
                          env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1"))
    return said.returncode, said.stdout + said.stderr


def test_gates_are_tests(fall, tmp_path):
    code, said = pytest_of(tmp_path, "--rigor", fall, "--rigor-engine", "core:semi-implicit-euler")
    assert code == 0 and "1 passed" in said, said


def test_a_gate_that_fails_shows_the_worst_instant(fall, tmp_path):
    text = pathlib.Path(fall).read_text()
    strict = tmp_path / "strict.toml"
    strict.write_text(text.replace("max = 0.6", "max = 0.4") + '[[gate]]\nmetric = "position_error"\nmax = 1\nbecause = "loose"\n')
    code, said = pytest_of(tmp_path, "--rigor", str(strict), "--rigor-engine", "core:semi-implicit-euler")
    assert code == 1 and "1 failed, 1 passed" in said, said
    for words in ("gate on position_error", "strict.toml", "stone", "t = 1", "core:semi-implicit-euler dt = 1/10", "because: semi-implicit Euler is"):
        assert words in said, said
    assert "Traceback" not in said


def test_a_gate_that_judged_nothing_fails(fall, tmp_path):
    lost = tmp_path / "lost.toml"
    lost.write_text(pathlib.Path(fall).read_text().replace('metric = "position_error"', 'metric = "position_error"\nengines = ["ode"]'))
    code, said = pytest_of(tmp_path, "--rigor", str(lost), "--rigor-engine", "core:rk4")
    assert code == 1 and "1 failed" in said and "gate on position_error" in said, said


def test_an_engine_that_breaks_fails_each_of_its_gates(fall, tmp_path):
    (tmp_path / "dies.py").write_text("import sys; sys.exit(4)")
    code, said = pytest_of(tmp_path, "--rigor", fall, "--rigor-plugin", f"{sys.executable} dies.py", "--rigor-engine", "mine")
    assert code not in (0, 5) and "passed" not in said, said


def test_an_engine_of_ones_own_is_judged(fall, tmp_path):
    plugin = f"env PYTHONPATH={os.environ['PYTHONPATH']}:{HERE} {sys.executable} -m rigor.serve free_bodies:FreeBodies"
    code, said = pytest_of(tmp_path, "--rigor", fall, "--rigor-plugin", plugin, "--rigor-engine", "numpy")
    assert code == 0 and "1 passed" in said, said


def test_bad_files_and_files_without_gates_are_errors(fall, tmp_path):
    for text, words in (("[scene", "bad.toml"), (pathlib.Path(fall).read_text().split("[[gate]]")[0], "there is no gate")):
        (tmp_path / "bad.toml").write_text(text)
        code, said = pytest_of(tmp_path, "--rigor", "bad.toml")
        assert code == 4 and words in said, said


def test_without_the_option_nothing_changes(tmp_path):
    (tmp_path / "test_own.py").write_text("def test_one():\n    assert True\n")
    code, said = pytest_of(tmp_path)
    assert code == 0 and "1 passed" in said, said


def test_close_explains_itself_in_an_assertion(fall, tmp_path):
    (tmp_path / "test_own.py").write_text(f"""
import rigor
def test_fall():
    traj = rigor.trace({fall!r}, engine="core:semi-implicit-euler", dt="1/10")
    assert rigor.close(traj, rigor.truth({fall!r}, times=traj), within="1mm")
""")
    code, said = pytest_of(tmp_path)
    assert code == 1 and "not close: at most 0.5 m at t = 1 s, body 'stone'; allowed: 0.001 m" in said, said
