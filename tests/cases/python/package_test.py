"""What is installed: the package for Debian, and the wheel. Both run from another folder."""
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import zipfile

import pytest

import rigor

BUILD = pathlib.Path(rigor.__file__).parents[2]
SOURCE = pathlib.Path(__file__).resolve().parents[3] / "cases/python"

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


def first(folder, tmp_path, python=sys.executable, **environment):
    """The first steps of a newcomer, in an empty folder, with the package of `folder` alone."""
    kept = {key: value for key, value in os.environ.items() if not key.startswith("RIGOR") and key != "PYTHONPATH"}
    empty = tmp_path / "empty"
    empty.mkdir()
    (empty / "first.py").write_text(FIRST)
    said = run([str(python), "first.py"], cwd=empty, env={**kept, "PATH": "/usr/bin:/bin", "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1", **environment})
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
def test_a_wheel_is_built_installed_and_run(tmp_path):
    """By pip, without a network, into an environment of its own. The program comes from the build that is tested."""
    run([sys.executable, "-m", "pip", "wheel", str(SOURCE), "--no-index", "--no-deps", "--config-settings", f"build-dir={BUILD}", "--wheel-dir", str(tmp_path)])
    wheel, = tmp_path.glob("*.whl")
    assert re.fullmatch(rf"rigor-{re.escape(rigor.__version__)}-cp3\d+-cp3\d+-linux_\w+\.whl", wheel.name), wheel.name
    with zipfile.ZipFile(wheel) as archive:
        rows = [row.rsplit(",", 2) for row in archive.read(f"rigor-{rigor.__version__}.dist-info/RECORD").decode().splitlines()]
        assert sorted(name for name, _, _ in rows) == sorted(archive.namelist()) and len(rows) > 100
        for name, digest, _ in rows[:-1]:
            assert digest == "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(archive.read(name)).digest()).decode().rstrip("="), name
    run([sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", str(tmp_path / "venv")])
    python = tmp_path / "venv/bin/python"
    alone = {**os.environ, "PYTHONPATH": ""}  # where the package that is tested would look installed
    run([sys.executable, "-m", "pip", "--python", str(python), "install", "--no-index", "--no-deps", str(wheel)], env=alone)
    site, = (tmp_path / "venv/lib").glob("python3*/site-packages")
    said = first(site, tmp_path, python, PYTHONPATH="")
    assert f"program {site}/rigor/bin/rigor\n" in said and "plug-in ['rigor.pytest_plugin']" in said, said
    told = run([str(python), "-m", "pip", "show", "--verbose", "rigor"], env=alone)
    assert f"Version: {rigor.__version__}" in told and "Requires: cloudpickle, numpy" in told and "License: MIT" in told, told


def test_a_wheel_takes_no_build_that_lacks_the_package(tmp_path):
    said = subprocess.run([sys.executable, "-m", "pip", "wheel", str(SOURCE), "--no-index", "--no-deps", "--config-settings", f"build-dir={tmp_path}",
                           "--wheel-dir", str(tmp_path)], capture_output=True, text=True)
    assert said.returncode != 0 and "is no build of the package for this Python" in said.stdout + said.stderr, said
    assert list(tmp_path.glob("*.whl")) == []
