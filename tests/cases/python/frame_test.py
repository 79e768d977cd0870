"""The frame of results equals results.json: each cell, each metric, and nothing else.

``python3 frame_test.py FOLDER`` compares those of a folder, as of the whole suite.
"""
import json
import math
import os
import sys

import pytest
from free_bodies import broken

import rigor


@pytest.fixture(scope="module")
def sample(tmp_path_factory):
    """Three cases on engines that are right, blow up, lack features, crash and lose their numbers."""
    crashes, diverges = broken("step", "1 / 0"), broken("step", "raise rigor.DivergedError('too fast')")
    crashes.name, diverges.name = "crashes", "diverges"
    out = tmp_path_factory.mktemp("sample") / "out"
    rigor.run(["springs/stiff-1", "springs/fixed-spring", "contact/bounce-half"], dt=["1/10", "1/30"], duration=1, out=out, progress=False,
              engines=["core:rk4", "core:explicit-euler", "ode", "core:adams", crashes, diverges])
    return out


def number_of(value):
    """By the schema: a number, one of three words, or null for none."""
    if value is None:
        return math.nan
    return {"inf": math.inf, "-inf": -math.inf, "nan": math.nan}[value] if isinstance(value, str) else float(value)


def is_same(a, b):
    return a == b or math.isnan(a) and math.isnan(b)


def compare(folder):
    """How many cells and numbers there are. Raises for any difference."""
    with open(os.path.join(folder, "results.json"), encoding="utf-8") as file:
        told = json.load(file)
    frame = rigor.Results.from_folder(folder).to_dataframe()
    assert len(frame) == len(told["cells"])
    rows = frame.to_dict("records")
    plain = {"case", "engine", "dt", "dt_seconds", "status", "verdict", "reason", "cpu_seconds", "wall_seconds"}
    assert set(frame.columns) == plain | {metric for cell in told["cells"] for metric in cell["metrics"]}
    units = {metric["name"]: metric["unit"] for metric in told["metrics"]}
    seen = 0
    for row, cell in zip(rows, told["cells"]):
        assert [row[key] for key in ("case", "engine", "dt", "dt_seconds", "status", "reason")] == \
            [cell[key] for key in ("case", "engine", "dt", "dt_seconds", "status", "reason")]
        assert row["verdict"] == (cell["verdict"]["word"] if cell["verdict"] else None)
        assert all(is_same(row[key], number_of(cell[key])) for key in ("cpu_seconds", "wall_seconds"))
        for metric in set(row) - plain:
            value = cell["metrics"].get(metric)
            due = number_of(value["value"] if isinstance(value, dict) and "value" in value else None if isinstance(value, dict) else value)
            assert is_same(row[metric], due), f"{cell['case']} {cell['engine']} {cell['dt']}: {metric} is {row[metric]} and {due}"
            assert frame.attrs["units"][metric] == units[metric]
            seen += not math.isnan(due)
    # Counted the other way round: no number of the frame is missing from results.json.
    assert seen == sum(int(frame[metric].notna().sum()) for metric in set(frame.columns) - plain)
    return len(rows), seen


def test_the_frame_equals_results_json(sample):
    cells, numbers = compare(sample)
    assert cells == 3 * 6 * 2 and numbers > 200
    statuses = set(rigor.Results.from_folder(sample).to_dataframe()["status"])
    assert {"pass", "unsupported", "diverged", "crashed"} <= statuses, statuses


@pytest.mark.parametrize("change", [
    lambda told: told["cells"][0]["metrics"]["position_error"].update(value=7.0),
    lambda told: told["cells"][0]["metrics"].pop("position_error"),
    lambda told: told["cells"].pop(),
    lambda told: told["cells"][3].update(status="pass" if told["cells"][3]["status"] != "pass" else "fail"),
])
def test_the_comparison_finds_a_difference(sample, tmp_path, monkeypatch, change):
    with open(sample / "results.json", encoding="utf-8") as file:
        told = json.load(file)
    before = rigor.Results.from_folder(sample)
    change(told)
    (tmp_path / "results.json").write_text(json.dumps(told))
    monkeypatch.setattr(rigor.Results, "from_folder", lambda folder: before)
    with pytest.raises((AssertionError, KeyError)):
        compare(tmp_path)


def test_results_of_a_folder_are_those_of_the_run(sample):
    results = rigor.Results.from_folder(sample)
    assert not results.passed and any("crashes" in failure for failure in results.failures())
    assert results.exit_code is None and len(results.cells) == 36 and "36 cells" in str(results)
    assert len(results.cell("springs/fixed-spring", "ode", "1/30").trajectory()) > 0


@pytest.mark.parametrize("text, words", [(None, "cannot be read: No such file"), ("{", "is no JSON"), ("[]", "its 'schema' is None"),
                                         ('{"schema": 1}', "its 'schema' is 1; this version of rigor reads 2")])
def test_a_folder_without_results_is_an_input_error(tmp_path, text, words):
    if text is not None:
        (tmp_path / "results.json").write_text(text)
    with pytest.raises(rigor.InputError, match=words):
        rigor.Results.from_folder(tmp_path)


if __name__ == "__main__":
    print("{} cells and {} numbers are the same".format(*compare(sys.argv[1])))
