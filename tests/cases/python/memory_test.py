"""Runs in a loop leave nothing behind: no memory, no open files, no folders, no processes."""
import glob
import os
import resource
import tempfile

import pytest
from free_bodies import FreeBodies

import rigor

RUNS = 14
# Of all runs together, for the allocator's own doing; the results of one run alone take more than a quarter of it, so
# that those of eight are seen.
ALLOWED = 2.0  # MiB


def resident():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * resource.getpagesize() / 2**20


def children():
    with open(f"/proc/self/task/{os.getpid()}/children", encoding="ascii") as file:
        return file.read().split()


def once(case):
    results = rigor.run(case, engines=["core:rk4", "core:semi-implicit-euler"], dt=["1/10", "1/50"], progress=False)
    cell = results.cells[0]
    frame = results.to_dataframe()
    traj = rigor.trace(case, engine="core:rk4", dt="1/50")
    close = rigor.close(traj, rigor.truth(case, times=traj))
    return results, cell.trajectory(), cell.series("position_error"), frame, traj, close, results._repr_html_()


@pytest.fixture
def case(fall):
    with open(fall, encoding="utf-8") as file:
        return rigor.Case.from_toml(file.read(), name="fall")


def growth(work, runs):
    """MiB that `runs` calls leave behind, once what is made only once is there."""
    for _ in range(5):
        work()
    before = resident()
    for _ in range(runs):
        work()
    return resident() - before


def test_runs_in_a_loop_leave_nothing_behind(case, tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    once(case)
    files = len(os.listdir("/proc/self/fd"))
    grown = growth(lambda: once(case), RUNS)
    assert grown < ALLOWED, f"{RUNS} runs left {grown:.1f} MiB behind"
    assert len(os.listdir("/proc/self/fd")) == files
    assert glob.glob(f"{tmp_path}/rigor-*") == [] and children() == []


def test_engines_in_a_loop_leave_nothing_behind(case, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))  # other tests write to the user's cache meanwhile
    folders = set()

    def work():
        rigor.trace(case, engine=FreeBodies, dt="1/10")
        folders.add(len(os.listdir(tmp_path / "rigor" / "python")))

    grown = growth(work, 12)
    assert grown < ALLOWED and folders == {1} and children() == []


def test_what_is_kept_is_found(case):
    """The same loop with a leak of a megabyte a run: some of it may be swapped out meanwhile."""
    kept = []
    assert growth(lambda: kept.append((once(case), bytearray(os.urandom(2**20)))), RUNS // 2) > ALLOWED
