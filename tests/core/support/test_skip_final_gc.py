"""A process that ends quickly leaves out the collector, and nothing that a person would miss."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = """
import atexit, sys
from crowdbot.core.support.skip_final_gc import end_without_collecting

class Cycle:
    def __init__(self):
        self.me = self
    def __del__(self):
        print("collected")

if sys.argv[2] == "quick":
    end_without_collecting()
    end_without_collecting()
cycle = Cycle()
atexit.register(print, "at exit")
file = open(sys.argv[1], "w")
file.write("kept")
"""


@pytest.mark.parametrize(
    ("way", "printed"), [("quick", ["at exit"]), ("slow", ["at exit", "collected"])]
)
def test_files_are_closed_and_exit_handlers_run_but_cycles_stay(
    tmp_path: Path, way: str, printed: list[str]
) -> None:
    file = tmp_path / "file.txt"

    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", PROGRAM, str(file), way],
        capture_output=True, text=True, check=True,
    )  # fmt: skip

    assert done.stdout.split("\n")[:-1] == printed
    assert not done.stderr
    assert file.read_text() == "kept"
