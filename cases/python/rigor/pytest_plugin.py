"""A plug-in of pytest: ``pytest --rigor my_gates.toml`` runs each gate of a case file as a test.

The cells run once, before the first gate. A gate that fails shows the worst instant. If no gate judges anything, all fail.
"""
from __future__ import annotations

import collections.abc
import pathlib
import typing

import pytest

if typing.TYPE_CHECKING:
    from .case import Case
    from .results import Results

_FAILED = ("failed", "not checked", "unexpected pass")  # as rigor gate judges


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("rigor", "gates of Rigor")
    group.addoption("--rigor", action="append", default=[], metavar="CASE",
                    help="run the gates of this case file, case or family as tests; repeatable")
    group.addoption("--rigor-engine", action="append", default=[], metavar="E", help="only the gates of this run, as ode or core:rk4; repeatable")
    group.addoption("--rigor-plugin", action="append", default=[], metavar="P", help="an engine from outside, as of rigor --plugin; repeatable")


class GateFailed(Exception):
    """A gate does not hold."""


class _Grid:
    """The cells of all gates, run when the first gate asks."""

    def __init__(self, config: pytest.Config):
        self._config, self._results, self._error = config, None, None  # type: ignore[var-annotated]
        self._results: Results | None
        self._error: Exception | None

    def results(self) -> Results:
        import rigor
        if self._results is None and self._error is None:
            try:
                self._results = rigor.gate(self._config.getoption("--rigor"), engines=self._config.getoption("--rigor-engine") or None,
                                           plugins=self._config.getoption("--rigor-plugin"), progress=False)
            except Exception as error:  # each gate tells the same
                self._error = error
        if self._error is not None:
            raise self._error
        assert self._results is not None
        return self._results


class GateItem(pytest.Item):
    """One gate of one case."""

    def __init__(self, *, grid: _Grid, case: Case, number: int, **others: typing.Any):
        super().__init__(**others)
        self.grid, self.case, self.number = grid, case, number
        self.gate = case.gates[number]

    def runtest(self) -> None:
        results = self.grid.results()
        rows = [case for case in results.json["cases"] if case["id"] == self.case.name]
        answers = [answer for case in rows for answer in case["gates"][self.number]["answers"]] if rows else []
        broken = [cell for cell in results.cells if cell.case == self.case.name and cell.status in ("crashed", "timed-out", "invalid")]
        faults = [f"{answer['engine']} dt = {answer['dt']}: {answer.get('text', '')}" for answer in answers if answer["answer"] in _FAILED]
        faults += [f"{cell.engine} dt = {cell.dt}: {cell.status}: {cell.reason}" for cell in broken]
        if rows and rows[0].get("error"):
            faults.append(rows[0]["error"])
        if faults:
            raise GateFailed("\n".join([*faults, f"because: {self.gate['because']}"]))
        if not answers:
            pytest.skip("the gate is for other runs than those of --rigor-engine")
        if all(answer["answer"] == "not recorded" for answer in answers):
            pytest.skip("the gate compares with recorded values, and there is none for this engine")

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: typing.Any = None) -> typing.Any:
        import rigor
        if isinstance(excinfo.value, (GateFailed, rigor.RigorError)):
            return f"{self.gate['where']}: gate on {self.gate['metric']}\n{excinfo.value}"
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[pathlib.Path, int | None, str]:
        path, line = self.gate["where"].rsplit(":", 2)[:2]
        return pathlib.Path(path), int(line) - 1, self.name


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(session: pytest.Session, config: pytest.Config, items: list[pytest.Item]) -> None:
    words = config.getoption("--rigor")
    if not words:
        return
    import rigor

    from .case import Case, _show
    grid = _Grid(config)
    flags = [word for plugin in config.getoption("--rigor-plugin") for word in ("--plugin", plugin)]
    try:
        shown = _show(words, flags)
    except rigor.RigorError as error:
        raise pytest.UsageError(f"--rigor: {error}") from None
    found = len(items)
    for facts in shown:
        case = Case(facts, file=None, folder=None, name=facts["id"], values=None)
        for number, gate in enumerate(case.gates):
            items.append(GateItem.from_parent(session, name=f"{case.name}::{_title(gate)}[{number}]", grid=grid, case=case, number=number))
    if len(items) == found:
        raise pytest.UsageError(f"--rigor: there is no gate in {', '.join(words)}, so there is nothing to test")


def _title(gate: collections.abc.Mapping[str, typing.Any]) -> str:
    limits = [f"{key}={gate[key]}" for key in ("max", "min", "equals", "at_least_order", "better_than", "regression") if key in gate]
    return " ".join([gate["metric"], *limits])
