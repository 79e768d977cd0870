"""Engines as classes: in a process of their own and inside the cell's, with the same numbers."""
import numpy as np
import pytest
from free_bodies import FreeBodies, FreeWorld, broken

import rigor

BOTH = pytest.mark.parametrize("in_process", [False, True], ids=["own-process", "in-process"])


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
