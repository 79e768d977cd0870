"""`repeat`: engines that give the same bits, and engines that remember or draw lots."""
import json
import subprocess

import pytest
from free_bodies import FreeBodies, FreeWorld, broken

import rigor
from rigor.program import program

BOTH = pytest.mark.parametrize("in_process", [False, True], ids=["own-process", "in-process"])


class Remembers(FreeBodies):
    """Each world of a process is a little heavier than the one before."""
    name = "remembers"
    worlds = 0

    def load(self, scene, settings):
        world = FreeWorld(scene)
        world.gravity = (1 + 1e-9 * Remembers.worlds) * world.gravity
        Remembers.worlds += 1
        return world


class Draws(FreeBodies):
    name = "draws"

    def load(self, scene, settings):
        import random
        world = FreeWorld(scene)
        world.gravity = (1 + 1e-9 * random.SystemRandom().random()) * world.gravity
        return world


def statuses(found):
    run, = found.runs
    return {change["change"]: change["status"] for change in run["changes"]}


def test_the_table_is_that_of_the_command_line(fall):
    found = rigor.repeat(fall, engine="core:rk4", dt="1/50")
    said = subprocess.run([program(), "repeat", fall, "--engine", "core:rk4", "--dt", "1/50", "--json"], capture_output=True, text=True, check=True).stdout
    assert found and found.json == json.loads(said) and found.broken() == []
    assert found.runs[0]["steps"] == 50 and found.runs[0]["repeats"] and statuses(found)["new-process"] == "same-bits"
    assert repr(found).startswith(f"{fall}: core:rk4 at 1/50 s, 50 steps: repeats\n") and "same-bits" in repr(found)


@BOTH
def test_a_sound_engine_repeats(fall, in_process):
    with open(fall, encoding="utf-8") as file:
        case = rigor.Case.from_toml(file.read(), name="fall")
    found = rigor.repeat(case, engine=FreeBodies, dt="1/50", in_process=in_process)
    assert found, found
    assert found.runs[0]["case"] == "fall" and "/tmp" not in repr(found)
    told = statuses(found)
    assert [told[change] for change in ("again", "new-process", "after-another", "beside-another")] == ["same-bits"] * 4, found
    assert told["threads"] == told["restored"] == told["lanes"] == "not-applicable"


@BOTH
def test_an_engine_that_remembers_does_not_repeat(fall, in_process):
    found = rigor.repeat(fall, engine=Remembers, dt="1/50", in_process=in_process)
    told = statuses(found)
    # A new process has made no world before.
    assert not found and told["again"] == told["after-another"] == "differs" and told["new-process"] == "same-bits", found
    first = next(change for change in found.broken() if change["change"] == "again")
    # Gravity acts in the first step.
    assert first["case"] == fall and first["step"] == 1 and first["body"] in ("stone", "wheel")
    # 1e-9 g T (T + dt) / 2 below at the end
    assert first["position"] == pytest.approx(1e-9 * 10 * 1 * 1.02 / 2, rel=1e-3)
    assert "DIFFERS from step 1 on" in repr(found) and repr(found).splitlines()[0].endswith("does not repeat")


@BOTH
def test_an_engine_that_draws_lots_does_not_repeat(fall, in_process):
    found = rigor.repeat(fall, engine=Draws, dt="1/50", in_process=in_process)
    assert not found and statuses(found)["new-process"] == "differs" and {"again", "new-process"} <= {change["change"] for change in found.broken()}, found


@BOTH
def test_an_engine_that_fails_is_an_error_of_one_sentence(fall, in_process):
    with pytest.raises(rigor.InputError, match="ZeroDivisionError: division by zero") as caught:
        rigor.repeat(fall, engine=broken("step", "1 / 0"), dt="1/50", in_process=in_process)
    assert "\n" not in str(caught.value)


def test_progress_is_told(fall):
    told = []
    assert rigor.repeat(fall, engine=FreeBodies, dt="1/50", progress=lambda done, all_: told.append((done, all_)))
    assert max(told) > (0, 0) and all(0 <= done <= all_ for done, all_ in told)  # nothing is done at first
    told.clear()
    assert rigor.conform(FreeBodies, progress=lambda done, all_: told.append((done, all_)))
    assert max(told) > (0, 0) and all(0 <= done <= all_ for done, all_ in told)  # nothing is done at first


def test_several_cases_are_several_rows(fall):
    found = rigor.repeat([fall, "ballistic/free-fall"], engine="core:rk4", dt="1/50", duration=0.5)
    assert found and [run["case"] for run in found.runs] == [fall, "ballistic/free-fall"]


def test_hashes_are_compared(fall, tmp_path):
    hashes = tmp_path / "hashes.jsonl"
    written = rigor.repeat(fall, engine=Remembers, dt="1/50", record=hashes)
    assert written and written.runs == [] and len(hashes.read_text().splitlines()) == 1
    same = rigor.repeat(fall, engine=Remembers, dt="1/50", against=hashes)
    assert same and "same bits in 50 steps" in repr(same)
    other = rigor.repeat(fall, engine=Draws, dt="1/50", record=tmp_path / "other.jsonl")
    assert other and not rigor.repeat(fall, engine=Draws, dt="1/50", against=tmp_path / "other.jsonl")


@pytest.mark.parametrize("options, words", [
    ({"engine": "core:rk5"}, "did you mean"),
    ({"engine": ["ode", "bullet"]}, "--engine"),
    ({"dt": ["1/10", "1/50"]}, "at most one --dt"),
    ({"dt": "soon"}, "--dt"),
    ({"cases": None}, "at least one case"),
    ({"cases": "no/such-case"}, "no/such-case"),
    ({"record": "a", "against": "b"}, "exclude each other"),
    ({"against": "absent.jsonl"}, "absent.jsonl"),
])
def test_a_wrong_call_says_what_is_allowed(fall, options, words):
    with pytest.raises(rigor.InputError, match=words):
        rigor.repeat(**{"cases": fall, "engine": "core:rk4", "dt": "1/10", **options})
