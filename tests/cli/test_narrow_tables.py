"""Tables lose nothing where a terminal is narrow."""

from __future__ import annotations

from typing import Any

import pytest

from crowdbot.cli._plugin_table import table
from crowdbot.cli.results import _print_table

LINE: dict[str, Any] = {
    "planner": "dwa", "metric": "contacts_per_km", "variant": "at_fault", "unit": "1/km",
    "mean": 12.345678, "low": 1.5, "high": 98.5, "least": None, "most": None, "median": 7.0,
    "n": 12, "undefined": 0, "censored": 3, "failed": 1,
}  # fmt: skip


@pytest.mark.parametrize("width", [60, 80, 120, 200])
def test_results_fit_and_say_everything(
    width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    _print_table([LINE])
    text = capsys.readouterr().out
    assert max(map(len, text.splitlines())) <= width
    told = "".join(text.split())
    if width > 70:  # below, cells are folded between letters
        for word in ("dwa", "contacts_per_km", "at_fault", "1/km", "12.3", "1.5", "98.5", "7"):
            assert word in told
    assert "12" in told
    assert "censored" in told or width == 60


@pytest.mark.parametrize("width", [60, 100, 200])
def test_the_last_column_is_wrapped(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    words = [f"word{i}" for i in range(60)]
    rows = [["plugin", "distribution", "provides"], ["acme", "acme 1.0", " ".join(words)]]
    monkeypatch.setenv("COLUMNS", str(width))
    text = table(rows)
    assert max(map(len, text.splitlines())) <= width
    assert text.split()[-60:] == words
    monkeypatch.delenv("COLUMNS")
    assert len(table(rows).splitlines()) == 2  # a file need not be folded
