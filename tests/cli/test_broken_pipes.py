"""Pipes that break: of the output, which is usual, and to processes that ended, which is said."""

from __future__ import annotations

import os
import subprocess
import sys
from concurrent.futures.process import BrokenProcessPool

import pytest

import crowdbot.cli
from crowdbot.cli.app.mishaps import no_one_reads


def test_whether_someone_reads() -> None:
    for closed in (False, True):
        reading, writing = os.pipe()
        with os.fdopen(writing, "w") as stream:
            assert not no_one_reads(stream)
            if closed:
                os.close(reading)
            assert no_one_reads(stream) == closed
        if not closed:
            os.close(reading)


@pytest.mark.parametrize("reader_stays", [True, False])
def test_only_a_closed_output_ends_quietly(reader_stays: bool) -> None:
    """A broken pipe to another process is an error, even though its kind is the same."""
    code = (
        "import sys, crowdbot.cli as cli\n"
        "def fail(words): sys.stdin.read(); raise BrokenPipeError(32, 'Broken pipe')\n"
        "cli._dispatch = fail\n"
        "sys.exit(cli.main([]))"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True,
    ) as process:  # fmt: skip
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        if not reader_stays:
            process.stdout.close()
        process.stdin.close()
        message = process.stderr.read()
        assert process.wait() == reader_stays
    assert ("a process that this command started has ended" in message) == reader_stays


def test_a_pool_whose_process_ended(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(_: list[str]) -> None:
        raise BrokenProcessPool("terminated abruptly")

    monkeypatch.setattr(crowdbot.cli, "_dispatch", fail)
    assert crowdbot.cli.main(["suites"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("error: a process that this command started has ended")
    assert "--jobs 1" in line
