"""Motions as structured arrays of numpy: a run of an engine, and the truth."""
from __future__ import annotations

import io
import mmap
import os
import re
import typing
import warnings

import numpy as np

from . import _native, program
from .case import CaseWord, WrittenCases
from .engines import Plugins
from .errors import InputError, RigorWarning

STATE = ("px", "py", "pz", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz")
_UNITS = {"time": "s", **dict.fromkeys(STATE[:3], "m"), **dict.fromkeys(STATE[3:7], "1"), **dict.fromkeys(STATE[7:10], "m/s"),
          **dict.fromkeys(STATE[10:], "rad/s"), "error": "m and rad"}
_LONGEST_TIMES = 100_000  # bytes of one --times; Linux takes 128 KiB in one word


class Trajectory(np.ndarray):
    """Rows of ``time, body, px … wz``, all bodies of an instant one after another; of a truth also ``error``.

    A structured array: ``traj["px"]``, ``traj[traj["body"] == "cube"]``. SI units; quaternions w, x, y, z from body to world.
    """

    notes: tuple[str, ...] = ()
    """What the program said about the run, as the time at which it blew up."""

    def __array_finalize__(self, other: typing.Any) -> None:
        self.notes = getattr(other, "notes", ())

    @property
    def times(self) -> np.ndarray:
        """(t,), s: the instants, each once."""
        return np.asarray(self["time"])[::self._bodies]

    @property
    def names(self) -> list[str]:
        """The bodies in the scene's order."""
        return [str(name) for name in self["body"][:self._bodies]]

    @property
    def _bodies(self) -> int:
        time = np.asarray(self["time"])
        count = int(np.argmax(time != time[0])) if len(time) and (time != time[0]).any() else len(time)
        is_whole = count > 0 and len(time) % count == 0 and len(set(self["body"][:count].tolist())) == count
        if is_whole:  # a part of the rows may begin in the middle of an instant
            instants = time.reshape(-1, count)
            is_whole = bool((instants == instants[:, :1]).all() and (instants[1:, 0] != instants[:-1, 0]).all())
        if not is_whole:
            raise InputError("these rows are no whole trajectory: each instant needs one row of each body")
        return count

    def body(self, name: str) -> Trajectory:
        """The rows of one body, without a copy."""
        names = self.names
        if name not in names:
            raise InputError(f"no body is called {name!r}; there is: {', '.join(names)}")
        return self[names.index(name)::len(names)]

    def state(self) -> np.ndarray:
        """(t, n, 13): px … wz of each instant and body. A view where the rows allow it."""
        n = self._bodies
        plain = np.asarray(self)
        if not plain.flags.c_contiguous:
            plain = np.ascontiguousarray(plain)
        names = plain.dtype.names
        assert names is not None and plain.dtype.fields is not None
        offset = plain.dtype.fields["px"][1]
        columns = np.ndarray((len(plain) // n, n, 13), np.float64, plain, offset, (n * plain.itemsize, plain.itemsize, 8))
        return columns

    @property
    def position(self) -> np.ndarray:
        """(t, n, 3), m."""
        return self.state()[:, :, :3]

    @property
    def orientation(self) -> np.ndarray:
        """(t, n, 4): w, x, y, z."""
        return self.state()[:, :, 3:7]

    @property
    def velocity(self) -> np.ndarray:
        """(t, n, 3), m/s."""
        return self.state()[:, :, 7:10]

    @property
    def angular_velocity(self) -> np.ndarray:
        """(t, n, 3), rad/s."""
        return self.state()[:, :, 10:13]

    @property
    def error(self) -> np.ndarray:
        """Of a truth: how far it may be off, a row each, in m and rad."""
        if "error" not in (self.dtype.names or ()):
            raise AttributeError("only a truth has an error of its own")
        return np.asarray(self["error"])

    def to_dataframe(self) -> typing.Any:
        """A pandas DataFrame with the same columns; ``attrs["units"]`` has their units."""
        import pandas
        plain = np.asarray(self)
        frame = pandas.DataFrame({name: plain[name] for name in self.dtype.names or ()})
        frame.attrs["units"] = {name: _UNITS[name] for name in frame.columns if name in _UNITS}
        return frame


def _noted(rows: np.ndarray, notes: typing.Sequence[str]) -> Trajectory:
    trajectory = rows.view(Trajectory)
    trajectory.notes = tuple(notes)
    return trajectory


def step_text(step: typing.Any) -> str:
    """A step or an instant as the command line takes it: ``"1/30"`` as it is, a number with all of its digits."""
    if isinstance(step, str):
        return step
    if isinstance(step, bool) or not hasattr(step, "__float__"):
        raise InputError(f"a time in s is a number or a fraction in a text, as \"1/30\", and not a {type(step).__name__}")
    if hasattr(step, "numerator") and not isinstance(step, (int, float, np.number)):
        return f"{step.numerator}/{step.denominator}"  # fractions.Fraction
    return repr(float(step))


def _steps(steps: typing.Any) -> list[str]:
    if isinstance(steps, str) or not hasattr(steps, "__iter__"):
        steps = [steps]
    return [step_text(step) for step in steps]


def trace(case: CaseWord, *, engine: typing.Any, dt: typing.Any, duration: typing.Any = None, every: int = 1,
          plugins: typing.Sequence[typing.Any] = (), in_process: bool | None = None, timeout: float | None = None) -> Trajectory:
    """One run as a structured array, without a copy of its rows.

    `engine` is a run's name (``"ode"``, ``"core:rk4"``) or a class of ``rigor.Engine``. `dt` and `duration` are in s.
    A run that blows up ends at its last finite state; that is a ``RigorWarning``, and in ``notes``.
    """
    engines = Plugins(plugins, in_process)
    with WrittenCases() as written:
        words = ["trace", written.word(case), "--engine", engines.name(engine), "--format", "npy", "--every", str(every)]
        for step in _steps(dt):
            words += ["--dt", step]
        if duration is not None:
            words += ["--duration", step_text(duration)]
        if timeout is not None:
            words += ["--timeout", step_text(timeout)]
        with open(os.memfd_create("rigor-trace", os.MFD_CLOEXEC), "w+b") as file:
            done = program.checked(program.call([*words, *engines.words()], stdout=file, names=written.names))
            rows = _mapped(file)
    for note in done.notes:
        warnings.warn(note, RigorWarning, stacklevel=2)
    return _noted(rows, done.notes)


def _mapped(file: typing.BinaryIO) -> np.ndarray:
    size = os.fstat(file.fileno()).st_size
    # Copy on write: rows can be changed, and no page is copied until then.
    memory = mmap.mmap(file.fileno(), size, access=mmap.ACCESS_COPY)
    head = io.BytesIO(memory[:1 << 16])
    np.lib.format.read_magic(head)
    shape, _, dtype = np.lib.format.read_array_header_1_0(head)
    return np.frombuffer(memory, dtype, shape[0], head.tell())


def truth(case: CaseWord, *, times: typing.Any = None, duration: typing.Any = None, timeout: float | None = None) -> Trajectory:
    """The true motion at `times` [s], with its own ``error`` [m and rad].

    `times` is a sequence of instants, or a trajectory whose instants are taken; without it each coarsest step of the case.
    """
    if times is not None:
        if isinstance(times, np.ma.MaskedArray) and np.ma.is_masked(times):
            raise InputError("truth: some of `times` are masked; take times.compressed()")
        instants = times.times if isinstance(times, Trajectory) else np.ravel(np.asarray(times, dtype=object))
        texts = ["0" if step == 0 else step_text(step) for step in instants]
        if not texts:
            raise InputError("truth: `times` is empty; without it the truth is given at each coarsest step of the case")
        parts = _parts(texts)
    with WrittenCases() as written:
        words = ["truth", written.word(case)]
        if duration is not None:
            words += ["--duration", step_text(duration)]
        if timeout is not None:
            words += ["--timeout", step_text(timeout)]
        asked = [words] if times is None else [[*words, "--times", ",".join(part)] for part in parts]
        done = [program.checked(program.call(one, names=written.names)) for one in asked]
    tables = [_native.read_states(one.out) for one in done]
    notes = list(dict.fromkeys(note for one in done for note in one.notes))
    return _noted(tables[0] if len(tables) == 1 else np.concatenate(tables), notes)


def _parts(texts: list[str]) -> list[list[str]]:
    parts: list[list[str]] = [[]]
    size = 0
    for text in texts:
        size += len(text) + 1
        if size > _LONGEST_TIMES:
            parts.append([])
            size = len(text) + 1
        parts[-1].append(text)
    return parts


class Closeness:
    """The answer of ``close``: true or false, with the worst instant as its text."""

    def __init__(self, holds: bool, text: str, distance: float, time: float, body: str):
        self.holds: bool = holds
        """Whether the motions agree within the bound."""
        self.text: str = text
        """The answer as a sentence, with the worst instant."""
        self.distance: float = distance
        """The distance at the worst instant, in m, or in rad for a bound on angles; nan if it is no finite number."""
        self.time: float = time
        """s: the worst instant."""
        self.body: str = body
        """The body that is farthest off then."""

    def __bool__(self) -> bool:
        return self.holds

    def __repr__(self) -> str:
        return self.text


_SIZES = {"m": (1.0, "m"), "cm": (1e-2, "m"), "mm": (1e-3, "m"), "um": (1e-6, "m"), "nm": (1e-9, "m"),
          "rad": (1.0, "rad"), "mrad": (1e-3, "rad"), "deg": (np.pi / 180, "rad")}


def _bound(text: str) -> tuple[float, str]:
    match = re.fullmatch(r"\s*([0-9.]+(?:[eE][+-]?\d+)?)\s*([a-z]+)\s*", text) if isinstance(text, str) else None
    if match is None or match[2] not in _SIZES:
        raise InputError(f"within: {text!r} is no distance; allowed: a number with one of {', '.join(_SIZES)}, as \"1mm\"")
    size, unit = _SIZES[match[2]]
    value = float(match[1]) * size
    if not value > 0:
        raise InputError(f"within: {text!r} is not above zero")
    return value, unit


def close(motion: np.ndarray, truth: np.ndarray, within: str = "1mm") -> Closeness:
    """Whether two motions agree within ``"1mm"`` or ``"1mrad"`` at each common row: ``assert rigor.close(traj, truth, within="1mm")``.

    Rows must agree in time and body. The error of a truth counts against the claim: what the truth cannot vouch for is
    not close. The answer's text names the worst instant.
    """
    allowed, unit = _bound(within)
    for name, rows in (("motion", motion), ("truth", truth)):
        missing = [column for column in ("time", "body", *STATE) if column not in (getattr(rows, "dtype", np.dtype("f8")).names or ())]
        if missing:
            raise InputError(f"close: the {name} has no column {missing[0]!r}; it takes what trace() and truth() return")
        if len(rows) == 0:
            raise InputError(f"close: the {name} has no rows")
    one, other = np.asarray(motion), np.asarray(truth)
    if len(one) != len(other) or (one["body"] != other["body"]).any() or \
            not np.allclose(one["time"], other["time"], rtol=1e-9, atol=1e-12):  # rounding of n dt
        raise InputError("close: the rows are of other instants or bodies; take truth(case, times=motion)")
    if unit == "m":
        distance = np.sqrt(sum((one[c] - other[c]) ** 2 for c in STATE[:3]))
    else:
        p, q = (np.stack([rows[c] for c in STATE[3:7]], axis=1) for rows in (one, other))
        # |p - q| keeps its digits at small angles, where the dot product does not.
        chord = np.minimum(np.linalg.norm(p - q, axis=1), np.linalg.norm(p + q, axis=1))
        distance = 4 * np.arcsin(np.minimum(chord / 2, 1))
    error = sum(np.asarray(rows["error"]) for rows in (one, other) if "error" in rows.dtype.names)
    total = distance + error
    if not np.isfinite(total).all():
        at = int(np.argmin(np.isfinite(total)))
        text = f"not close: at t = {one['time'][at]:.6g} s the distance of body '{one['body'][at]}' is no finite number"
        return Closeness(False, text, float("nan"), float(one["time"][at]), str(one["body"][at]))
    at = int(np.argmax(total))
    time, body, found = float(one["time"][at]), str(one["body"][at]), float(distance[at])
    holds = bool(total[at] <= allowed)
    sure = np.broadcast_to(error, total.shape)[at]
    text = f"{'close' if holds else 'not close'}: at most {found:.3g} {unit} at t = {time:.6g} s, body '{body}'; allowed: {allowed:.3g} {unit}"
    if not holds and found <= allowed:
        text = f"not close: at t = {time:.6g} s the truth itself may be off by {sure:.3g} {unit}; allowed: {allowed:.3g} {unit}, body '{body}'"
    elif sure > 0:
        text += f"; the truth may be off by {sure:.3g} {unit} then"
    return Closeness(holds, text, found, time, body)
