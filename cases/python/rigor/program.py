"""Finds and starts the program ``rigor``. The package leaves all work to it, in child processes."""
from __future__ import annotations

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import typing

from .errors import EngineError, InputError, Interrupted, RigorError, UnsupportedError

HERE = pathlib.Path(__file__).resolve().parent
_ENDS_WITHIN = 10.0  # s that an interrupted program may take to stop its cells
_PROGRESS = re.compile(r"rigor: (\d+) (?:of (\d+) )?\S+(?: of \S+)? after ")  # "12 cells", "12 of 30 cells", "12 values of core:rk4"
_NOTE = re.compile(r"^rigor: ", re.MULTILINE)


class Completed(typing.NamedTuple):
    code: int
    out: bytes
    err: str  # without lines of progress

    @property
    def notes(self) -> list[str]:
        """The sentences on stderr."""
        return [note.strip() for note in _NOTE.split(self.err) if note.strip()]


def program() -> str:
    """The path of the program ``rigor``: RIGOR_PROGRAM, else the one built or packed with this package, else of PATH."""
    asked = os.environ.get("RIGOR_PROGRAM")
    if asked:
        if not os.access(asked, os.X_OK):
            raise RigorError(f"RIGOR_PROGRAM is '{asked}', which is no program that can be started")
        return asked
    for beside in (HERE / "bin" / "rigor", HERE.parent.parent / "rigor"):  # of a wheel; of build/release/python/rigor
        if beside.is_file() and os.access(beside, os.X_OK):
            return str(beside)
    found = shutil.which("rigor")
    if found:
        return found
    raise RigorError("the program rigor is not found; install the package rigor, or set RIGOR_PROGRAM to its path")


class _Lines:
    """Stderr as it comes: lines of progress go to `on_progress`, the others are kept."""

    def __init__(self, on_progress: typing.Callable[[int, int], object] | None):
        self.kept: list[str] = []
        self.on_progress = on_progress
        self._rest = b""

    def feed(self, data: bytes, at_end: bool = False) -> None:
        *lines, self._rest = (self._rest + data).split(b"\n")
        if at_end and self._rest:
            lines.append(self._rest)
        for line in lines:
            text = line.decode("utf-8", "replace")
            match = _PROGRESS.match(text)
            if match is None:
                self.kept.append(text)
            elif self.on_progress is not None:
                self.on_progress(int(match[1]), int(match[2] or 0))


def _stop(process: subprocess.Popen[bytes]) -> None:
    process.send_signal(signal.SIGINT)
    try:
        process.wait(_ENDS_WITHIN)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def call(words: typing.Sequence[str], *, stdout: typing.Any = None, names: typing.Mapping[str, str] | None = None, out: str | None = None,
         on_progress: typing.Callable[[int, int], object] | None = None) -> Completed:
    """Runs ``rigor WORDS``. Ctrl-C stops it and raises Interrupted; finished cells stay in `out`.

    `names`: the names of cases by the files that they were written to, which messages would show.
    """
    if os.environ.get("RIGOR_IN_ENGINE"):
        raise RigorError("this call would run in each process of an engine, because the engine's module makes it when it is imported; "
                         "put it below `if __name__ == \"__main__\":`")
    environment = dict(os.environ, NO_COLOR="1", COLUMNS="100")
    if on_progress is not None:
        environment["RIGOR_PROGRESS_SECONDS"] = "0.2"
    with tempfile.TemporaryFile() as kept:
        target = kept if stdout is None else stdout
        process = subprocess.Popen([program(), *words], stdin=subprocess.DEVNULL, stdout=target, stderr=subprocess.PIPE, env=environment)
        lines = _Lines(on_progress)
        assert process.stderr is not None
        descriptor = process.stderr.fileno()
        try:
            while data := os.read(descriptor, 1 << 16):
                lines.feed(data)
            process.wait()
        except BaseException as error:
            _stop(process)
            if isinstance(error, KeyboardInterrupt):
                again = "; the same call with resume=True continues" if out else ""
                raise Interrupted(f"interrupted; finished cells are in '{out}'{again}" if out else "interrupted", out) from None
            raise
        finally:
            process.stderr.close()
        lines.feed(b"", at_end=True)
        data = b""
        if stdout is None:
            kept.seek(0)
            data = kept.read()
    told = "\n".join(lines.kept)
    for path, name in (names or {}).items():
        told = told.replace(path, name)
    return Completed(process.returncode, data, told)


def error_of(done: Completed) -> RigorError:
    """The exception that tells what the program told last."""
    text = done.notes[-1] if done.notes else f"rigor ended with the code {done.code} and without a word"
    if done.code < 0:
        return EngineError(f"rigor was killed by {signal.Signals(-done.code).name}: {text}")
    if ": unsupported: " in text:
        return UnsupportedError(text)
    if done.code == 2:
        place = re.match(r"([^\s:]+:\d+:\d+): ", text)
        return InputError(text, place[1] if place else None)
    return EngineError(text)


def checked(done: Completed, good: typing.Container[int] = (0,)) -> Completed:
    if done.code not in good:
        raise error_of(done)
    return done


class Bar:
    """A bar of progress on a terminal, or in the output of a notebook's cell."""

    def __init__(self) -> None:
        self._start = time.monotonic()
        self._shown = False

    def __call__(self, done: int, all_: int) -> None:
        filled = 40 * done // all_ if all_ else 0
        seconds = time.monotonic() - self._start
        sys.stderr.write(f"\r[{'#' * filled}{'.' * (40 - filled)}] {done}/{all_ or '?'} after {seconds:.0f} s")
        sys.stderr.flush()
        self._shown = True

    def close(self) -> None:
        if self._shown:
            sys.stderr.write("\r" + " " * 78 + "\r")
            sys.stderr.flush()


def is_watched() -> bool:
    """Whether somebody sees a bar: a terminal, or a notebook."""
    if sys.stderr is not None and sys.stderr.isatty():
        return True
    shell = sys.modules.get("IPython")
    instance = shell.get_ipython() if shell is not None else None
    return instance is not None and type(instance).__name__ == "ZMQInteractiveShell"
