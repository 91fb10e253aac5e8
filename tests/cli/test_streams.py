"""Commands work with closed streams, and on terminals that cannot print every character."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from crowdbot import cli
from crowdbot.cli.app import typer_app

COMMAND = f"{sys.executable} -m crowdbot"


def _shell(words: str, **more: str) -> subprocess.CompletedProcess[str]:
    """Run a line of a shell, whose locale is the poorest there is."""
    plain = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    return subprocess.run(
        ["sh", "-c", words], env=os.environ | plain | more, capture_output=True, text=True,
        check=False, timeout=60,
    )  # fmt: skip


def test_closed_streams_are_no_error() -> None:
    done = _shell(f"{COMMAND} plugins <&- >&-")
    assert (done.returncode, done.stderr) == (0, "")


def test_characters_that_cannot_be_printed_are_written_plainly() -> None:
    said = ascii("0 \u2013 2 m/s\u00b2 \u00d7 3 \u2026 \u4eba").replace("\\", "\\\\")
    begin = "from crowdbot.cli.app.streams import prepare_streams; prepare_streams(); print"
    done = _shell(f'{sys.executable} -c "{begin}({said})"', PYTHONIOENCODING="ascii:strict")
    assert done.stdout == "0 - 2 m/s^2 x 3 ... \\u4eba\n", done.stderr


def test_too_little_memory_is_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def run(words: list[str]) -> None:
        raise MemoryError(f"Unable to allocate 9. TiB for {words[0]}")

    monkeypatch.setattr(typer_app, "run", run)
    assert cli.main(["plugins"]) == 1
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert "not enough memory (Unable to allocate 9. TiB for plugins)" in message
