"""Engines as classes: in a process of their own and inside the cell's, with the same numbers; and each way to do it wrong."""
import dataclasses
import os
import re
import sys
import textwrap

import numpy as np
import pytest
from free_bodies import FreeBodies, FreeWorld

import rigor

BOTH = pytest.mark.parametrize("in_process", [False, True], ids=["own-process", "in-process"])


@BOTH
def test_an_engine_conforms(in_process):
    answer = rigor.conform(FreeBodies, in_process=in_process)
    assert answer, answer
    assert sum(check["answer"] == "holds" for check in answer.checks) >= 10


@BOTH
def test_its_motion_is_that_of_the_same_scheme(in_process):
    """The core's semi-implicit Euler steps points alike, so a spring that pulls at the centre moves both alike."""
    case = rigor.load("springs/stiff-1")
    mine = rigor.trace(case, engine=FreeBodies, dt="1/240", duration=1, in_process=in_process)
    core = rigor.trace(case, engine="core:semi-implicit-euler", dt="1/240", duration=1)
    assert rigor.close(mine, core, within="1nm"), rigor.close(mine, core, within="1nm")


@BOTH
def test_both_ways_give_the_same_bits(in_process):
    one = rigor.trace("tops/dzhanibekov-box", engine=FreeBodies, dt="1/240", duration=1, in_process=in_process)
    other = rigor.trace("tops/dzhanibekov-box", engine=FreeBodies, dt="1/240", duration=1, in_process=not in_process)
    assert (one.state() == other.state()).all()


def test_it_is_a_column_like_any_other():
    results = rigor.run(["tops/dzhanibekov-box", "contact/bounce-half"], engines=["core:rk4", FreeBodies], dt="1/240", duration=1, progress=False)
    mine = {cell.case: cell for cell in results.cells if cell.engine == "numpy"}
    # It falls g t dt / 2 short of the parabola.
    assert mine["tops/dzhanibekov-box"].metric("position_error") == pytest.approx(9.8 / 480, rel=1e-3)
    assert mine["contact/bounce-half"].status == "unsupported" and mine["contact/bounce-half"].reason


def test_a_class_of_a_function_and_what_it_closes_over_travel_too():
    factor = 2.0

    class Local(FreeBodies):
        name = "local"

        def load(self, scene, settings):
            world = FreeWorld(scene)
            world.gravity = factor * world.gravity
            return world

    traj = rigor.trace("ballistic/free-fall", engine=Local, dt="1/240", duration=1)
    half = rigor.trace("ballistic/free-fall", engine=FreeBodies, dt="1/240", duration=1)
    fall = [(t.position[-1] - t.position[0]) - t.velocity[0] for t in (traj, half)]
    assert np.allclose(fall[0], 2 * fall[1], rtol=0.01)


class Broken(FreeBodies):
    name = "broken"
    world_class = FreeWorld

    def load(self, scene, settings):
        return self.world_class(scene)


def broken(method, body):
    """A class whose world has another `step` or `read`; a step is the tenth, so that it fails on the way."""
    namespace = {"np": np, "os": os, "sys": sys, "FreeWorld": FreeWorld, "rigor": rigor}
    source = f"""
class Faulty(FreeWorld):
    def __init__(self, scene):
        super().__init__(scene)
        self.count = 0
    def step(self, dt, wrenches=None):
        self.count += 1
        if '{method}' == 'step' and self.count == 10:
{textwrap.indent(textwrap.dedent(body), ' ' * 12)}
        super().step(dt, wrenches)
    def read(self):
        if '{method}' == 'read' and self.count == 10:
{textwrap.indent(textwrap.dedent(body), ' ' * 12)}
        return self.rows
"""
    exec(source, namespace)
    return type("Broken", (Broken,), {"world_class": namespace["Faulty"], "__module__": "__main__"})


@dataclasses.dataclass
class Fault:
    method: str
    body: str
    status: str
    words: str


FAULTS = {
    "wrong shape": Fault("read", "return self.rows[:, :12]", "crashed", r"shape \(2, 12\); an array of shape \(2, 13\) is due"),
    "forgets a body": Fault("read", "return self.rows[:0]", "crashed", r"shape \(0, 13\)"),
    "transposed": Fault("read", "return self.rows.T", "crashed", r"shape \(13, 2\)"),
    "flat": Fault("read", "return self.rows.ravel()", "crashed", r"shape \(26,\)"),
    "None": Fault("read", "return None", "crashed", "returned None; an array of shape"),
    "text": Fault("read", "return 'state'", "crashed", "returned a str"),
    "complex": Fault("read", "return self.rows.astype(complex)", "crashed", "dtype complex128; float64 is due"),
    "truth values": Fault("read", "return self.rows > 0", "crashed", "dtype bool"),
    "objects": Fault("read", "return self.rows.astype(object)", "crashed", "dtype object"),
    "ragged": Fault("read", "return [[1, 2], [3]]", "crashed", "no array"),
    "NaN": Fault("read", "rows = self.rows.copy(); rows[0, 2] = np.nan; return rows", "diverged", "is not finite"),
    "infinity": Fault("read", "rows = self.rows.copy(); rows[0, 8] = np.inf; return rows", "diverged", "is not finite"),
    "raises in read": Fault("read", "raise KeyError('lost')", "crashed", "KeyError: 'lost'"),
    "raises in step": Fault("step", "1 / 0", "crashed", "ZeroDivisionError: division by zero"),
    "returns something from step": Fault("step", "return self.rows", "crashed", r"step\(\) returned a ndarray"),
    "exits": Fault("step", "sys.exit(3)", "crashed", r"called sys.exit\(3\)"),
    "exits well": Fault("step", "sys.exit()", "crashed", r"called sys.exit\(\)"),
    "exits hard": Fault("step", "os._exit(0)", "crashed", ""),
    "kills itself": Fault("step", "os.kill(os.getpid(), 11)", "crashed", "SEGV"),
    "interrupts": Fault("step", "raise KeyboardInterrupt", "crashed", "KeyboardInterrupt"),
    "diverges": Fault("step", "raise rigor.DivergedError('too fast')", "diverged", "too fast"),
    "hangs": Fault("step", "while True: pass", "timed-out", ""),
}


@pytest.fixture(scope="module", params=[False], ids=["own-process"])
def faulty_cells(request, tmp_path_factory):
    """The cells of all faults, in one gate: it searches no largest step."""
    from conftest import FALL
    case = rigor.Case.from_toml(FALL, name="fall")
    engines = []
    for number, fault in enumerate(FAULTS.values()):
        engines.append(broken(fault.method, fault.body))
        engines[-1].name = f"fault-{number}"
    results = rigor.gate(case, engines=engines, dt="1/50", in_process=request.param, timeout=20, progress=False)
    assert not results.passed
    return {cell.engine: cell for cell in results.cells}


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_costs_the_cell_and_has_one_sentence(faulty_cells, name):
    fault = FAULTS[name]
    cell = faulty_cells[f"fault-{list(FAULTS).index(name)}"]
    assert cell.status == fault.status, cell.reason
    assert re.search(fault.words, cell.reason), cell.reason
    assert "Traceback" not in cell.reason and "\n" not in cell.reason


@BOTH
@pytest.mark.parametrize("body", ["self.rows = np.asfortranarray(self.rows)", "self.rows = np.repeat(self.rows, 2, axis=0)[::2]",
                                  "self.rows = np.repeat(self.rows, 2, axis=1)[:, ::2]", "self.rows = self.rows[::-1][::-1]",
                                  "back = np.zeros((1, 27))[:, 1:]; back[:, ::2] = self.rows; self.rows = back[:, ::2]"])
def test_strides_are_no_fault(body, in_process):
    mine = rigor.trace("ballistic/free-fall", engine=broken("step", body), dt="1/30", duration=1, in_process=in_process)
    plain = rigor.trace("ballistic/free-fall", engine=FreeBodies, dt="1/30", duration=1)
    assert (mine.state() == plain.state()).all()


@BOTH
@pytest.mark.parametrize("dtype, tolerance", [("np.float32", 1e-5), ("'>f8'", 0), ("np.float16", 0.1)])
def test_other_floats_are_converted(dtype, tolerance, in_process):
    mine = rigor.trace("ballistic/free-fall", engine=broken("read", f"return self.rows.astype({dtype})"), dt="1/30", duration=1, in_process=in_process)
    plain = rigor.trace("ballistic/free-fall", engine=FreeBodies, dt="1/30", duration=1)
    assert np.allclose(mine.state(), plain.state(), rtol=tolerance, atol=tolerance)


@BOTH
def test_a_state_that_is_changed_after_it_was_returned_is_no_fault(in_process):
    """read() gives its own array, which the next step changes; a run needs the states of each time."""
    traj = rigor.trace("ballistic/free-fall", engine=FreeBodies, dt="1/30", duration=1, in_process=in_process)
    assert len(np.unique(traj.position[:, 0, :].sum(axis=1))) == len(traj.times)


@BOTH
def test_what_it_prints_does_not_mix_with_the_answers(in_process):
    mine = rigor.trace("ballistic/free-fall", engine=broken("step", "print('hello'); os.write(1, b'{}')"), dt="1/30", duration=1, in_process=in_process)
    assert len(mine.times) == 31


@BOTH
def test_a_scene_that_it_refuses_is_unsupported(in_process):
    class Picky(FreeBodies):
        name = "picky"

        def load(self, scene, settings):
            raise rigor.UnsupportedError("no wheels")

    with pytest.raises(rigor.UnsupportedError, match="no wheels"):
        rigor.trace("ballistic/free-fall", engine=Picky, dt="1/30", in_process=in_process)
