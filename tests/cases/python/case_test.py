"""Cases: files, dicts, robots, and the messages of the C++ reader with the path of the value."""
import subprocess

import numpy as np
import pytest

import rigor
from rigor.program import program
from rigor.toml import Writer

SCENE = {"gravity": [0, 0, -10],
         "body": [{"name": "stone", "mass": 2, "inertia": [1, 1, 1], "velocity": (1, 0, 0)},
                  {"name": "ball", "mass": 1, "shape": {"type": "sphere", "radius": 0.5}, "collides": False, "position": [0, 0, 4]}]}
RUN = {"duration": 1, "dt": ["1/10"]}


def test_a_case_of_the_suite_has_typed_attributes():
    case = rigor.load("springs/fixed-spring")
    assert case.name == "springs/fixed-spring" and case.truth == "reference" and case.duration == 5.0
    assert case.dt == ("1/30", "1/240", "1/1000")
    cube = case.scene.bodies[case.scene.index("cube")]
    assert cube.mass == 100 and cube.inertia.shape == (3, 3) and not cube.fixed
    assert case.scene.gravity.tolist() == [0, -9.8, 0]
    assert case.scene.springs[0]["stiffness"] == 1e4
    assert any(gate["metric"] == "position_error" and gate.get("max", 0) > 0 for gate in case.gates)
    with pytest.raises(ValueError):
        case.scene.gravity[0] = 1


def test_the_text_of_a_case_gives_the_same_case():
    case = rigor.load("springs/fixed-spring")
    again = rigor.Case.from_toml(case.to_toml(), name="again")
    assert again.scene.rows == case.scene.rows


def test_a_dict_gives_the_scene_that_its_numbers_say():
    case = rigor.Case.from_dict({"title": "two", "scene": SCENE, "run": RUN}, name="two")
    assert [body.name for body in case.scene.bodies] == ["stone", "ball"]
    assert case.scene.state()[0, 7:10].tolist() == [1, 0, 0]
    # 2/5 m r^2 of a solid ball, by its shape.
    assert np.allclose(case.scene.bodies[1].inertia, 0.4 * 1 * 0.25 * np.eye(3), rtol=1e-14)
    assert case.to_dict()["scene"]["body"][0]["mass"] == 2


def test_arrays_of_numpy_are_lists():
    scene = {**SCENE, "gravity": np.array([0, 0, -3.5]), "body": [{**SCENE["body"][0], "mass": np.float32(2.5), "inertia": np.ones(3)}]}
    case = rigor.Case.from_dict({"title": "t", "scene": scene, "run": RUN})
    assert case.scene.gravity.tolist() == [0, 0, -3.5] and case.scene.bodies[0].mass == 2.5


@pytest.mark.parametrize("change, path, words", [
    ({"mass": -1}, "scene.body[1].mass", "-1"),
    ({"mass": "heavy"}, "scene.body[1].mass", "found a string, 'heavy'"),
    ({"inertia": [1, 1, 5]}, "scene.body[1].inertia", ""),
    ({"velocity": [0, float("nan"), 0]}, "scene.body[1].velocity[1]", ""),
    ({"mas": 1}, "scene.body[1].mas", "did you mean"),
    ({"name": "stone"}, "scene.body[1].name", "at scene.body[0].name"),
    ({"shape": {"type": "sphere", "radius": -2}}, "scene.body[1].shape.radius", ""),
    ({"shape": {"type": "spere", "radius": 2}}, "scene.body[1].shape.type", "sphere"),
    ({"orientation_wxyz": [0, 0, 0, 0]}, "scene.body[1].orientation_wxyz", ""),
])
def test_a_message_begins_with_the_path_of_the_value(change, path, words):
    values = {"title": "t", "scene": {**SCENE, "body": [SCENE["body"][0], {**SCENE["body"][1], **change}]}, "run": RUN}
    with pytest.raises(rigor.InputError) as caught:
        rigor.Case.from_dict(values)
    assert str(caught.value).startswith(caught.value.path + ": "), caught.value
    assert caught.value.path == path and words in str(caught.value), caught.value
    assert "/tmp" not in str(caught.value) and ".toml" not in str(caught.value), caught.value


def test_the_sentence_is_that_of_the_command_line(tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text('title = "t"\n[scene]\n[[scene.body]]\nname = "a"\nmass = -1\ninertia = [1, 1, 1]\n')
    with pytest.raises(rigor.InputError) as caught:
        rigor.Case.from_file(path)
    said = subprocess.run([program(), "run", str(path)], capture_output=True, text=True, cwd=tmp_path)
    assert said.returncode == 2 and said.stderr == f"rigor: {caught.value}\n"
    assert caught.value.path == f"{path}:5:8"


@pytest.mark.parametrize("value, words", [({1, 2}, "set"), (object(), "object"), (10**30, "too large"), (np.array([1j]), "complex"), (b"x", "bytes")])
def test_what_is_no_value_of_a_case_is_named(value, words):
    with pytest.raises(rigor.InputError, match=words) as caught:
        rigor.Case.from_dict({"title": "t", "scene": {**SCENE, "gravity": value}, "run": RUN})
    assert caught.value.path == "scene.gravity"


@pytest.mark.parametrize("call, words", [
    (lambda: rigor.Case.from_dict([1]), "takes a dict"),
    (lambda: rigor.Case.from_dict({"scene": SCENE, "run": RUN}, name="a b"), "name of a case"),
    (lambda: rigor.Case.from_dict({3: 4}), "allowed: a text"),
    (lambda: rigor.Case.from_file("nowhere.toml"), "there is no such file"),
    (lambda: rigor.Case.from_urdf("nowhere.urdf"), "there is no such file"),
    (lambda: rigor.load("springs/fixed-sprin"), "fixed-spring"),
    (lambda: rigor.load("springs"), "takes one case"),
    (lambda: rigor.load(3), "an id, a path or a rigor.Case"),
    (lambda: rigor.load("springs/fixed-spring").replace(**{"scene.body[7].mass": 1}), "the case has no 7"),
    (lambda: rigor.load("springs/fixed-spring").replace(**{"scene.body[0].mass": -1}), "scene.body"),
    (lambda: rigor.load("springs/fixed-spring").replace(**{"scene.body.cub.mass": 1}), "the case has no 'cub' there"),
    (lambda: rigor.load("springs/fixed-spring").replace(**{"scene body": 1}), "no path of a value"),
])
def test_a_wrong_call_is_an_input_error_of_one_sentence(call, words):
    with pytest.raises(rigor.InputError, match=words.replace("[", r"\[")) as caught:
        call()
    assert "\n" not in str(caught.value)


def test_replace_gives_another_checked_case():
    case = rigor.load("springs/fixed-spring")
    other = case.replace(**{"scene.body[0].mass": 50.0, "run.duration": 1})
    assert other.scene.bodies[0].mass == 50 and other.duration == 1
    assert case.replace(**{"scene.body.cube.mass": 50.0}).scene.rows == case.replace(**{"scene.body[0].mass": 50.0}).scene.rows
    assert case.scene.bodies[0].mass == 100


ARM = """<robot name="arm"><link name="base"/>
<link name="arm"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
<limit lower="-2" upper="2" effort="10" velocity="5"/></joint></robot>"""


def test_a_robot_is_imported_with_its_losses_named(tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(ARM)
    case = rigor.Case.from_urdf(path, lossy=True)
    assert case.name == "arm" and case.scene.joints[0]["type"] == "hinge" and case.losses
    # It is a case of its own now, which runs without the flags.
    assert rigor.Case.from_toml(case.to_toml()).scene.rows == case.scene.rows
    with pytest.raises(rigor.RigorError):
        rigor.Case.from_urdf(path, ground=3, lossy=True).from_urdf(tmp_path / "none.urdf")


def test_a_file_of_a_scene_is_found_beside_the_case(tmp_path):
    (tmp_path / "t.csv").write_text("time,torque\n0,1\n1,2\n")
    values = {"title": "t", "scene": {"body": [{"name": "a", "mass": 1, "inertia": [1, 1, 1]}],
                                      "joint": [{"type": "hinge", "name": "h", "a": "world", "b": "a", "anchor": [0, 0, 0], "axis": [0, 0, 1]}],
                                      "motor": [{"joint": "h", "file": "t.csv", "column": "torque"}]}, "run": RUN}
    case = rigor.Case.from_dict(values, folder=tmp_path)
    assert case.scene.motors
    assert len(rigor.trace(case, engine="core:rk4", dt="1/10")) == 11
    assert sorted(path.name for path in tmp_path.iterdir()) == ["t.csv"]
    with pytest.raises(rigor.InputError):
        rigor.Case.from_dict(values)


def test_each_value_has_its_place_in_the_text():
    writer = Writer({"title": "x", "scene": {"g": [1, [2, 3]], "body": [{"a": {"b": [4, 5]}}]}})
    places = {}
    for number, line in enumerate(writer.text.splitlines(), 1):
        for digit in "12345":
            if digit in line:
                places[digit] = writer.path_at(number, line.index(digit) + 1)
    assert places == {"1": "scene.g[0]", "2": "scene.g[1][0]", "3": "scene.g[1][1]", "4": "scene.body[0].a.b[0]", "5": "scene.body[0].a.b[1]"}
