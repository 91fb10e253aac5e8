"""Commands work with closed streams, and on terminals that cannot print every character."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest
from rich.console import Console

from crowdbot import cli
from crowdbot.cli.app import typer_app
from crowdbot.cli.app.streams import prepare_streams
from tests.paths import ROOT

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
    values = ascii("0 \u2013 2 m/s\u00b2 \u00d7 3 \u2026 \u4eba").replace("\\", "\\\\")
    begin = "from crowdbot.cli.app.streams import prepare_streams; prepare_streams(); print"
    done = _shell(f'{sys.executable} -c "{begin}({values})"', PYTHONIOENCODING="ascii:strict")
    assert done.stdout == "0 - 2 m/s^2 x 3 ... \\u4eba\n", done.stderr


@pytest.mark.parametrize("width", ["0", "00"])
def test_a_terminal_without_width_gets_whole_lines(
    width: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", width)
    prepare_streams()
    printed = io.StringIO()
    Console(file=printed).print("contacts 0 1/km")
    assert printed.getvalue() == "contacts 0 1/km\n"


def test_a_folder_that_is_gone_is_named(tmp_path: Path) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    file = ROOT / "scenario_specs" / "examples" / "world_doorway.yaml"
    words = f"cd {gone} && rmdir {gone} && {COMMAND} view {file} --out picture.svg"
    done = _shell(words, PYTHONPATH=str(ROOT))
    assert done.returncode == 1
    assert done.stderr == "error: the current folder is gone; change to one that exists\n"


def test_a_number_of_threads_of_zero_is_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("NUMBA_NUM_THREADS", "0")
    assert cli.main(["suites"]) == 1
    assert "NUMBA_NUM_THREADS must be above 0" in capsys.readouterr().err


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
