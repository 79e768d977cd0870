"""Each public name has its types and its documentation, with the shapes of arrays and the units of numbers."""
import ast
import importlib
import pathlib
import re
import typing

import numpy as np
import pytest

import rigor

ROOT = pathlib.Path(rigor.__file__).parent
UNIT = re.compile(r"\b(s|m|kg|rad|nan|steps?)\b|\bunit\b|m/s|N m")
SHAPE = re.compile(r"\(([tn\d]|\d+),|\((n|t), ?|structured array|a row each")


def is_text(node):
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def attributes(body, of_self):
    """(name, annotation or None, documentation or "") of what a class or its __init__ sets. A text follows each."""
    for place, node in enumerate(body):
        targets = [node.target] if isinstance(node, ast.AnnAssign) else node.targets if isinstance(node, ast.Assign) else []
        for target in [one for target in targets for one in (target.elts if isinstance(target, ast.Tuple) else [target])]:
            is_own = isinstance(target, ast.Attribute) and isinstance(target.value, ast.Name) and target.value.id == "self"
            name = target.attr if is_own else target.id if isinstance(target, ast.Name) and not of_self else "_"
            if not name.startswith("_"):
                after = body[place + 1] if place + 1 < len(body) else None
                annotation = node.annotation if isinstance(node, ast.AnnAssign) else None
                yield name, annotation, after.value.value if is_text(after) else ""
        if isinstance(node, ast.With):
            yield from attributes(node.body, of_self)


def functions(body):
    return [node for node in body if isinstance(node, ast.FunctionDef)]


def faults_of_function(node, where):
    arguments = node.args
    for one in [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg]:
        if one is not None and one.annotation is None and one.arg not in ("self", "cls"):
            yield f"{where}: {one.arg} has no type"
    if node.name == "__init__":
        return
    told = ast.get_docstring(node) or ""
    if not told:
        yield f"{where} has no documentation"
    if node.returns is None:
        yield f"{where} has no type of its answer"
    yield from faults_of_value(node.returns, told, where)


def faults_of_value(annotation, told, where):
    kind = ast.unparse(annotation) if annotation is not None else ""
    if kind == "float" and not UNIT.search(told):
        yield f"{where} is a number without a unit: {told!r}"
    if kind == "np.ndarray" and not SHAPE.search(told):
        yield f"{where} is an array without a shape: {told!r}"


def faults_of_class(node, where):
    if not ast.get_docstring(node):
        yield f"{where} has no documentation"
    makers = [one for one in functions(node.body) if one.name == "__init__"]
    found = [*attributes(node.body, False), *(row for maker in makers for row in attributes(maker.body, True))]
    for name, annotation, told in found:
        if annotation is None:
            yield f"{where}.{name} has no type"
        if not told:
            yield f"{where}.{name} has no documentation"
        yield from faults_of_value(annotation, told, f"{where}.{name}")
    for one in functions(node.body):
        if one.name == "__init__" or not one.name.startswith("_"):
            yield from faults_of_function(one, f"{where}.{one.name}")


def faults_of(text, names):
    nodes = {node.name: node for node in ast.parse(text).body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    for name in names:
        yield from (faults_of_class if isinstance(nodes[name], ast.ClassDef) else faults_of_function)(nodes[name], name)


@pytest.mark.parametrize("home", rigor._HOMES)
def test_each_name_has_types_and_documentation(home):
    assert list(faults_of((ROOT / f"{home}.py").read_text(), rigor._HOMES[home])) == []


@pytest.mark.parametrize("text, fault", [
    ("class A:\n    pass", "A has no documentation"),
    ("class A:\n    'x'\n    b: int = 1", "A.b has no documentation"),
    ("class A:\n    'x'\n    def __init__(self, b: int):\n        self.b = b\n        'it'", "A.b has no type"),
    ("class A:\n    'x'\n    def b(self) -> int: return 1", "A.b has no documentation"),
    ("class A:\n    'x'\n    b: float = 1\n    'how long it is'", "A.b is a number without a unit: 'how long it is'"),
    ("def A() -> np.ndarray:\n    'The states.'", "A is an array without a shape: 'The states.'"),
    ("def A(b) -> int:\n    'x'", "A: b has no type"), ("def A():\n    'x'", "A has no type of its answer"),
])
def test_what_is_missing_is_found(text, fault):
    assert list(faults_of(text, ["A"])) == [fault]


@pytest.mark.parametrize("name", rigor.__all__)
def test_types_name_what_there_is(name):
    """Each annotation can be read: its names exist."""
    home = importlib.import_module(f"rigor.{rigor._HOME_OF[name]}")
    names = {**{one: getattr(rigor, one) for one in rigor.__all__}, **vars(home), "np": np}
    value = getattr(rigor, name)
    parts = [value, *(part for part in vars(value).values() if callable(part) and hasattr(part, "__annotations__"))] if isinstance(value, type) else [value]
    for part in parts:
        typing.get_type_hints(part, names)


def test_the_stubs_name_what_there_is():
    stub = ast.parse((ROOT / "__init__.pyi").read_text())
    named = {alias.asname for node in stub.body if isinstance(node, ast.ImportFrom) for alias in node.names}
    assert named == set(rigor.__all__)
    native = ast.parse((ROOT / "_native.pyi").read_text())
    from rigor import _native
    assert {node.name for node in functions(native.body)} == {name for name in vars(_native) if not name.startswith("_")}
    assert (ROOT / "py.typed").is_file()


def test_help_shows_the_documentation():
    """What the interpreter's help() shows; texts below attributes are for editors and for the source."""
    for name in rigor.__all__:
        assert len((getattr(rigor, name).__doc__ or "").strip()) > 20, name
