"""The table of verdicts that a notebook shows below a cell. Styles stand in the tags: notebooks drop style sheets of outputs."""
from __future__ import annotations

import html
import typing

if typing.TYPE_CHECKING:
    from .results import Cell, Results

# A cell's own background with its own dark text is read on a light and on a dark page; other text has the page's colour.
_COLOURS = {"stable": "#d9f0d9", "drifting": "#fdf3cf", "gaining": "#fbe0c4", "overlapping": "#fbe0c4", "collapsed": "#f7cfc9",
            "tunnelled": "#f7cfc9", "blown up": "#f0b5ae"}
_GREY, _RED = "#e4e4e4", "#f0b5ae"
_BOX = "border:1px solid rgba(128,128,128,.5);padding:4px 8px;text-align:left;vertical-align:top;"
_SMALL = "font-size:85%"
_FAILS = '<b style="color:#8b0000">{}</b>'


def _text(text: str) -> str:
    return html.escape(text, quote=True)


def matrix_html(results: Results) -> str:
    """Cases and engines at the headline's step, with each cell's verdict and main error."""
    headline = results.json["headline_dt"]
    engines = list(dict.fromkeys(cell.engine for cell in results.cells))
    counts: dict[str, int] = {}
    for cell in results.cells:
        counts[cell.status] = counts.get(cell.status, 0) + 1
    told = ", ".join(f"{count} {status}" for status, count in counts.items())
    parts = ['<div style="overflow-x:auto;max-width:100%">',
             f"<div style=\"margin:0 0 6px\"><b>Rigor</b>: {len(results.cells)} cells: {_text(told)}. Below: those of dt = {_text(headline)} s.</div>",
             '<table style="border-collapse:collapse;table-layout:auto;margin:0">',
             f'<thead><tr><th style="{_BOX}">case, main error</th>', *(f'<th style="{_BOX}">{_text(engine)}</th>' for engine in engines), "</tr></thead><tbody>"]
    for case in results.json["cases"]:
        parts.append(_row(results, case, engines, headline))
    return "".join([*parts, "</tbody></table></div>"])


def _row(results: Results, case: typing.Mapping[str, typing.Any], engines: list[str], headline: str) -> str:
    name, metric = results._name(case["id"]), case.get("main_error") or ""
    own = [cell for cell in results.cells if cell.case == name]
    steps = list(dict.fromkeys(cell.dt for cell in own))
    dt = headline if headline in steps or not steps else steps[0]
    label = metric if dt == headline else f"{metric}, dt = {dt} s"
    cells = (next((one for one in own if one.engine == engine and one.dt == dt), None) for engine in engines)
    return (f'<tr><td style="{_BOX}min-width:9em"><b>{_text(name)}</b><br><span style="{_SMALL}">{_text(label.removeprefix(", "))}</span></td>'
            + "".join(_matrix_cell(cell, metric) for cell in cells) + "</tr>")


def _matrix_cell(cell: Cell | None, metric: str) -> str:
    if cell is None:
        return f'<td style="{_BOX}"></td>'
    text = _text(cell.verdict or cell.status)
    if cell.verdict is not None and cell.status not in ("pass", "diverged"):
        text += f", {_FAILS.format(cell.status) if cell.status in ('fail', 'unexpected-pass') else cell.status}"
    value = cell.metrics.get(metric)
    size = ""
    if value is not None and not value.why:
        size = f'<br><span style="{_SMALL};white-space:nowrap">{value:.3g} {_text("" if value.unit == "1" else value.unit)}</span>'
    colour = _COLOURS.get(cell.verdict or "", _GREY if cell.status == "unsupported" else _RED)
    title = f"{metric}: {cell.reason}" if cell.reason else metric
    return f'<td title="{_text(title)}" style="{_BOX}color:#111;background:{colour}">{text}{size}</td>'
