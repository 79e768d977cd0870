"""The tutorial and the engine of dartpy run as they are printed."""
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import rigor

ROOT = pathlib.Path(__file__).resolve().parents[3]
TUTORIAL = ROOT / "cases/docs/guides/python_tutorial.py"
DARTPY = ROOT / "adapters/plugin/examples/dartpy_engine.py"


def test_the_tutorial_runs_in_an_empty_folder(tmp_path):
    said = subprocess.run([sys.executable, "-W", "error::UserWarning", str(TUTORIAL)], capture_output=True, text=True, cwd=tmp_path)
    assert said.returncode == 0, said.stdout + said.stderr
    for words in ("the arm: ", "they part at t = 0.021 s, first at 'upper'; nearer the truth: core:rk4; cause: gravity", "method: rk4 -> semi-implicit-euler",
                  "ode: ", "the error falls as dt^1.0", "t = 0.5 s: ", "friction: 0.30", "the value is good", "first: does not conform: straight-line, spin", "second: conforms"):
        assert words in said.stdout, said.stdout


def test_each_cell_of_the_tutorial_is_marked():
    cells = TUTORIAL.read_text().split("# %%")[1:]
    assert len(cells) >= 8 and any(cell.startswith(" [markdown]") for cell in cells)


def test_the_engine_of_dartpy_moves_as_the_adapter_does():
    """Debian's python3-dartpy is the same DART that the adapter links."""
    dartpy = pytest.importorskip("dartpy", reason="python3-dartpy is not installed") if "dart" not in _engines() else __import__("dartpy")
    assert dartpy and len(DARTPY.read_text().splitlines()) < 120
    sys.path.insert(0, str(DARTPY.parent))
    from dartpy_engine import DartPy
    checks = rigor.conform(DartPy)
    assert checks, checks
    for case in ("springs/fixed-spring", "tops/dzhanibekov-box"):
        mine = rigor.trace(case, engine=DartPy, dt="1/240", duration=1)
        theirs = rigor.trace(case, engine="dart", dt="1/240", duration=1)
        # The same steps in another order of roundings; forces differ by roundings of Rigor's own.
        assert rigor.close(mine, theirs, within="1um"), rigor.close(mine, theirs, within="1um")
        assert np.abs(mine.position).max() > 0


def _engines():
    said = subprocess.run([sys.executable, "-m", "rigor", "list", "engines"], capture_output=True, text=True, check=True).stdout
    return {line.split()[0] for line in said.splitlines() if line[:1].strip()}
