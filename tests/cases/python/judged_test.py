"""Engines with a planted mistake: `conform` and `diagnose` name it, and find none in a sound engine."""
import numpy as np
import pytest
from free_bodies import FreeBodies, FreeWorld

import rigor

BOTH = pytest.mark.parametrize("in_process", [False, True], ids=["own-process", "in-process"])


class Heavy(FreeBodies):
    """Gravity is 5 % too strong."""
    name = "heavy"

    def load(self, scene, settings):
        world = FreeWorld(scene)
        world.gravity = 1.05 * world.gravity
        return world


class TurnedWorld(FreeWorld):
    """Reports angular velocities in the body's frame."""

    def read(self):
        rows = self.rows.copy()
        q = rows[:, 3:7] * [1, -1, -1, -1]
        rows[:, 10:13] += 2 * np.cross(q[:, 1:], np.cross(q[:, 1:], rows[:, 10:13]) + q[:, :1] * rows[:, 10:13])
        return rows


class Turned(FreeBodies):
    name = "turned"

    def load(self, scene, settings):
        return TurnedWorld(scene)


@BOTH
def test_a_sound_engine_conforms(in_process):
    checks = rigor.conform(FreeBodies, in_process=in_process)
    assert checks and not checks.broken(), checks
    assert sum(check["answer"] == "holds" for check in checks.checks) >= 10


def test_conform_names_what_a_mistake_breaks():
    checks = rigor.conform(Turned)
    answers = {check["name"]: check["answer"] for check in checks.checks}
    assert not checks and {"spin", "load-then-read"} <= {name for name, answer in answers.items() if answer == "broken"}, checks
    assert {answers[name] for name in ("free-fall", "fixed-body", "time")} == {"holds"}, checks
    assert all(check["came"] and check["due"] for check in checks.broken())
    assert all(f"broken    {check['name']}" in repr(checks) for check in checks.broken())


@BOTH
def test_diagnose_names_the_mistake(in_process):
    found = rigor.diagnose("ballistic/free-fall", engine=Heavy, in_process=in_process, progress=False)
    assert not found and found.verdict == "named" and found.mistakes == ("gravity off by 5 %",), found
    # The mistake explains the error to rounding; the next suspect does not.
    assert found.suspects[0]["explains"] > 0.999999 and found.suspects[1]["explains"] < 0.9
    assert repr(found).startswith("heavy: looks like: gravity off by 5 %, in 1 cases")


def test_diagnose_names_a_mistake_of_turning():
    found = rigor.diagnose("tops/dzhanibekov-box", engine=Turned, in_process=True, progress=False)
    assert not found and any("angular velocit" in mistake for mistake in found.mistakes), found


def test_diagnose_finds_none_in_a_sound_engine():
    found = rigor.diagnose("ballistic/free-fall", engine=FreeBodies, in_process=True, progress=False)
    assert found and found.verdict == "right" and found.mistakes == () and "no error beyond" in repr(found), found
