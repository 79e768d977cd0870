"""What an engine tells beside its state: contact forces and settings in force, in a process of its own and inside the cell's."""
import csv
import io

import pytest
from free_bodies import FreeBodies, FreeWorld

import rigor

BOTH = pytest.mark.parametrize("in_process", [False, True], ids=["own-process", "in-process"])
GOOD = "[(0, 1, (0, 0, 0), (0, 0, -1), 0.0, (0, 0, -20))]"


@pytest.fixture
def rest():
    """A ball of 2 kg that lies on the ground: its weight of 20 N is the force on the ground."""
    return rigor.Case.from_dict({
        "title": "a ball at rest",
        "scene": {"gravity": [0, 0, -10], "body": [{"name": "ball", "mass": 2, "shape": {"type": "sphere", "radius": 0.5}, "position": [0, 0, 0.5]},
                                                   {"name": "ground", "shape": {"type": "plane", "normal": [0, 0, 1], "offset": 0}}]},
        "run": {"duration": 0.2, "dt": ["1/10"]}}, name="rest")


def engine(told=GOOD, settings="{}"):
    """An engine that holds all bodies where they are. `told` and `settings` are expressions of Python."""

    class Holds(FreeBodies):
        name = "holds"
        features = ["fixed-body", "contact:plane-sphere", "friction:none"]
        reports_contacts = True

        def load(self, scene, settings_asked):
            import numpy as np
            world = FreeWorld(scene)
            world.step = lambda dt: None
            world.contacts = lambda: eval(told, {"np": np})
            world.settings = eval(settings)
            return world

    return Holds


def contacts(case, cls, in_process):
    text = rigor.command("trace", case, engines=cls, dt="1/10", contacts=True, in_process=in_process).text
    return list(csv.DictReader(io.StringIO(text)))


@BOTH
@pytest.mark.parametrize("told", [GOOD, "[np.array([0, 1, (0, 0, 0), np.array([0, 0, -1]), 0, [0, 0, -20]], dtype=object)]", "iter(" + GOOD + ")"])
def test_its_contacts_are_traced(rest, told, in_process):
    rows = contacts(rest, engine(told), in_process)
    assert [row["time"] for row in rows] and {(row["a"], row["b"]) for row in rows} == {("ball", "ground")}
    assert {tuple(float(row[key]) for key in ("nx", "ny", "nz", "gap", "fx", "fy", "fz")) for row in rows} == {(0, 0, -1, 0, 0, 0, -20)}


@BOTH
@pytest.mark.parametrize("told, words", [
    ("None", "returned None; a list of rows"), ("[3]", "a row that is not"), ("[(0, 1)]", "a row that is not"),
    ("[(0, 1, (0, 0), (0, 0, -1), 0.0, (0, 0, -20))]", "other than 10 finite numbers"),
    ("[(0, 1, (0, 0, np.nan), (0, 0, -1), 0.0, (0, 0, -20))]", "other than 10 finite numbers"),
    ("[(0, 2, (0, 0, 0), (0, 0, -1), 0.0, (0, 0, -20))]", "a body that is none of the 2"),
    ("[('ball', 1, (0, 0, 0), (0, 0, -1), 0.0, (0, 0, -20))]", "a row that is not"), ("1 / 0", "ZeroDivisionError"),
])
def test_contacts_that_are_none_are_a_fault_of_one_sentence(rest, told, words, in_process):
    with pytest.raises(rigor.RigorError, match=words) as caught:
        contacts(rest, engine(told), in_process)
    assert "\n" not in str(caught.value)


@BOTH
def test_its_settings_are_in_the_results(rest, in_process):
    results = rigor.run(rest, engines=engine(settings="{'iterations': 50, 'solver': 'none'}"), in_process=in_process, progress=False)
    assert results.cells[0].row["settings"] == {"iterations": "50", "solver": "none"}, results.cells[0].row
