"""Shared by the tests: folders to write to, and no bars of progress."""
import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parent))

FALL = """title = "a stone"
[scene]
gravity = [0, 0, -10]
[[scene.body]]
name = "stone"
mass = 2
inertia = [1, 2, 3]
velocity = [1, 0, 0]
[[scene.body]]
name = "wheel"
mass = 1
inertia = [1, 1, 2]
angular_velocity = [0, 0, 3]
position = [5, 0, 0]
[run]
duration = 1
dt = ["1/10", "1/50"]
[truth]
kind = "projectile"
[[gate]]
metric = "position_error"
max = 0.6
because = "semi-implicit Euler is g t dt / 2 = 0.5 m behind after 1 s at dt = 1/10 s; margin 20 %"
"""


@pytest.fixture
def fall(tmp_path):
    path = tmp_path / "fall.toml"
    path.write_text(FALL)
    return str(path)
