"""The results of a run or a gate: cells, metrics, series and trajectories."""
from __future__ import annotations

import json
import os
import pathlib
import shutil
import typing

from .errors import InputError, RigorError

if typing.TYPE_CHECKING:
    import numpy as np

    from .motion import Trajectory

_WORDS = {"inf": float("inf"), "-inf": float("-inf"), "nan": float("nan")}
_FAILURES = ("fail", "unexpected-pass", "diverged", "crashed", "timed-out", "invalid")


def _read(path: str) -> dict[str, typing.Any]:
    try:
        with open(path, encoding="utf-8") as file:
            found: typing.Any = json.load(file)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise InputError(f"{path}: is no JSON: {error}") from None
    schema = found.get("schema") if isinstance(found, dict) else None
    if schema != _SCHEMA:
        raise InputError(f"{path}: its 'schema' is {schema}; this version of rigor reads {_SCHEMA}")
    return found


def number(value: typing.Any) -> float:
    """A number of results.json; nan for none."""
    return _WORDS[value] if isinstance(value, str) else float("nan") if value is None else float(value)


class Metric(float):
    """A metric's value, with what belongs to it. It is a float; nan if there is no value, and then ``why`` says so."""

    unit: str
    """The unit of the value, as ``"m"``; ``"1"`` for a number without one."""
    why: str
    """Why there is no value; empty if there is one."""
    worst_time: float
    """s: the instant of the value; nan if it has none."""
    worst_body: str
    """The body that the value belongs to; empty if it belongs to none."""
    first_second: float
    """The largest up to t = 1 s, in `unit`; nan if the metric has none."""
    compared_until: float
    """s: the end of the comparison with the truth; nan if there is none."""
    held_to_itself: bool
    """The run's own code made the truth: the value shows convergence, not correctness."""

    @classmethod
    def of(cls, row: typing.Any, unit: str) -> Metric:
        """A metric from its row of results.json. `unit` counts where the row has none."""
        row = row if isinstance(row, dict) else {"value": row}
        metric = cls(number(row.get("value")))
        worst = row.get("worst") or {}
        metric.unit = row.get("unit", unit)
        metric.why = row.get("not_applicable", "")
        metric.worst_time, metric.worst_body = number(worst.get("time")), worst.get("body", "")
        metric.first_second, metric.compared_until = number(row.get("first_second")), number(row.get("compared_until"))
        metric.held_to_itself = bool(row.get("held_to_itself", False))
        return metric


class Cell:
    """One run: a case, an engine and a step."""

    def __init__(self, row: dict[str, typing.Any], name: str, units: dict[str, str], folder: str, keep: object):
        self.row: dict[str, typing.Any] = row
        """The cell of results.json."""
        self.case: str = name
        """The id of the case, or its name if it is a ``rigor.Case`` of your own."""
        self.engine: str = row["engine"]
        """The run's name, with its method and options: ``"core:rk4"``."""
        self.dt: str = row["dt"]
        """s, as written: ``"1/30"``."""
        self.dt_seconds: float = row["dt_seconds"]
        """s"""
        self.status: str = row["status"]
        """``pass fail known-deviation unexpected-pass unsupported diverged crashed timed-out invalid``"""
        self.reason: str = row["reason"]
        """Why the cell did not run to its end; empty if it did."""
        self.verdict: str | None = row["verdict"]["word"] if row.get("verdict") else None
        """``stable drifting overlapping gaining collapsed tunnelled`` or ``blown up``; None if the cell did not run."""
        self.cpu_seconds: float = number(row["cpu_seconds"])
        """s of CPU time of the run."""
        self.wall_seconds: float = number(row["wall_seconds"])
        """s by the clock."""
        self.metrics: dict[str, Metric] = {metric: Metric.of(value, units.get(metric, "")) for metric, value in row["metrics"].items()}
        """The metrics by their names; see ``metric``."""
        self._units, self._folder, self._keep = units, folder, keep

    def __repr__(self) -> str:
        return f"<rigor.Cell {self.case} {self.engine} dt={self.dt}: {self.status}{', ' + self.verdict if self.verdict else ''}>"

    def metric(self, name: str) -> Metric:
        """A metric of the cell. nan with a reason in ``why`` if it has no value here; InputError for a name that is no metric."""
        if name in self.metrics:
            return self.metrics[name]
        if name not in self._units:
            raise InputError(f"there is no metric {name!r}; there is: {', '.join(sorted(self._units))}")
        why = f"the cell is {self.status}: {self.reason}" if not self.metrics else "it was not measured in this cell"
        return Metric.of({"not_applicable": why}, self._units[name])

    def _file(self) -> pathlib.Path:
        if not self.row.get("trajectory") or self.status == "unsupported":
            raise RigorError(f"{self!r} has no trajectory: {self.reason or 'it did not run'}")
        path = pathlib.Path(self._folder) / "trajectories" / self.row["trajectory"]
        if not path.is_file():
            raise RigorError(f"{path}: the trajectory of the cell is no longer there")
        return path

    def trajectory(self) -> Trajectory:
        """The run, read from its file straight into one array."""
        from . import _native
        from .motion import Trajectory
        path = self._file()
        try:
            return _native.read_states(path.read_bytes()).view(Trajectory)
        except ValueError as error:
            raise RigorError(f"{path}: {error}") from None

    def series(self, metric: str) -> np.ndarray:
        """A metric over time: a structured array with ``time`` [s] and ``value``.

        InputError for a metric that is one number and has no series.
        """
        import numpy as np
        path = self._file()
        path = path.with_name(path.name.removesuffix(".csv") + ".series.csv")
        if not path.is_file():
            raise RigorError(f"{path}: the series of the cell are not there; run with series=True")
        with open(path, encoding="utf-8") as file:
            names = file.readline().rstrip("\n").split(",")
            if metric not in names[1:]:
                if metric not in self._units:
                    raise InputError(f"there is no metric {metric!r}; there is: {', '.join(sorted(self._units))}")
                raise InputError(f"{metric} has no series here; there is: {', '.join(names[1:]) or 'none'}")
            column = names.index(metric)
            cells = (line.rstrip("\n").split(",") for line in file)
            pairs = [(float(row[0]), float(row[column])) for row in cells if row[column]]
        return np.array(pairs, dtype=[("time", "<f8"), ("value", "<f8")])


_SCHEMA = 2  # of results.json, as results.schema.json has it


class Results:
    """What ``run`` and ``gate`` return. ``Results.from_folder`` reads those of an earlier run."""

    def __init__(self, folder: str, keep: object, names: dict[str, str], exit_code: int | None, notes: typing.Sequence[str], text: str):
        self.json: dict[str, typing.Any] = _read(os.path.join(folder, "results.json"))
        """results.json; ``results.schema.json`` describes it."""
        self.folder: str = folder
        """Of the reports. A folder without a name of yours goes with the last object that needs it."""
        self.exit_code: int | None = exit_code
        """Of the program; None for results of an earlier run."""
        self.notes: tuple[str, ...] = tuple(notes)
        """The sentences that the program said beside the results."""
        self.text: str = text
        """The table that the command line prints."""
        self._keep, self._names = keep, names
        self.units: dict[str, str] = {row["name"]: row["unit"] for row in self.json["metrics"]}
        """The unit of each metric, by its name."""
        self.cells: list[Cell] = [Cell(row, self._name(row["case"]), self.units, folder, keep) for row in self.json["cells"]]
        """One for each case, engine and step, in the order of results.json."""

    @classmethod
    def from_folder(cls, folder: str | os.PathLike[str]) -> Results:
        """The results that ``rigor run --out FOLDER``, or a call with `out`, has left in a folder."""
        return cls(os.fspath(folder), None, {}, None, (), "")

    def _name(self, case: str) -> str:
        return self._names.get(case, case)

    def __repr__(self) -> str:
        counts: dict[str, int] = {}
        for cell in self.cells:
            counts[cell.status] = counts.get(cell.status, 0) + 1
        return f"<rigor.Results of {len(self.cells)} cells: {', '.join(f'{count} {status}' for status, count in counts.items())}>"

    def __str__(self) -> str:
        return self.text or repr(self)

    @property
    def passed(self) -> bool:
        """Whether every gate holds that was checked, and every cell ran that its engine supports."""
        return self.exit_code in (0, None) and not any(cell.status in _FAILURES for cell in self.cells) and not self.failures()

    def failures(self) -> list[str]:
        """The gates that fell short, a sentence each, with the worst instant; and cells that did not run to their end."""
        found = []
        for case in self.json["cases"]:
            for gate in case["gates"]:
                for answer in gate["answers"]:
                    if answer["answer"] in ("failed", "not checked", "unexpected pass"):
                        run = " ".join(filter(None, [self._name(case["id"]), answer["engine"], answer["dt"] and f"dt = {answer['dt']}"]))
                        found.append(f"{run}: {answer.get('text', answer['answer'])}")
        told = " ".join(found)
        for cell in self.cells:
            if cell.status in _FAILURES[2:] and (cell.reason not in told or not found):
                found.append(f"{cell.case} {cell.engine} dt = {cell.dt}: {cell.status}: {cell.reason}")
        return found

    def cell(self, case: str, engine: str, dt: typing.Any) -> Cell:
        """The cell of a case, an engine and a step: ``results.cell("springs/fixed-spring", "ode", "1/30")``."""
        for cell in self.cells:
            if cell.case == case and cell.engine == engine and (cell.dt == dt or not isinstance(dt, str) and abs(cell.dt_seconds - dt) < 1e-9 * dt):
                return cell
        raise InputError(f"there is no cell of '{case}', '{engine}' and {dt}; there are {len(self.cells)}, for example {self.cells[0]!r}")

    def to_dataframe(self) -> typing.Any:
        """A pandas DataFrame: a row a cell, a column a metric, nan where a metric has no value. ``attrs["units"]`` has the units."""
        import pandas
        metrics = sorted({metric for cell in self.cells for metric in cell.metrics})
        columns: dict[str, list[typing.Any]] = {
            "case": [cell.case for cell in self.cells], "engine": [cell.engine for cell in self.cells], "dt": [cell.dt for cell in self.cells],
            "dt_seconds": [cell.dt_seconds for cell in self.cells], "status": [cell.status for cell in self.cells],
            "verdict": [cell.verdict for cell in self.cells], "reason": [cell.reason for cell in self.cells],
            "cpu_seconds": [cell.cpu_seconds for cell in self.cells], "wall_seconds": [cell.wall_seconds for cell in self.cells]}
        for metric in metrics:
            columns[metric] = [float(cell.metrics[metric]) if metric in cell.metrics else float("nan") for cell in self.cells]
        frame = pandas.DataFrame(columns)
        units = {metric: self.units.get(metric, "") for metric in metrics}
        frame.attrs["units"] = {"dt_seconds": "s", "cpu_seconds": "s", "wall_seconds": "s", **units}
        return frame

    def report(self, out: str | os.PathLike[str]) -> str:
        """Copies report.html, report.md, results.json, junit.xml and trajectories/ to `out`. Returns the page's path."""
        target = os.fspath(out)
        if os.path.abspath(target) != os.path.abspath(self.folder):
            shutil.copytree(self.folder, target, dirs_exist_ok=True)
        page = os.path.join(target, "report.html")
        return page if os.path.isfile(page) else os.path.join(target, "report.md")

    def _repr_html_(self) -> str:
        from .notebook import matrix_html
        return matrix_html(self)
