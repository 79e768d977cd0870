"""Calls a user's engine and checks what comes back. Each fault becomes one sentence; none becomes a wrong state."""
from __future__ import annotations

import inspect
import json
import os
import threading
import traceback
import typing

import numpy as np

from .errors import DivergedError, UnsupportedError
from .scene import Scene

_EXIT_OF_FORK = 70


class Fault(Exception):
    """What an engine did against the interface, as a sentence."""


def _words(value: object, text_of: typing.Callable[[object], str] = str) -> str:
    try:
        return text_of(value)
    except BaseException:  # the user's own __str__ may do anything
        return "it has no text"


def failure(error: BaseException) -> tuple[str, str]:
    """The status of an answer, and its sentence."""
    if isinstance(error, UnsupportedError):
        return "unsupported", _words(error) or "the engine gives no reason"
    if isinstance(error, DivergedError):
        return "diverged", _words(error) or "the engine gives no reason"
    if isinstance(error, Fault):
        return "failed", str(error)
    if isinstance(error, SystemExit):
        return "failed", f"the engine called sys.exit({'' if error.code is None else _words(error.code, repr)})"
    frames = traceback.extract_tb(error.__traceback__)
    # The innermost frame that is the user's own.
    own = [frame for frame in frames if os.path.dirname(frame.filename) != os.path.dirname(__file__)] or list(frames)
    place = f" ({os.path.basename(own[-1].filename)}, line {own[-1].lineno}, in {own[-1].name})" if own else ""
    return "failed", f"{type(error).__name__}: {_words(error)}{place}"


def _kind(value: typing.Any) -> str:
    return "None" if value is None else f"a {type(value).__name__}"


def _refuse_call_of_step(who: str, step: typing.Callable[..., typing.Any], takes_wrenches: bool) -> None:
    """Names a step that cannot be called in each way, before a run has begun."""
    try:
        signature = inspect.signature(step)
    except (TypeError, ValueError):  # compiled functions may have none
        return
    try:
        signature.bind(0.0)
    except TypeError as error:
        raise Fault(f"{who}'s step() cannot be called as step(dt): {error}; write step(self, dt, wrenches=None), for a scene without forces has none") from None
    try:
        signature.bind(0.0, *([None] if takes_wrenches else []))
    except TypeError as error:
        raise Fault(f"{who}'s step() cannot be called as step(dt, wrenches): {error}; an engine with the feature 'wrench' gets them") from None


class GuardedWorld:
    """A world of a user's engine. `step` and `read` are bound to what the user wrote; others check."""

    def __init__(self, who: str, world: typing.Any, scene: Scene, settings: typing.Mapping[str, typing.Any], reports_contacts: bool,
                 takes_wrenches: bool = False):
        self.who, self.world, self.scene, self.bodies = who, world, scene, len(scene)
        for call in ("step", "read", *(["contacts"] if reports_contacts else [])):
            if not callable(getattr(world, call, None)):
                raise Fault(f"{who}.load() returned {_kind(world)} without a method {call}(); it returns a world with step(dt) and read()")
        self.step: typing.Callable[..., typing.Any] = world.step
        self.read: typing.Callable[[], typing.Any] = world.read
        _refuse_call_of_step(who, world.step, takes_wrenches)
        told = getattr(world, "settings", None)
        told = told() if callable(told) else told
        if told is not None and not isinstance(told, dict):
            raise Fault(f"the settings of {who}'s world are {_kind(told)}; they are a dict of texts and numbers")
        in_force = told if told else {"method": settings.get("method", "")}
        self.settings: str = json.dumps({str(key): str(value) for key, value in in_force.items()})

    def refuse_answer_of_step(self, answer: typing.Any) -> typing.NoReturn:
        raise Fault(f"{self.who}'s step() returned {_kind(answer)}; it changes the world and returns None")

    def check_state(self, state: typing.Any) -> np.ndarray:
        """The state as (n, 13) float64. Any strides; Fault for all that is no state."""
        n, who = self.bodies, f"{self.who}'s read()"
        due = f"an array of shape ({n}, 13) is due"
        if state is None or isinstance(state, (str, bytes, dict)) or not hasattr(state, "__len__") and not hasattr(state, "__array__"):
            raise Fault(f"{who} returned {_kind(state)}; {due}")
        try:
            array = np.asarray(state)
        except Exception as error:
            raise Fault(f"{who} returned {_kind(state)} that is no array ({error}); {due}") from None
        if array.dtype.kind not in "fiu":
            raise Fault(f"{who} returned an array of dtype {array.dtype}; float64 is due")
        if isinstance(state, np.ma.MaskedArray) and np.ma.is_masked(state):
            raise Fault(f"{who} returned an array with masked numbers; each number of each body is due")
        if array.shape != (n, 13):
            raise Fault(f"{who} returned an array of shape {array.shape}; {due}, a row for each body")
        return np.asarray(array, dtype=np.float64)

    def lost(self, body: int) -> str:
        return f"a number of body '{self.scene.bodies[body].name}' is not finite"

    def contacts(self) -> list[tuple[typing.Any, ...]]:
        """Rows of (a, b, point, normal, gap, force), flat."""
        rows, who = self.world.contacts(), f"{self.who}'s contacts()"
        if not hasattr(rows, "__iter__"):
            raise Fault(f"{who} returned {_kind(rows)}; a list of rows (a, b, point, normal, gap, force) is due")
        flat: list[tuple[typing.Any, ...]] = []
        for row in rows:
            try:
                a, b, point, normal, gap, force = row
                numbers = [float(x) for x in (*point, *normal, gap, *force)]
                pair = (int(a), int(b))
            except (TypeError, ValueError):
                raise Fault(f"{who} returned a row that is not (a, b, point, normal, gap, force)") from None
            if len(numbers) != 10 or not all(np.isfinite(numbers)) or not all(0 <= k < self.bodies for k in pair):
                raise Fault(f"{who} returned a row with other than 10 finite numbers, or a body that is none of the {self.bodies}")
            flat.append((*pair, *numbers))
        return flat


class ServedWorld:
    """The same for a server: one call at a time, and the world's own time."""

    def __init__(self, guarded: GuardedWorld):
        self.guarded = guarded
        self._busy = threading.Lock()
        self._begin, self._dt, self._count = 0.0, 0.0, 0

    @property
    def time(self) -> float:
        return self._begin + self._count * self._dt

    def _alone(self) -> None:
        if not self._busy.acquire(blocking=False):
            raise Fault("two threads call one world at a time; a world belongs to one thread")

    def step(self, dt: float, wrenches: np.ndarray | None = None) -> None:
        self._alone()
        try:
            if dt != self._dt:
                self._begin, self._dt, self._count = self.time, dt, 0
            process = os.getpid()
            try:
                answer = self.guarded.step(dt) if wrenches is None else self.guarded.step(dt, wrenches)
            except UnsupportedError as error:
                if self.time == 0:
                    raise
                # It would hide a run that has begun.
                raise Fault(f"{self.guarded.who}'s step() raised UnsupportedError at t = {self.time:.6g} s: {_words(error)}; load() refuses a scene") from None
            finally:
                if os.getpid() != process:  # a copy that the engine forked, and let run on
                    os._exit(_EXIT_OF_FORK)
            if answer is not None:
                self.guarded.refuse_answer_of_step(answer)
            self._count += 1
        finally:
            self._busy.release()

    def read(self) -> np.ndarray:
        """(n, 13), a copy. DivergedError if a number is not finite."""
        self._alone()
        try:
            process = os.getpid()
            try:
                state = np.array(self.guarded.check_state(self.guarded.read()))
            finally:
                if os.getpid() != process:
                    os._exit(_EXIT_OF_FORK)
        finally:
            self._busy.release()
        lost = ~np.isfinite(state).all(axis=1)
        if lost.any():
            error = DivergedError(self.guarded.lost(int(np.argmax(lost))))
            error.body = int(np.argmax(lost))  # type: ignore[attr-defined]
            raise error
        return state
