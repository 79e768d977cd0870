"""What `fit` answers: values, how sure they are, and the errors that are left."""
from __future__ import annotations

import math
import typing

from . import program
from .answers import Printed
from .errors import InputError

if typing.TYPE_CHECKING:
    import numpy as np


class FittedValue(float):
    """A fitted value. It is a float; its attributes say what the data tell of it."""

    key: str
    """What was fitted, as ``"scene.contact_default.friction"``."""
    unit: str
    """Of the value and its interval, as ``"N/m"``; ``"1"`` for a plain number; empty if the key has no unit of its own."""
    interval: tuple[float, float] | None
    """The 95 % interval, in `unit`; None if the data tell none."""
    open_ends: tuple[bool, bool]
    """Whether the lower and the upper end of `interval` are those of the range, because the data tell no end there."""
    at_bound: bool
    """The value is an end of its range, so a better one may lie beyond."""
    unknown: str
    """Why the data cannot tell the value, as ``"it changes nothing here"``; empty if they can."""

    @classmethod
    def of(cls, row: typing.Mapping[str, typing.Any]) -> FittedValue:
        """A value from its row of ``rigor fit --json``."""
        value = cls(row["value"])
        value.key, value.unit, value.at_bound, value.unknown = row["key"], row["unit"], row["at_bound"], row["unknown"]
        value.interval = None if row["interval"] is None else (row["interval"][0], row["interval"][1])
        value.open_ends = (False, False) if row["open_ends"] is None else (row["open_ends"][0], row["open_ends"][1])
        return value

    @property
    def known(self) -> bool:
        """Whether the data tell the value and it lies inside its range."""
        return not self.at_bound and not self.unknown

    def told(self) -> str:
        """The value with its unit, its interval and what limits it, as a sentence."""
        text = f"{self.key} = {float(self):.4g}{'' if self.unit in ('', '1') else f' {self.unit}'}"
        if self.interval is not None:
            low, high = f"{self.interval[0]:.4g}", f"{self.interval[1]:.4g}"
            told = {(True, False): f"at most {high}", (False, True): f"at least {low}"}
            text += f", 95 %: {told.get(self.open_ends, f'{low} to {high}')}"
        if self.at_bound:
            text += "; at the end of its range, so a better value may lie beyond"
        return text + (f"; the data cannot tell it: {self.unknown}" if self.unknown else "")


class FitError:
    """The error that a fit leaves, over some of the trials."""

    def __init__(self, row: typing.Mapping[str, typing.Any]):
        def number(key: str) -> float:
            return float("nan") if row[key] is None else float(row[key])

        self.trials: int = row["trials"]
        """How many motions were compared."""
        self.without_result: int = row["without_result"]
        """How many of them did not run to their end. They are in no mean."""
        self.position: float = number("position")
        """The mean distance from the truth, in m or in the unit `position_unit`; nan if no position is known."""
        self.position_spread: float = number("position_spread")
        """The standard deviation of it over the trials, in m or in the unit `position_unit`."""
        self.position_unit: str = row["position_unit"]
        """``"m"``, or ``"%"`` of the length that the recording states."""
        self.rotation: float = number("rotation")
        """rad: the mean angle from the truth; nan if no orientation is known."""
        self.rotation_spread: float = number("rotation_spread")
        """rad: the standard deviation of it over the trials."""

    def __repr__(self) -> str:
        parts = [f"{self.trials} trial{'' if self.trials == 1 else 's'}"]
        for what, mean, spread, unit in (("position", self.position, self.position_spread, self.position_unit),
                                         ("rotation", self.rotation, self.rotation_spread, "rad")):
            if not math.isnan(mean):
                parts.append(f"{what} {mean:.3g}{f' ± {spread:.3g}' if self.trials > 1 else ''} {unit}")
        return ", ".join(parts) + (f"; {self.without_result} of them without result" if self.without_result else "")


class Fitted(Printed):
    """The values with which a run follows the truth best. True if the data tell each, and none is an end of its range."""

    def __init__(self, done: program.Completed):
        super().__init__(done, True)
        self.json: typing.Any = self.json[0]
        """The answer of ``rigor fit --json`` for this engine."""
        self.engine: str = self.json["run"]
        """The run's name, without the fitted options."""
        self.values: dict[str, FittedValue] = {row["key"]: FittedValue.of(row) for row in self.json["parameters"]}
        """The fitted values by their keys. ``case.replace(**fitted.values)`` gives the case with those of the scene."""
        self.error: FitError = FitError(self.json["fitted"])
        """What is left on the trials that took part."""
        self.held_out: FitError | None = FitError(self.json["held_out"]) if self.json["held_out"] else None
        """What is left on the trials that took no part; None without `hold_out`."""
        self.points: int = self.json["points"]
        """How many values, or sets of values, were tried."""
        self.why_no_intervals: str = self.json["why_no_intervals"]
        """Why no value has an interval, as a sentence; empty if intervals were computed."""
        self.intervals: str = self.json["intervals"]
        """The method of the intervals: ``"bootstrap"`` over trials, ``"profile"`` likelihood of few trials; empty without."""
        self.caveats: list[str] = self.json["caveats"]
        """Sentences on what the intervals rest on, as on errors that the noise does not explain."""

    def __getitem__(self, key: str) -> FittedValue:
        """A value by its key: ``fitted["scene.contact_default.friction"]``."""
        if key not in self.values:
            raise InputError(f"{key!r} was not fitted; there is: {', '.join(self.values)}")
        return self.values[key]

    @property
    def correlations(self) -> np.ndarray:
        """(n, n): how much the n values depend on each other, from -1 to 1, in the order of `values`; (0, 0) without intervals."""
        import numpy as np
        rows = self.json["correlations"]
        return np.array(rows, dtype=float).reshape(len(rows), len(rows))

    def __bool__(self) -> bool:
        return all(value.known for value in self.values.values())

    def __repr__(self) -> str:
        lines = [f"{self.engine}: {self.points} values tried", *(f"  {value.told()}" for value in self.values.values())]
        if self.why_no_intervals:
            lines.append(f"  {self.why_no_intervals}")
        lines += [f"  {caveat}" for caveat in self.caveats]
        keys, strong = list(self.values), 0.5  # only pairs that cannot be told apart well, as on the command line
        for i, row in enumerate(self.correlations):
            lines += [f"  {keys[i]} and {keys[j]} depend on each other: correlation {row[j]:.2f}" for j in range(i + 1, len(row)) if abs(row[j]) >= strong]
        lines.append(f"  {'error' if self.held_out is None else 'fitted'}: {self.error!r}")
        return "\n".join([*lines, *([] if self.held_out is None else [f"  held out: {self.held_out!r}"])])
