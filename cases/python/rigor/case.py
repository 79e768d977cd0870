"""Cases: a scene, how to run it, its truth and its gates. The program's own reader checks each of them."""
from __future__ import annotations

import copy
import json
import os
import pathlib
import re
import tempfile
import typing

from . import program
from .errors import InputError, RigorError
from .toml import Writer

if typing.TYPE_CHECKING:
    from .scene import Scene

_PLACE = re.compile(r"^(?P<file>.+?):(?P<line>\d+):(?P<column>\d+): (?P<rest>.*)$", re.DOTALL)
CaseWord = typing.Union[str, "os.PathLike[str]", "Case"]


def _show(words: typing.Sequence[str], flags: typing.Sequence[str] = ()) -> list[dict[str, typing.Any]]:
    done = program.checked(program.call(["show", *words, *flags]))
    return json.loads(done.out)["cases"]


class Case:
    """A case that the reader has accepted. It does not change; ``replace`` returns another."""

    def __init__(self, facts: dict[str, typing.Any], *, file: str | None, folder: str | None, name: str, values: dict[str, typing.Any] | None):
        self._facts, self._file, self._folder, self._values = facts, file, folder, values
        self.name: str = name
        """What results call the case."""
        self.title: str = facts["title"]
        """What the case shows, in a line."""
        self.source: str = facts["source"]
        """Where the case comes from, as a paper or a file; empty if it does not say."""
        self.duration: float = facts["duration"]
        """s"""
        self.dt: tuple[str, ...] = tuple(facts["dt"])
        """The steps [s] as written, ``("1/30", "1/240")``."""
        self.ensemble: int = facts["ensemble"]
        """The number of starts, up to 1e-6 m apart, that each run is repeated from; 0 for one run."""
        self.truth: str = facts["truth"]
        """A row of ``rigor list truths``, or ``"none"``."""
        self.gates: tuple[typing.Mapping[str, typing.Any], ...] = tuple(facts["gates"])
        """Rows of the case and its family: ``metric``, ``max`` and so on, ``because``, ``where``."""
        self.losses: tuple[str, ...] = tuple(loss["sentence"] for loss in facts["losses"])
        """What the import of a robot's file left out or assumed, a sentence each."""
        self._scene: Scene | None = None

    def __repr__(self) -> str:
        return f"<rigor.Case {self.name!r}: {self.title}>"

    @property
    def scene(self) -> Scene:
        """The scene with each default written out and arrays of bodies expanded."""
        if self._scene is None:
            from .scene import Scene
            self._scene = Scene(self._facts["scene"])
        return self._scene

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Case:
        """A case file, ``.toml``. InputError with file:line:column for anything that the format does not allow."""
        text = os.fspath(path)
        if not os.path.isfile(text):
            raise InputError(f"{text}: there is no such file; rigor.load() takes the id of a case of the suite")
        return cls._of_file(text, ())

    @classmethod
    def from_urdf(cls, path: str | os.PathLike[str], *, ground: bool = False, lossy: bool = False, repair_inertia: bool = False) -> Case:
        """A robot's file, URDF or SDF. Physics that would be lost is an InputError unless `lossy`; see ``losses``."""
        return cls._imported(path, ground=ground, lossy=lossy, repair_inertia=repair_inertia)

    @classmethod
    def from_mjcf(cls, path: str | os.PathLike[str], *, keyframe: str | None = None, ground: bool = False, lossy: bool = False,
                  repair_inertia: bool = False) -> Case:
        """A model of MuJoCo. `keyframe` names its initial state."""
        return cls._imported(path, keyframe=keyframe, ground=ground, lossy=lossy, repair_inertia=repair_inertia)

    @classmethod
    def _imported(cls, path: str | os.PathLike[str], keyframe: str | None = None, **flags: bool) -> Case:
        text = os.fspath(path)
        if not os.path.isfile(text):
            raise InputError(f"{text}: there is no such file")
        words = [f"--{name.replace('_', '-')}" for name, is_on in flags.items() if is_on]
        made = cls._of_file(text, [*words, *([] if keyframe is None else ["--keyframe", keyframe])])
        # The case is now the case file that the import makes, so the flags need not be given again.
        made._file, made.name = None, pathlib.Path(text).stem
        return made

    @classmethod
    def _of_file(cls, path: str, flags: typing.Sequence[str]) -> Case:
        shown = _show([path], flags)
        if len(shown) != 1:
            raise InputError(f"{path}: takes one case, and there are {len(shown)} of them")
        path_now = os.path.abspath(path)
        return cls(shown[0], file=path_now, folder=os.path.dirname(path_now), name=path, values=None)

    @classmethod
    def from_dict(cls, values: typing.Mapping[str, typing.Any], *, name: str = "case", folder: str | os.PathLike[str] | None = None) -> Case:
        """The keys of a case file as a dict; lists, tuples and arrays of numpy alike.

        `name` is what results call the case. `folder` is where files that the scene names are looked up. InputError begins
        with the path of the value, as ``scene.body[0].mass``.
        """
        if not isinstance(values, dict):
            raise InputError(f"from_dict: takes a dict with the keys of a case file, and not a {type(values).__name__}")
        writer = Writer(values)
        return cls._of_text(writer.text, name, folder, writer, copy.deepcopy(dict(values)))

    @classmethod
    def from_toml(cls, text: str, *, name: str = "case", folder: str | os.PathLike[str] | None = None) -> Case:
        """The text of a case file."""
        return cls._of_text(text, name, folder, None, None)

    @classmethod
    def _of_text(cls, text: str, name: str, folder: str | os.PathLike[str] | None, writer: Writer | None,
                 values: dict[str, typing.Any] | None) -> Case:
        if not re.fullmatch(r"[\w.-]+", name):
            raise InputError(f"the name of a case is {name!r}; allowed: letters, digits, '_', '-' and '.'")
        where = None if folder is None else os.path.abspath(folder)
        with WrittenCases() as written:
            path = written.write(text, name, where)
            try:
                shown = _show([path])
            except InputError as error:
                raise _with_path(error, path, writer, name) from None
        return cls(shown[0], file=None, folder=where, name=name, values=values)

    def to_toml(self) -> str:
        """The case file. ``from_toml`` of it gives the same case."""
        return self._facts["text"]

    def to_dict(self) -> dict[str, typing.Any]:
        """The case as a dict for ``from_dict``: as given there, else as the file says."""
        if self._values is not None:
            return copy.deepcopy(self._values)
        import tomllib
        return tomllib.loads(self.to_toml())

    def replace(self, **values: typing.Any) -> Case:
        """The same case with other values, checked again: ``case.replace(**{"scene.body[0].mass": 2.0, "run.duration": 5})``.

        A path may also name a row, as ``scene.body.cube.mass``. The values of ``rigor.fit`` can be given as they are.
        """
        changed = self.to_dict()
        for path, value in values.items():
            _set(changed, path, value)
        return Case.from_dict(changed, name=re.sub(r"[^\w.-]", "-", pathlib.PurePath(self.name).stem), folder=self._folder)


def _with_path(error: InputError, file: str, writer: Writer | None, name: str) -> InputError:
    """The same message, with paths of values in place of lines of a file that nobody wrote."""
    def place(line: str, column: str) -> str:
        return (writer.path_at(int(line), int(column)) if writer is not None else None) or f"{name}:{line}:{column}"

    text = re.sub(re.escape(file) + r":(\d+):(\d+)", lambda match: place(match[1], match[2]), str(error)).replace(file, name)
    match = _PLACE.match(str(error))
    if match is None or match["file"] != file:
        return InputError(text, error.path)
    path = place(match["line"], match["column"])
    # The reader names the key too, without the numbers of rows.
    without_numbers = re.sub(r"\[\d+\]", "", path)
    rest = text.removeprefix(f"{path}: ").removeprefix(f"{without_numbers}: ")
    return InputError(f"{path}: {rest}", path)


def _set(values: typing.Any, path: str, value: typing.Any) -> None:
    steps: list[str | int] = []
    for word in path.replace("__", ".").split("."):
        match = re.fullmatch(r"([\w-]+)((?:\[\d+\])*)", word)
        if match is None:
            raise InputError(f"{path}: is no path of a value; an example is scene.body[0].mass", path)
        steps += [match[1], *(int(number) for number in re.findall(r"\d+", match[2]))]
    at = values
    for step, following in zip(steps, steps[1:]):
        try:
            if isinstance(at, list) and isinstance(step, str):
                at = _row(at, step)
            else:
                at = at.setdefault(step, {}) if isinstance(at, dict) and isinstance(following, str) else at[step]
        except (KeyError, IndexError, TypeError):
            raise InputError(f"{path}: the case has no {step!r} there", path) from None
    try:
        at[steps[-1]] = value
    except (IndexError, TypeError):
        raise InputError(f"{path}: the case has no {steps[-1]!r} there", path) from None


def _row(rows: list[typing.Any], name: str) -> typing.Any:
    """The row with this name, as in ``scene.body.cube.mass``. KeyError for a name that no row or several have."""
    named = [row for row in rows if isinstance(row, dict) and row.get("name") == name]
    if len(named) != 1:
        raise KeyError(name)
    return named[0]


class WrittenCases:
    """Cases that are no files, written to files for the program; they are removed at the end."""

    def __init__(self) -> None:
        self._made: list[str] = []
        self._folders: list[tempfile.TemporaryDirectory[str]] = []
        self.names: dict[str, str] = {}
        """The case's name by the path that the program gets, which results would show."""

    def __enter__(self) -> WrittenCases:
        return self

    def __exit__(self, *_: object) -> None:
        for path in self._made:
            try:
                os.remove(path)
            except FileNotFoundError:
                pass
        for folder in self._folders:
            folder.cleanup()

    def write(self, text: str, name: str, folder: str | None) -> str:
        # Files that a scene names must be beside the case file.
        if folder is None:
            self._folders.append(tempfile.TemporaryDirectory(prefix="rigor-"))
            path = os.path.join(self._folders[-1].name, f"{name}.toml")
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
        else:
            try:
                descriptor, path = tempfile.mkstemp(prefix=f".{name}-", suffix=".toml", dir=folder)
            except OSError as error:
                raise RigorError(f"the case '{name}' names files in '{folder}', where it cannot be written: {error.strerror}") from None
            with open(descriptor, "w", encoding="utf-8") as file:
                file.write(text)
            self._made.append(path)
        self.names[path] = name
        return path

    def word(self, case: CaseWord) -> str:
        """The case as a word of the command line."""
        if isinstance(case, Case):
            if case._file is None:
                return self.write(case.to_toml(), case.name, case._folder)
            self.names[case._file] = case.name
            return case._file
        if isinstance(case, (str, os.PathLike)):
            return os.fspath(case)
        raise InputError(f"a case is an id, a path or a rigor.Case, and not a {type(case).__name__}")

    def words(self, cases: CaseWord | typing.Iterable[CaseWord] | None) -> list[str]:
        if cases is None:
            return []
        if isinstance(cases, (str, os.PathLike, Case)):
            cases = [cases]
        words = [self.word(case) for case in cases]
        if not words:
            raise InputError("the list of cases is empty; without it the whole suite runs")
        return words


def load(case: CaseWord) -> Case:
    """One case: of the suite by its id (``"springs/fixed-spring"``), or a file."""
    if isinstance(case, Case):
        return case
    word = WrittenCases().word(case)
    shown = _show([word])
    if len(shown) != 1:
        raise InputError(f"load: takes one case, and '{word}' names {len(shown)} of them: {', '.join(row['id'] for row in shown[:5])} …")
    # Only a file has a folder of its own; a case of the suite is known by its id.
    if not os.path.isfile(word):
        return Case(shown[0], file=word, folder=None, name=shown[0]["id"], values=None)
    path = os.path.abspath(word)
    return Case(shown[0], file=path, folder=os.path.dirname(path), name=word, values=None)
