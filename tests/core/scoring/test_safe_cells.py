"""Tables hold no formulas: cells that begin like one get an apostrophe, numbers do not."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from crowdbot.core.scoring.scores_csv import safe_cell, write_table


@pytest.mark.parametrize("cell", ["=1+1", "@sum(a)", "+cmd|' /c calc'!a0", "-x", "\t=1", "\r=1"])
def test_formulas_are_defused(tmp_path: Path, cell: str) -> None:
    assert safe_cell(cell) == f"'{cell}"
    write_table(tmp_path / "t.csv", [["a", cell]])
    with (tmp_path / "t.csv").open(newline="") as file:
        assert next(csv.reader(file)) == ["a", f"'{cell}"]


@pytest.mark.parametrize("cell", ["", "-0.5", "+3", "-1e-9", "-inf", "a=b", "x", "1"])
def test_other_cells_stay(cell: str) -> None:
    assert safe_cell(cell) == cell
