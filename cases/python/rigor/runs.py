"""Commands that simulate: run, gate, sweep, tune and the others. Each starts the program, whose cells are child processes."""
from __future__ import annotations

import json
import os
import re
import tempfile
import typing

from . import program
from .answers import Conformance, Diagnosis, Divergence, Printed, Repeats, Tuned
from .case import CaseWord, WrittenCases
from .engines import Plugins
from .errors import InputError
from .fitted import Fitted
from .results import Results

Cases = typing.Union[CaseWord, typing.Iterable[CaseWord], None]
Progress = typing.Union[bool, typing.Callable[[int, int], object], None]


def _listed(values: typing.Any) -> list[typing.Any]:
    if values is None:
        return []
    return [values] if isinstance(values, (str, bytes, type, int, float)) or not hasattr(values, "__iter__") else list(values)


class _Call:
    """The words of one call of the program, and what stands behind them."""

    def __init__(self, command: str, cases: Cases, engines: typing.Any, plugins: typing.Any, in_process: bool | None, options: dict[str, typing.Any]):
        from .motion import step_text
        self.written = WrittenCases()
        made = Plugins(plugins, in_process)
        self.words = [command]
        try:
            self.words += self.written.words(cases)
            for engine in _listed(engines):
                self.words += ["--engine", made.name(engine)]
            for name, value in options.items():
                if value is None or value is False:
                    continue
                word = f"--{name.replace('_', '-')}"
                if value is True:
                    self.words.append(word)
                else:
                    is_time = name in ("dt", "duration", "timeout")
                    for one in _listed(value):
                        self.words += [word, step_text(one) if is_time else str(one)]
        except BaseException:
            self.written.__exit__()
            raise
        self.words += made.words()

    def run(self, progress: Progress, out: str | None = None) -> program.Completed:
        if progress is not None and not isinstance(progress, bool) and not callable(progress):
            raise InputError("progress is True, False or a function of (done, all)")
        bar = program.Bar() if progress is True or progress is None and program.is_watched() else None
        on_progress = bar if bar is not None else progress if callable(progress) else None
        with self.written:
            try:
                return program.call(self.words, on_progress=on_progress, out=out, names=self.written.names)
            finally:
                if bar is not None:
                    bar.close()

    def printed(self, progress: Progress) -> program.Completed:
        """The same, with the names of cases in what it prints."""
        done = self.run(progress)
        out = done.out
        for path, name in self.written.names.items():
            out = out.replace(path.encode(), name.encode())
        return done._replace(out=out)


class _Folder:
    """The folder of the reports: the caller's, or a temporary one that goes with the last object that needs it."""

    def __init__(self, out: typing.Any):
        self.keep = None if out is not None else tempfile.TemporaryDirectory(prefix="rigor-out-")
        self.path = os.fspath(out) if out is not None else os.path.join(typing.cast(typing.Any, self.keep).name, "out")
        self._before = self._mark("results.json")

    def _mark(self, file: str) -> tuple[int, int] | None:
        try:
            status = os.stat(os.path.join(self.path, file))
            return status.st_ino, status.st_mtime_ns
        except OSError:
            return None

    def has_new_results(self) -> bool:
        now = self._mark("results.json")
        return now is not None and now != self._before


def _grid(command: str, cases: Cases, engines: typing.Any, plugins: typing.Any, in_process: bool | None, out: typing.Any, progress: Progress,
          options: dict[str, typing.Any]) -> Results:
    folder = _Folder(out)
    call = _Call(command, cases, engines, plugins, in_process, {**options, "out": folder.path})
    try:
        done = call.run(progress, folder.path)
    except KeyboardInterrupt:
        if folder.keep is not None:
            folder.keep._finalizer.detach()  # type: ignore[attr-defined]  # finished cells stay for resume=True
        raise
    # A grid in which a cell broke has results too; only a call that was refused has none.
    if done.code not in (0, 1, 2, 3) or not folder.has_new_results():
        raise program.error_of(done)
    names = {path: name for path, name in call.written.names.items()}
    return Results(folder.path, folder.keep, names, done.code, done.notes, done.out.decode("utf-8", "replace"))


def run(cases: Cases = None, *, engines: typing.Any = None, dt: typing.Any = None, duration: typing.Any = None, plugins: typing.Any = (),
        in_process: bool | None = None, jobs: int | None = None, timeout: typing.Any = None, out: typing.Any = None, resume: bool = False,
        series: bool = True, progress: Progress = None, **options: typing.Any) -> Results:
    """Simulates cases × engines × steps and judges them, each cell in a process of its own.

    `cases`: ids, families, files or ``rigor.Case`` objects; None is the whole suite. `engines`: run names (``"ode"``,
    ``"core:rk4"``) or classes of ``rigor.Engine``; None is every engine. `dt`, `duration`, `timeout` in s, numbers or
    fractions in a text. `out`: the folder of the reports; without it they are temporary. `progress`: None shows a bar on a
    terminal and in a notebook; a function gets (done, all) cells. Other options are those of ``rigor run``: ``suite="…"``,
    ``lossy=True``.

    A cell that crashed, hung or diverged is in the results with its status. Ctrl-C raises ``rigor.Interrupted``.
    """
    return _grid("run", cases, engines, plugins, in_process, out, progress,
                 {"dt": dt, "duration": duration, "jobs": jobs, "timeout": timeout, "resume": resume, "series": series, **options})


def gate(cases: Cases = None, *, engines: typing.Any = None, dt: typing.Any = None, duration: typing.Any = None, plugins: typing.Any = (),
         in_process: bool | None = None, jobs: int | None = None, timeout: typing.Any = None, out: typing.Any = None, resume: bool = False,
         series: bool = True, progress: Progress = None, **options: typing.Any) -> Results:
    """``run``, of the cells that a gate judges. ``passed`` and ``failures()`` of the results say what held."""
    return _grid("gate", cases, engines, plugins, in_process, out, progress,
                 {"dt": dt, "duration": duration, "jobs": jobs, "timeout": timeout, "resume": resume, "series": series, **options})


class Sweep:
    """The rows of a sweep, one a cell."""

    def __init__(self, folder: str, keep: object, text: str):
        self.folder: str = folder
        """Of ``sweep.csv`` and ``sweep.jsonl``. A folder without a name of yours goes with this object."""
        self.text: str = text
        """What the command line prints."""
        self._keep = keep
        with open(os.path.join(folder, "sweep.jsonl"), encoding="utf-8") as file:
            self.rows: list[dict[str, typing.Any]] = [json.loads(line) for line in file]
            """A dict for each cell, with the keys of sweep.jsonl in SI units."""

    def __repr__(self) -> str:
        return f"<rigor.Sweep of {len(self.rows)} cells in {self.folder!r}>"

    def to_dataframe(self) -> typing.Any:
        """A pandas DataFrame with the columns of sweep.csv: a row a cell. ``attrs["units"]`` has the units."""
        import pandas
        frame = pandas.read_csv(os.path.join(self.folder, "sweep.csv"), float_precision="round_trip")
        parts = {column: re.fullmatch(r"(.*) \[([^\[\]]*)\]", column) for column in frame.columns}
        frame = frame.rename(columns={column: match[1] for column, match in parts.items() if match})
        frame.attrs["units"] = {match[1]: match[2] for match in parts.values() if match}
        return frame


def sweep(cases: Cases, *, vary: typing.Mapping[str, typing.Any], engines: typing.Any = None, plugins: typing.Any = (),
          in_process: bool | None = None, out: typing.Any = None, progress: Progress = None, **options: typing.Any) -> Sweep:
    """Every combination of values: ``vary={"dt": "1/1000..1/10:log:20", "scene.spring[0].stiffness": [1e2, 1e3]}``."""
    if not isinstance(vary, dict) or not vary:
        raise InputError("vary is a dict from a key to its values, as {\"dt\": [\"1/30\", \"1/240\"]}")
    folder = _Folder(out)
    words = [f"{key}={values if isinstance(values, str) else ','.join(v if isinstance(v, str) else repr(float(v)) for v in _listed(values))}"
             for key, values in vary.items()]
    call = _Call("sweep", cases, engines, plugins, in_process, {"vary": words, "out": folder.path, **options})
    done = program.checked(call.run(progress, folder.path), (0, 3))
    if not os.path.isfile(os.path.join(folder.path, "sweep.jsonl")):
        raise program.error_of(done)
    return Sweep(folder.path, folder.keep, done.out.decode("utf-8", "replace"))


def tune(cases: Cases, *, engine: typing.Any, within: typing.Any, plugins: typing.Any = (), in_process: bool | None = None, progress: Progress = None,
         **options: typing.Any) -> Tuned:
    """The cheapest step and options of `engine` within bounds: ``within="1mm"`` or ``["1mm", "2% energy"]``."""
    call = _Call("tune", cases, engine, plugins, in_process, {"within": within, **options})
    return Tuned(program.checked(call.printed(progress), (0, 1)))


def command(name: str, cases: Cases = None, *, engines: typing.Any = None, plugins: typing.Any = (), in_process: bool | None = None,
            progress: Progress = None, **options: typing.Any) -> Printed:
    """Any command of the program: ``rigor.command("settle", "my-case.toml")``. Options are keywords; a list repeats one.

    ``json`` of the answer is set if the command has the option --json.
    """
    has_json = "--json" in program.checked(program.call(["help", name])).out.decode("utf-8", "replace")
    call = _Call(name, cases, engines, plugins, in_process, {**options, "json": has_json})
    return Printed(program.checked(call.printed(progress), (0, 1)), has_json)


def _range(key: str, values: typing.Any) -> str:
    if isinstance(values, str):
        return f"{key}={values}"
    ends = _listed(values)
    if len(ends) != 2 or not all(isinstance(end, str) or hasattr(end, "__float__") and not isinstance(end, bool) for end in ends):
        raise InputError(f"vary: {key!r} has the range {values!r}; allowed: two numbers, as (0.1, 0.9), or a text, as \"0.1..0.9\" or \"0.01..1:log\"")
    return f"{key}={'..'.join(end if isinstance(end, str) else repr(float(end)) for end in ends)}"


def fit(cases: Cases, *, engine: typing.Any, vary: typing.Mapping[str, typing.Any], dt: typing.Any = None, duration: typing.Any = None,
        hold_out: float | None = None, seed: int | None = None, plugins: typing.Any = (), in_process: bool | None = None, jobs: int | None = None,
        timeout: typing.Any = None, out: typing.Any = None, progress: Progress = None, **options: typing.Any) -> Fitted:
    """The values with which `engine` follows a recording or another truth best: ``vary={"scene.contact_default.friction": (0.05, 0.9)}``.

    `vary`: a range for each key, ``(low, high)`` or ``"0.01..1:log"``, in the unit of the case file. A key is ``dt``, an
    option of the method, or a path below ``scene``. Several are fitted together. `cases` may be several; `dt` [s] is one step, by
    default the coarsest of the case. `hold_out`: the share of the trials, from 0 to 1, that takes no part and is predicted.
    `seed` draws the start and the held-out trials; the same seed gives the same values. `out`: a file for the case with the
    fitted values. `progress` gets (values tried, 0), because their number is not known before.
    """
    if not isinstance(vary, dict) or not vary:
        raise InputError("vary is a dict from a key to its range, as {\"scene.contact_default.friction\": (0.05, 0.9)}")
    if len(_listed(engine)) != 1:
        raise InputError(f"fit: takes one engine, and there are {len(_listed(engine))} of them")
    call = _Call("fit", cases, engine, plugins, in_process,
                 {"vary": [_range(key, values) for key, values in vary.items()], "dt": dt, "duration": duration, "hold_out": hold_out, "seed": seed,
                  "jobs": jobs, "timeout": timeout, "out": None if out is None else os.fspath(out), **options, "json": True})
    return Fitted(program.checked(call.printed(progress)))


def diverge(case: Cases, *, engines: typing.Any = None, dt: typing.Any = None, duration: typing.Any = None, plugins: typing.Any = (),
            in_process: bool | None = None, progress: Progress = None, **options: typing.Any) -> Divergence:
    """When, where and why two runs part: two engines or settings with one `dt` [s], or one engine with two.

    Other options are those of ``rigor diverge``: ``within="1mm"`` says what counts as parted.
    """
    call = _Call("diverge", case, engines, plugins, in_process, {"dt": dt, "duration": duration, **options, "json": True})
    return Divergence(program.checked(call.printed(progress)))


def repeat(cases: Cases, *, engine: typing.Any, dt: typing.Any = None, duration: typing.Any = None, plugins: typing.Any = (),
           in_process: bool | None = None, jobs: int | None = None, timeout: typing.Any = None, record: typing.Any = None, against: typing.Any = None,
           progress: Progress = None, **options: typing.Any) -> Repeats:
    """Whether a run gives the same bits under each change that should not matter: ``assert rigor.repeat("springs", engine=MyEngine)``.

    `dt` [s] is one step, by default the first of the case. `record`: a file for the hashes of each step. `against`: such a file,
    perhaps of another machine, that the run is compared with. Both make no table of changes.
    """
    files = {name: os.fspath(file) for name, file in (("record", record), ("against", against)) if file is not None}
    call = _Call("repeat", cases, engine, plugins, in_process,
                 {"dt": dt, "duration": duration, "jobs": jobs, "timeout": timeout, **options, **files, "json": not files})
    return Repeats(program.checked(call.printed(progress), (0, 1)), not files)


def conform(engine: typing.Any, *, plugins: typing.Any = (), in_process: bool | None = None, progress: Progress = None,
            **options: typing.Any) -> Conformance:
    """Checks an engine against the interface: ``assert rigor.conform(MyEngine)``. The answer's text names each broken check."""
    call = _Call("conform", None, engine, plugins, in_process, {"json": True, **options})
    return Conformance(program.checked(call.printed(progress), (0, 1)))


def diagnose(cases: Cases = None, *, engine: typing.Any, plugins: typing.Any = (), in_process: bool | None = None, progress: Progress = None,
             **options: typing.Any) -> Diagnosis:
    """Names the known mistake that explains the error of `engine`. Without cases those that tell mistakes apart.

    ``rigor.diagnose("ballistic/free-fall", engine=MyEngine).mistakes`` is ``("gravity off by 5 %",)``, say. One case takes
    seconds, all of them minutes.
    """
    call = _Call("diagnose", cases, engine, plugins, in_process, {"json": True, **options})
    return Diagnosis(program.checked(call.printed(progress)))
