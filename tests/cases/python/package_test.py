"""What is installed: the package for Debian, and the tree that becomes a wheel. Both run from another folder."""
import os
import pathlib
import re
import subprocess
import sys

import pytest

import rigor

BUILD = pathlib.Path(rigor.__file__).parents[2]

FIRST = """
import importlib.metadata, pathlib, rigor
from rigor.program import program
print("package", pathlib.Path(rigor.__file__).parent)
print("program", program())
print("plug-in", [point.value for point in importlib.metadata.entry_points(group="pytest11") if point.name == "rigor"])
class World:
    def __init__(self, scene): self.rows, self.g = scene.state(), scene.gravity
    def step(self, dt): self.rows[:, 7:10] += dt * self.g; self.rows[:, :3] += dt * self.rows[:, 7:10]
    def read(self): return self.rows
class Mine(rigor.Engine):
    name = "mine"
    def load(self, scene, settings): return World(scene)
for in_process in (False, True):
    result = rigor.run("ballistic/free-fall", engines=[Mine, "core:rk4"], dt="1/30", duration=0.5, in_process=in_process, progress=False)
    print("cells", [cell.status for cell in result.cells])
"""


def run(words, **options):
    said = subprocess.run(words, capture_output=True, text=True, **options)
    assert said.returncode == 0, said.stdout + said.stderr
    return said.stdout


def first(folder, tmp_path, **environment):
    """The first steps of a newcomer, in an empty folder, with the package of `folder` alone."""
    kept = {key: value for key, value in os.environ.items() if not key.startswith("RIGOR") and key != "PYTHONPATH"}
    empty = tmp_path / "empty"
    empty.mkdir()
    (empty / "first.py").write_text(FIRST)
    said = run([sys.executable, "first.py"], cwd=empty, env={**kept, "PATH": "/usr/bin:/bin", "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1", **environment})
    assert f"package {folder}/rigor\n" in said and said.count("cells ['pass', 'pass']") == 2, said
    return said


@pytest.mark.skipif(not (BUILD / "CPackPythonConfig.cmake").is_file(), reason="the package is no build of CMake's")
def test_the_package_for_debian(tmp_path):
    run(["cpack", "--config", str(BUILD / "CPackPythonConfig.cmake"), "-G", "DEB", "-B", str(tmp_path)], cwd=tmp_path)
    deb, = tmp_path.glob("python3-rigor*.deb")
    told = run(["dpkg-deb", "--field", str(deb), "Package", "Version", "Depends"])
    assert "Package: python3-rigor" in told and f"rigor (= {rigor.__version__}" in told and "python3-numpy" in told, told
    run(["dpkg-deb", "--extract", str(deb), str(tmp_path / "root")])
    folder = tmp_path / "root/usr/lib/python3/dist-packages"
    assert {"rigor", f"rigor-{rigor.__version__}.dist-info"} == {path.name for path in folder.iterdir()}
    # The program belongs to the package `rigor`, which stands in PATH there.
    said = first(folder, tmp_path, PATH=f"{BUILD}:/usr/bin:/bin")
    assert f"program {BUILD}/rigor\n" in said and "plug-in ['rigor.pytest_plugin']" in said, said
    # Debian's own interpreter takes what Debian's package needs.
    assert re.search(r"python3 \(>= 3\.\d+\), python3 \(<< 3\.\d+\)", told), told


@pytest.mark.skipif(not (BUILD / "CMakeCache.txt").is_file(), reason="the package is no build of CMake's")
def test_the_tree_of_a_wheel_holds_all_that_a_run_needs(tmp_path):
    """scikit-build-core installs this component into the wheel. It is not in Debian 12, so the test installs it itself."""
    site = tmp_path / "site"
    run(["cmake", "--install", str(BUILD), "--component", "wheel", "--prefix", str(site)])
    said = first(site, tmp_path)
    assert f"program {site}/rigor/bin/rigor\n" in said, said
