"""Text of others never reaches the terminal as control characters."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from crowdbot import cli
from crowdbot.cli.output.say import say
from crowdbot.core.planning.process.planner_line import _shown
from tests.paths import ROOT

#: What prints without `say`: the function itself, what runs before typer is loaded, and progress
#: with texts of our own only.
ALLOWED = {
    "output/say.py", "app/typer_app.py", "app/mishaps.py", "__init__.py", "shared/progress.py",
    "shared/one_run.py",
}  # fmt: skip


def test_control_characters_are_escaped(capsys: pytest.CaptureFixture[str]) -> None:
    say("a\x1b[31mb\x07\x9b2J\u202e\tc")
    say("x\rover", err=True)
    captured = capsys.readouterr()
    assert captured.out == "a\\x1b[31mb\\x07\\x9b2J\\u202e\tc\n"
    assert captured.err == "x\\rover\n"


@pytest.mark.parametrize(
    "words",
    [
        ["\x1b[31mx"],
        ["--\x1b[31mx"],
        ["validate", "--\x1b[31mx"],
    ],
)
def test_what_was_typed_is_repeated_without_control_characters(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(words) == 2
    captured = capsys.readouterr()
    assert "\x1b[31m" not in (captured.out + captured.err).replace("\\x1b", "")
    assert "\\x1b" in captured.err


def test_commands_print_by_say() -> None:
    folder = Path(ROOT) / "crowdbot" / "cli"
    found = {
        file.relative_to(folder).as_posix()
        for file in folder.rglob("*.py")
        if re.search(r"^\s*(?:typer\.echo|print)\(", file.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert found <= ALLOWED


def test_what_a_planner_prints_is_escaped() -> None:
    assert _shown(b"ok\r\n\x1b]0;title\x07\x1b[2Jdone\rover\n") == (
        "ok\n\\x1b]0;title\\x07\\x1b[2Jdone\\rover\n"
    )
