"""The table that a notebook shows: well formed, safe, and read at two widths, in light and in dark."""
import html.parser
import os
import pathlib
import subprocess

import pytest

import rigor

HERE = pathlib.Path(__file__).parent
SHOTS = pathlib.Path(os.environ.get("RIGOR_SCREENSHOTS", "/tmp/rigor-screenshots")) / "notebook"
ENGINES = ["core:rk4", "core:semi-implicit-euler", "core:explicit-euler", "ode", "bullet", "core:adams"]


@pytest.fixture(scope="module")
def results():
    """Engines that are right, that blow up, and that lack what a scene needs."""
    return rigor.run(["springs/fixed-spring", "springs/stiff-1", "tops/dzhanibekov-box", "contact/bounce-half"], engines=ENGINES,
                     dt=["1/30", "1/240"], duration=1, progress=False)


def told_by_the_browser(text, folder, shots):
    output = folder / "output.html"
    output.write_text(text, encoding="utf-8")
    said = subprocess.run(["node", str(HERE / "notebook_page.mjs"), str(output), str(shots)], capture_output=True, text=True, timeout=120)
    assert said.returncode == 0, said.stderr
    return said.stdout


class Table(html.parser.HTMLParser):
    """The texts of a table's rows, and whether each tag is closed."""

    def __init__(self, text):
        super().__init__()
        self.opened, self.rows = [], []
        self.feed(text)
        assert not self.opened

    def handle_starttag(self, tag, attributes):
        if tag == "br":
            self.rows[-1][-1] += " "
            return
        self.opened.append(tag)
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        assert self.opened.pop() == tag

    def handle_data(self, data):
        if {"td", "th"} & set(self.opened):
            self.rows[-1][-1] += data


def test_each_cell_has_its_verdict_and_its_main_error(results):
    head, *rows = Table(results._repr_html_()).rows
    assert head == ["case, main error", *ENGINES] and len(rows) == 4
    of_case = {case["id"]: case["main_error"] for case in results.json["cases"]}
    words = set()
    for (label, *texts), case in zip(rows, of_case):
        assert label == f"{case} {of_case[case]}"
        for engine, text in zip(ENGINES, texts, strict=True):
            cell = results.cell(case, engine, results.json["headline_dt"])
            words.add(text.split()[0])
            assert text.startswith(cell.verdict or cell.status), text
            error = cell.metric(of_case[case])
            assert error.why or f"{error:.3g}" in text, text
    assert {"stable", "unsupported"} <= words


def test_text_of_a_case_cannot_break_the_table():
    case = rigor.Case.from_dict({"title": "<script>", "scene": {"body": [{"name": "<b>&", "mass": 1, "inertia": [1, 1, 1]}]},
                                 "run": {"duration": 1, "dt": ["1/10"]}}, name="plain")
    shown = rigor.run(case, engines="core:rk4", progress=False)
    shown.cells[0].reason = '"><script>alert(1)</script>'
    page = shown._repr_html_()
    assert shown.cells[0].case == "plain" and "<script>" not in page and "<b>&" not in page
    assert len(Table(page).rows) == 2


def test_it_is_read_at_two_widths_in_light_and_dark(results, tmp_path):
    assert told_by_the_browser(results._repr_html_(), tmp_path, SHOTS) == ""
    pictures = sorted(path.name for path in SHOTS.glob("*.png"))
    assert pictures == [f"notebook-{theme}-{width}.png" for theme in ("dark", "light") for width in (1000, 400)]


def test_the_browser_finds_what_cannot_be_read(tmp_path):
    text = '<table><tr><td style="color:#111">dark</td><td>plain</td><td>more</td></tr></table>'
    said = told_by_the_browser(text, tmp_path, tmp_path / "shots")
    assert "notebook-dark-400: 'dark' has a contrast of 1.0" in said and "light" not in said and "plain" not in said
    said = told_by_the_browser(f'<div style="width:600px">{text}</div>', tmp_path, tmp_path / "shots")
    assert "notebook-light-400: the page is" in said and "notebook-light-1000: the page" not in said
