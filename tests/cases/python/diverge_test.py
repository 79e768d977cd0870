"""`diverge`: what it says of two runs whose distance has a formula, and of runs that agree."""
import math

import pytest
from free_bodies import FreeBodies

import rigor


def test_two_schemes_part_by_their_formula(fall):
    """Semi-implicit Euler falls g t dt / 2 ahead of the parabola: 0.05 m after the first step of 0.1 s. rk4 is exact."""
    found = rigor.diverge(fall, engines=["core:semi-implicit-euler", "core:rk4"], dt="1/10", within="position=4cm")
    assert found and found.time == pytest.approx(0.1) and found.body in ("stone", "wheel")
    assert found.gap == pytest.approx(0.05, rel=1e-9) and found.unit == "m" and "z" in found.component
    assert found.nearer == "core:rk4" and found.cause == "gravity"
    assert found.setting in ("method: semi-implicit-euler -> rk4", "method: rk4 -> semi-implicit-euler")
    for words in ("part at t = 0.1 s", "0.05 m", "from the truth: core:semi-implicit-euler 0.05 m, core:rk4 ", "closes 100.0% of the gap"):
        assert words in repr(found), found


def test_runs_within_the_bound_do_not_part(fall):
    found = rigor.diverge(fall, engines=["core:semi-implicit-euler", "core:rk4"], dt="1/10", within="position=60cm")
    assert not found and math.isnan(found.time) and found.body == found.cause == found.setting == found.nearer == ""
    assert repr(found).endswith("agree within the bounds until t = 1 s")


def test_a_class_and_a_case_of_ones_own_are_named(fall):
    with open(fall, encoding="utf-8") as file:
        case = rigor.Case.from_toml(file.read(), name="fall")
    found = rigor.diverge(case, engines=[FreeBodies, "core:rk4"], dt="1/10", within="position=4cm")
    assert found and found.json["case"] == "fall" and found.nearer == "core:rk4" and "/tmp" not in repr(found)


def test_one_engine_with_two_steps(fall):
    found = rigor.diverge(fall, engines="core:semi-implicit-euler", dt=["1/10", "1/50"], within="position=3cm")
    assert found and found.json["a"]["dt"] == "1/10" and found.json["b"]["dt"] == "1/50"
    # g t (1/10 - 1/50) / 2
    assert found.gap == pytest.approx(10 * found.time * 0.08 / 2, rel=1e-9)
