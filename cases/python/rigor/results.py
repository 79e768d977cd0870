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


def number(value: typing.Any) -> float:
    """A number of results.json; nan for none."""
    return _WORDS[value] if isinstance(value, str) else float("nan") if value is None else float(value)


class Metric(float):
    """A metric's value, with what belongs to it. It is a float; nan if there is no value, and then ``why`` says so."""

    unit: str
    why: str
    """Why there is no value; empty if there is one."""
    worst_time: float
    """s: the instant of the value; nan if it has none."""
    worst_body: str
    first_second: float
    """The largest up to t = 1 s; nan if the metric has none."""
    compared_until: float
    """s"""
    held_to_itself: bool
    """The run's own code made the truth: the value shows convergence, not correctness."""

    @classmethod
    def of(cls, row: typing.Any, unit: str) -> Metric:
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
        self.row = row
        """The cell of results.json."""
        self.case: str = name
        self.engine: str = row["engine"]
        self.dt: str = row["dt"]
        """s, as written: ``"1/30"``."""
        self.dt_seconds: float = row["dt_seconds"]
        self.status: str = row["status"]
        """``pass fail known-deviation unexpected-pass unsupported diverged crashed timed-out invalid``"""
        self.reason: str = row["reason"]
        self.verdict: str | None = row["verdict"]["word"] if row.get("verdict") else None
        """``stable drifting overlapping gaining collapsed tunnelled`` or ``blown up``; None if the cell did not run."""
        self.cpu_seconds: float = number(row["cpu_seconds"])
        self.wall_seconds: float = number(row["wall_seconds"])
        self.metrics: dict[str, Metric] = {metric: Metric.of(value, units.get(metric, "")) for metric, value in row["metrics"].items()}
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
        import mmap

        from . import _native
        from .motion import Trajectory
        with open(self._file(), "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as text:
            return _native.read_states(text).view(Trajectory)

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


class Results:
    """What ``run`` and ``gate`` return."""

    def __init__(self, folder: str, keep: object, names: dict[str, str], exit_code: int, notes: typing.Sequence[str], text: str):
        with open(os.path.join(folder, "results.json"), encoding="utf-8") as file:
            self.json: dict[str, typing.Any] = json.load(file)
        """results.json; ``results.schema.json`` describes it."""
        self.folder: str = folder
        """Of the reports. A folder without a name of yours goes with the last object that needs it."""
        self.exit_code: int = exit_code
        self.notes: tuple[str, ...] = tuple(notes)
        self.text: str = text
        """The table that the command line prints."""
        self._keep, self._names = keep, names
        self.units: dict[str, str] = {row["name"]: row["unit"] for row in self.json["metrics"]}
        self.cells: list[Cell] = [Cell(row, self._name(row["case"]), self.units, folder, keep) for row in self.json["cells"]]

    def _name(self, case: str) -> str:
        return self._names.get(case, case)

    def __repr__(self) -> str:
        counts: dict[str, int] = {}
        for cell in self.cells:
            counts[cell.status] = counts.get(cell.status, 0) + 1
        return f"<rigor.Results of {len(self.cells)} cells: {', '.join(f'{count} {status}' for status, count in counts.items())}>"

    def __str__(self) -> str:
        return self.text

    @property
    def passed(self) -> bool:
        """Whether every gate holds that was checked, and every cell ran that its engine supports."""
        return self.exit_code == 0 and not any(cell.status in _FAILURES for cell in self.cells)

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
