"""What commands answer: tuned settings, divergences, repeats, conformance and diagnoses."""
from __future__ import annotations

import json
import shlex
import typing

from . import program


class Printed:
    """What a command printed: ``text``, and ``json`` if the command has it. True if its exit code is 0."""

    def __init__(self, done: program.Completed, as_json: bool):
        self.exit_code: int = done.code
        """Of the program: 0, or 1 if something does not hold."""
        self.notes: tuple[str, ...] = tuple(done.notes)
        """The sentences on stderr."""
        self.text: str = done.out.decode("utf-8", "replace")
        """What the command line prints."""
        self.json: typing.Any = json.loads(self.text) if as_json and self.text.strip() else None
        """The answer of ``--json``; None for a command without it, or if the command printed none."""

    def __bool__(self) -> bool:
        return self.exit_code == 0

    def __repr__(self) -> str:
        return self.text.rstrip()


class Tuned(Printed):
    """The cheapest setting within the bounds. False if there is none."""

    def __init__(self, done: program.Completed):
        super().__init__(done, False)
        self.engine: str | None = None
        """The winner's run name, with its options."""
        self.dt: str | None = None
        """The winner's step [s] as written: ``"1/30"``."""
        for line in self.text.splitlines():
            if line.strip().startswith("rigor run ") and self.engine is None:
                words = shlex.split(line)
                self.engine, self.dt = words[words.index("--engine") + 1], words[words.index("--dt") + 1]


class Divergence(Printed):
    """When, where and why two runs part. True if they part."""

    def __init__(self, done: program.Completed):
        super().__init__(done, True)
        parting, setting = self.json["parting"] or {}, self.json.get("setting")
        self.time: float = float(parting.get("time", "nan"))
        """s: when the runs part; nan if they agree to their end."""
        self.body: str = parting.get("body", "")
        """The body at which they part; empty if they agree."""
        self.component: str = parting.get("component", "")
        """What differs then, as ``"turn about y"``."""
        self.gap: float = float(parting.get("gap", "nan"))
        """The difference then, in the `unit`; nan if they agree."""
        self.unit: str = parting.get("unit", "")
        """Of `gap`: ``"m"``, ``"rad"``, ``"m/s"`` or ``"rad/s"``."""
        self.cause: str = self.json["causes"][0]["part"] if self.json.get("causes") else ""
        """The part of the physics in which their steps differ most, as ``"gravity"``; empty if none was found."""
        self.setting: str = "; ".join(swap["setting"] for swap in setting["swaps"]) if setting else ""
        """The change of a setting that closes the gap, as ``"method: rk4 -> semi-implicit-euler"``; empty if none does."""
        self.nearer: str = self._nearer()
        """The run that is nearer the truth then; empty if neither is, or without a truth of their own."""

    def _nearer(self) -> str:
        truth = self.json.get("truth") or {}
        if "a" not in truth or truth["a_is_made_by_it"] or truth["b_is_made_by_it"]:
            return ""
        return self.json[truth["nearer"]]["run"] if truth["nearer"] else ""

    def __bool__(self) -> bool:
        return self.json["parting"] is not None

    def __repr__(self) -> str:
        one, other = (f"{self.json[key]['run']} at dt = {self.json[key]['dt']} s" for key in ("a", "b"))
        if not self:
            return f"{one} and {other} agree within the bounds until t = {self.json['compared']:.6g} s"
        lines = [f"{one} and {other} part at t = {self.time:.6g} s: '{self.body}', {self.component}, {self.gap:.3g} {self.unit}"]
        truth = self.json["truth"]
        if "a" in truth:
            lines.append(f"  from the truth: {self.json['a']['run']} {truth['a']:.3g} {self.unit}, {self.json['b']['run']} {truth['b']:.3g} {self.unit}")
        for cause in self.json["causes"]:
            falls = ", and falls with dt" if cause["falls_with_dt"] else ""
            lines.append(f"  the steps differ in: {cause['part']}; it explains {cause['explains']:.1%} of a step's difference{falls}")
        if self.setting:
            lines.append(f"  closes {self.json['setting']['closes']:.1%} of the gap: {self.setting}")
        return "\n".join(lines)


class Repeats(Printed):
    """Whether runs give the same bits under each change that should not matter. True if all of them do."""

    def __init__(self, done: program.Completed, as_json: bool = True):
        super().__init__(done, as_json)
        self.runs: list[dict[str, typing.Any]] = self.json or []
        """A row for each case, with ``case``, ``run``, ``dt``, ``steps``, ``repeats`` and ``changes``. Empty with `record` or `against`.

        A change has ``change``, ``label``, ``must_hold``, ``status`` (same-bits, differs, failed, not-applicable) and ``why``. One that
        differs also has the ``step`` from which on it does, and where: ``body``, ``component``, ``difference`` there, and ``position`` [m]
        and ``orientation`` [rad] at the end.
        """

    def broken(self) -> list[dict[str, typing.Any]]:
        """The changes that should not matter and do, each with its ``case``."""
        return [{"case": run["case"], **change} for run in self.runs for change in run["changes"]
                if change["must_hold"] and change["status"] in ("differs", "failed")]

    def __repr__(self) -> str:
        if not self.runs:
            return self.text.rstrip()
        lines = []
        for run in self.runs:
            lines.append(f"{run['case']}: {run['run']} at {run['dt']} s, {run['steps']} steps: {'repeats' if run['repeats'] else 'does not repeat'}")
            lines += [f"  {change['change']:<16}{change['label']:<11} {self._told(change)}".rstrip() for change in run["changes"]]
        return "\n".join(lines)

    @staticmethod
    def _told(change: typing.Mapping[str, typing.Any]) -> str:
        if change["status"] != "differs":
            return change["status"] + (f": {change['why']}" if change["why"] else "")
        depends = "order-dependent" if "body" in change else "processor-dependent"  # of another process only hashes are known
        text = f"{'DIFFERS' if change['must_hold'] else depends} from step {change['step']} on"
        if "body" not in change:
            return text
        size, position, angle = ("inf" if change[key] is None else f"{change[key]:.3g}" for key in ("difference", "position", "orientation"))
        return f"{text}: {change['component']} of '{change['body']}' by {size}; at the end {position} m and {angle} rad"


class Conformance(Printed):
    """The checks of an engine against the interface. True if none is broken."""

    def __init__(self, done: program.Completed):
        super().__init__(done, True)
        self.checks: list[dict[str, typing.Any]] = self.json["checks"]
        """Rows with ``name``, ``asks``, ``answer`` (holds, broken, not-asked); of a broken one ``sent``, ``came`` and ``due``."""
        self.diagnosis: dict[str, typing.Any] | None = self.json.get("diagnosis")
        """The known mistake that explains what is broken, with the keys of ``Diagnosis.json``; None if none was looked for."""

    def broken(self) -> list[dict[str, typing.Any]]:
        """The rows of ``checks`` whose answer is ``broken``."""
        return [check for check in self.checks if check["answer"] == "broken"]

    def __repr__(self) -> str:
        lines = [f"{self.json['engine']}: {'conforms' if self else 'does not conform'}, {len(self.checks)} checks"]
        for check in self.checks:
            lines.append(f"  {check['answer']:<9} {check['name']:<16} {check['asks']}")
            if check["answer"] == "broken":
                lines += [f"{'':12}{key}: {check[key][:600]}" for key in ("came", "due")]
        return "\n".join(lines)


class Diagnosis(Printed):
    """Which known mistake explains an engine's error. True if there is no error beyond what its scheme makes."""

    def __init__(self, done: program.Completed):
        super().__init__(done, True)
        self.verdict: str = self.json["verdict"]
        """``right``; ``named`` (one mistake explains the error); ``alike`` (several do); ``none`` (no known mistake does); ``untried``."""
        self.suspects: list[dict[str, typing.Any]] = self.json["suspects"]
        """The best first: ``mistakes``, ``explains`` (its share of the error, 0 to 1), ``cases`` with what is ``left``."""
        leaders = self.suspects[:self.json["leaders"]] if self.verdict in ("named", "alike") else []
        self.mistakes: tuple[str, ...] = tuple("; and ".join(suspect["mistakes"]) for suspect in leaders)
        """The mistakes that explain the error, a sentence each. Those of ``alike`` move alike in these cases."""

    def __bool__(self) -> bool:
        return self.verdict == "right"

    def __repr__(self) -> str:
        found = {"right": "no error beyond what its scheme makes", "untried": "none of its motions could be computed",
                 "none": f"looks like none of {self.json['known_mistakes']} known mistakes",
                 "named": f"looks like: {', '.join(self.mistakes)}", "alike": f"looks like one of: {', '.join(self.mistakes)}"}
        lines = [f"{self.json['engine']}: {found[self.verdict]}, in {len(self.json['cases'])} cases"]
        lines += [f"  {suspect['explains']:7.2%} of the error: {'; and '.join(suspect['mistakes'])}" for suspect in self.suspects]
        return "\n".join([*lines, *(f"  not seen: {failure}" for failure in self.json["not_seen"])])
