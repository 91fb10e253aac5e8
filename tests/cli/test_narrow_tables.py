"""Tables lose nothing where a terminal is narrow."""

from __future__ import annotations

from typing import Any

import pytest

from crowdbot.cli.commands.look.info import _show
from crowdbot.cli.output.plugin_table import table
from crowdbot.cli.output.results_lines import print_table
from crowdbot.core.recording.reading.contents import RecordingContents, TopicContents

LINE: dict[str, Any] = {
    "planner": "dwa", "metric": "contacts_per_km", "variant": "at_fault", "unit": "1/km",
    "mean": 12.345678, "low": 1.5, "high": 98.5, "least": None, "most": None, "median": 7.0,
    "n": 12, "undefined": 0, "not_kept": 0, "censored": 3, "failed": 1,
}  # fmt: skip


@pytest.mark.parametrize("width", [60, 80, 120, 200])
def test_results_fit_and_say_everything(
    width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    print_table([LINE])
    text = capsys.readouterr().out
    assert max(map(len, text.splitlines())) <= width
    expected = "".join(text.split())
    if width < 70:  # broken between words, not between letters
        assert {"contacts_", "per_km", "at_fault,", "1/km"} <= set(text.split())
    else:
        for word in ("dwa", "contacts_per_km", "at_fault", "1/km", "12.3", "1.5", "98.5", "7"):
            assert word in expected
    assert "12" in expected
    assert "censored" in expected or width == 60


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


@pytest.mark.parametrize("width", [60, 80, 200])
def test_topics_of_a_recording_are_named_in_full(
    width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    topic = TopicContents("/crowdbot/candidates", "crowdbot_msgs/msg/VelocityCandidates", 1, 3780)
    found = RecordingContents(
        topics=(topic,), finished=True, complete=True, status="arrived", is_run=True, end=1.0,
        size=4000, attachments={},
    )  # fmt: skip
    monkeypatch.setenv("COLUMNS", str(width))
    _show({"file": "run.mcap"}, found)
    output = "".join(capsys.readouterr().out.split())
    assert "…" not in output
    if width > 70:
        assert "crowdbot_msgs/msg/VelocityCandidates" in output
    assert "3780" in output


@pytest.mark.parametrize("width", [60, 80, 300])
def test_long_lines_become_blocks(
    width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    line = {"planners": "dwa - orca", "condition": "all"} | {f"value_{i}": i / 8 for i in range(12)}
    monkeypatch.setenv("COLUMNS", str(width))
    print_table([line, line])
    text = capsys.readouterr().out
    assert max(map(len, text.splitlines())) <= width
    if width == 300:
        assert text.count("value_11") == 1  # the head of a table
    else:
        assert text.splitlines()[0] == "dwa - orca · all"
        assert " ".join(text.split()).count("value_2 0.25, value_3 0.375,") == 2
