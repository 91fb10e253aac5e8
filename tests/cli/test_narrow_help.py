"""Help names every option and command in full, however narrow the terminal is."""

from __future__ import annotations

import pytest

from crowdbot.cli import command_names, main


@pytest.mark.parametrize("width", [60, 80, 200])
@pytest.mark.parametrize("command", ["", *command_names()])
def test_help_cuts_nothing_off(
    command: str, width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    assert main([*command.split(), "--help"]) == 0
    text = capsys.readouterr().out
    assert "…" not in text
    assert max(map(len, text.splitlines())) <= width


def test_commands_are_told_in_full(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "60")
    for command in ([], ["plugins"]):
        assert main([*command, "--help"]) == 0
    words = " ".join(capsys.readouterr().out.split())
    assert "a suite and tests." in words
    assert "--install-completion" in words
    assert "Pack scores, hashes, scenarios and provenance of one planner's runs into one" in words


def test_paragraphs_are_wrapped_once(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    assert main(["bundle", "--help"]) == 0
    assert "checks the archive and repeats some of its runs." in capsys.readouterr().out
