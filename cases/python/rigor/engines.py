"""Engines as classes, and how the program reaches them."""
from __future__ import annotations

import base64
import hashlib
import inspect
import json
import os
import pathlib
import re
import shlex
import shutil
import sys
import tempfile
import time
import typing

from .errors import InputError, RigorError

if typing.TYPE_CHECKING:
    import numpy as np

    from .scene import Scene

_HERE = pathlib.Path(__file__).resolve().parent
_KEPT_FOR = 30 * 86400.0  # s
_NAME = re.compile(r"[A-Za-z0-9._-]{1,64}")
Settings = typing.Mapping[str, typing.Any]


class World(typing.Protocol):
    """What ``Engine.load`` returns. Any object with these methods will do."""

    def step(self, dt: float, wrenches: np.ndarray | None = None) -> None:
        """Exactly one step of `dt` seconds.

        With the feature ``wrench`` and springs, dampers or timed forces in the scene, `wrenches` is (n, 6): force [N] and
        torque [N m] about each body's centre of mass, in W, for this step only.
        """

    def read(self) -> np.ndarray:
        """(n, 13), float64: px py pz [m], qw qx qy qz, vx vy vz [m/s], wx wy wz [rad/s], in W, in the scene's order."""


class Engine:
    """An engine of your own: derive a class, state what it can do, and write ``load``.

    Each cell makes a new object in a process of its own, so an engine may keep state.
    """

    name: str = ""
    """1 to 64 letters, digits, '.', '_' and '-'; by default the class's name in small letters."""
    version: str = "1"
    """Of the engine, for reports."""
    precision: str = "double"
    """``"double"`` or ``"single"``: gates widen their limits for the rounding of single precision."""
    features: typing.Sequence[str] = ()
    """What scenes may have: ``"fixed-body"``, ``"wrench"`` (Rigor computes springs and forces), ``"joint:hinge"``,
    ``"contact:plane-sphere"`` and so on; see ``rigor list engines``. A scene with anything else is ``unsupported``."""
    methods: typing.Sequence[typing.Mapping[str, typing.Any]] = ({"name": "default", "order": 1},)
    """A row for each method: ``name``, ``summary``, ``order``, ``symplectic``, ``leapfrog_stagger`` (0.5 for a semi-implicit
    step, whose velocities lag half a step behind its positions), ``options``. The first is the default."""
    reports_contacts: bool = False
    """Whether worlds have ``contacts()``: rows (a, b, point, normal, gap, force on b) of the last step."""
    in_process: bool = False
    """Whether Python runs inside the cell's process, for speed. Otherwise the engine has a process of its own."""

    def load(self, scene: Scene, settings: Settings) -> World:
        """A world at t = 0. `settings` has ``method``, ``track`` and ``options``. UnsupportedError refuses a scene."""
        raise NotImplementedError(f"{type(self).__name__} has no load(scene, settings)")


def described(engine: Engine) -> dict[str, typing.Any]:
    """The engine's own description, checked."""
    cls = type(engine).__name__
    name = engine.name or cls.lower()
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise InputError(f"{cls}.name is {name!r}; allowed: 1 to 64 letters, digits, '.', '_' and '-'")
    if engine.precision not in ("double", "single"):
        raise InputError(f"{cls}.precision is {engine.precision!r}; allowed: 'double' and 'single'")
    if isinstance(engine.features, str) or not all(isinstance(feature, str) and feature for feature in engine.features):
        raise InputError(f"{cls}.features is {engine.features!r}; it is a list of texts, as [\"wrench\", \"fixed-body\"]")
    methods = [dict(method) for method in engine.methods]
    if not methods or not all(isinstance(method.get("name"), str) and method["name"] for method in methods):
        raise InputError(f"{cls}.methods is {engine.methods!r}; it is a list of dicts, each with a name")
    for method in methods:
        method.setdefault("summary", method["name"])
        method.setdefault("options", [])
    return {"name": name, "version": str(engine.version), "precision": engine.precision, "features": list(engine.features), "methods": methods}


def specification_of_words(words: typing.Sequence[str]) -> dict[str, typing.Any]:
    """Of ``python3 -m rigor.serve``: ``module:Class``, or the path of a specification."""
    if len(words) != 1:
        raise InputError("rigor.serve: takes one word, module:Class")
    if words[0].endswith(".json"):
        with open(words[0], encoding="utf-8") as file:
            specification: dict[str, typing.Any] = json.load(file)
        sys.path[:] = specification["sys_path"]
        return specification
    module, colon, name = words[0].partition(":")
    if not colon or not module or not name:
        raise InputError(f"rigor.serve: '{words[0]}' is no module:Class, as my_module:MyEngine")
    if os.getcwd() not in sys.path and "" not in sys.path:
        sys.path.insert(0, os.getcwd())
    return {"module": module, "class": name}


def _is_importable(cls: type) -> bool:
    module = sys.modules.get(cls.__module__)
    if cls.__module__ == "__main__" or module is None or "<" in cls.__qualname__:
        return False
    found: typing.Any = module
    for name in cls.__qualname__.split("."):
        found = getattr(found, name, None)
    spec = getattr(module, "__spec__", None)
    return found is cls and spec is not None and spec.origin is not None


def specification(cls: type[Engine]) -> dict[str, typing.Any]:
    """How another process finds the class: by the module's name, or by value for a class of a script, notebook or function."""
    made: dict[str, typing.Any] = {"executable": sys.executable, "contacts": bool(cls.reports_contacts)}
    made["sys_path"] = [path or os.getcwd() for path in sys.path]
    if str(_HERE.parent) not in made["sys_path"]:
        made["sys_path"].append(str(_HERE.parent))
    if _is_importable(cls):
        made.update({"module": cls.__module__, "class": cls.__qualname__})
        try:  # with its source, so that a run does not continue results of another version
            with open(inspect.getfile(cls), "rb") as file:
                made["source"] = hashlib.sha256(file.read()).hexdigest()
        except (OSError, TypeError):
            pass
        return made
    try:
        import cloudpickle
    except ImportError:
        raise RigorError(f"the class {cls.__name__} is in no module that another process can import, and cloudpickle, which would send it, "
                         "is not installed; write the class to a file, as my_engine.py, or install cloudpickle") from None
    try:
        made["by_value"] = base64.b64encode(cloudpickle.dumps(cls)).decode()
    except Exception as error:
        raise InputError(f"the class {cls.__name__} cannot be sent to another process ({error}); write it to a file, as my_engine.py") from None
    return made


def _checked(cls: typing.Any) -> type[Engine]:
    if isinstance(cls, Engine):
        raise InputError(f"an engine is a class, and this is an object of it: give {type(cls).__name__}, and not {type(cls).__name__}()")
    if not (isinstance(cls, type) and issubclass(cls, Engine)):
        raise InputError(f"an engine is a run's name or a class of rigor.Engine, and not {cls!r}")
    if cls.load is Engine.load:
        raise InputError(f"{cls.__name__} has no method load(scene, settings)")
    return cls


_STARTER = """# Starts an engine of Python for Rigor. Made by the package rigor.
import sys
sys.path[0] = {package!r}  # and not this folder, whose files are called like engines
from rigor.serve import main
sys.exit(main([{specification!r}]))
"""


class Plugins:
    """The engines of a call: their --plugin words, and the files that other processes read.

    The files stay in the user's cache for a month: a report's commands can be pasted, and an interrupted run continued.
    """

    def __init__(self, plugins: typing.Any = (), in_process: bool | None = None):
        self._in_process = in_process
        self._words: list[str] = []
        self._names: dict[type[Engine], str] = {}
        if isinstance(plugins, (str, type)) or isinstance(plugins, Engine):
            plugins = [plugins]
        for plugin in plugins:
            if isinstance(plugin, (str, os.PathLike)):
                self._words += ["--plugin", os.fspath(plugin)]
            else:
                self.add(plugin)

    def words(self) -> list[str]:
        return self._words

    def name(self, engine: typing.Any) -> str:
        """A run's name; of a class the engine's, which is added if it is new."""
        return engine if isinstance(engine, str) else self.add(engine)

    def add(self, cls: typing.Any) -> str:
        cls = _checked(cls)
        if cls in self._names:
            return self._names[cls]
        name: str = described(cls.__new__(cls))["name"]
        text = json.dumps(specification(cls))
        folder = _kept_folder(hashlib.sha256(text.encode()).hexdigest()[:16])
        stem = os.path.join(folder, name)
        _write(f"{stem}.json", text.encode())
        in_process = cls.in_process if self._in_process is None else self._in_process
        if in_process:
            # A library is loaded once by its file, so each engine has a copy.
            _write(f"{stem}.so", _library().read_bytes())
            plugin = f"{stem}.so"
        else:
            _write(f"{stem}.py", _STARTER.format(package=str(_HERE.parent), specification=f"{stem}.json").encode())
            plugin = shlex.join([sys.executable, f"{stem}.py"])
        self._words += ["--plugin", plugin]
        self._names[cls] = name
        return name


def _library() -> pathlib.Path:
    path = _HERE / "engine_host.so"
    if not path.is_file():
        raise RigorError(f"in_process needs {path}, which this installation lacks; leave in_process out")
    return path


def _kept_folder(key: str) -> str:
    top = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "rigor" / "python"
    folder = top / key
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        for other in top.iterdir():
            if other != folder and time.time() - other.stat().st_mtime > _KEPT_FOR:
                shutil.rmtree(other, ignore_errors=True)
        os.utime(folder)
    except OSError:
        return tempfile.mkdtemp(prefix="rigor-engines-")
    return str(folder)


def _write(path: str, data: bytes) -> None:
    """Replaces a file at once, since a running cell may have loaded the old one."""
    try:
        with open(path, "rb") as file:
            if file.read() == data:
                return
    except FileNotFoundError:
        pass
    descriptor, name = tempfile.mkstemp(dir=os.path.dirname(path))
    with open(descriptor, "wb") as file:
        file.write(data)
    os.replace(name, path)
