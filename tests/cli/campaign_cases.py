"""A campaign of a few short runs, in this process or in one of its own."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

from tests.waiting import AT_MOST

_ALL = ["--only", "in-d0125-slow-c01-*"]
TINY = ["challenge-2020", *_ALL, "--set",
        "robots.robot.task.time_limit=1 s", "--no-replay", "--no-floors",
        "--jobs", "2"]  # fmt: skip


def start(out: Path, *more: str) -> subprocess.Popen[str]:
    """The command in a process group of its own; ``--only`` and ``--floors`` replace ours."""
    replaced = [*_ALL] * ("--only" in more) + ["--no-floors"] * ("--floors" in more)
    tiny = [word for word in TINY if word not in replaced]
    return subprocess.Popen(
        [sys.executable, "-m", "crowdbot", "campaign", *tiny, "--out", str(out), *more],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip


def run(out: Path, *more: str, timeout: float = AT_MOST) -> tuple[int, dict[str, Any], str]:
    """Exit code, the summary, and what was said."""
    running = start(out, *more, "--json")
    output, err = running.communicate(timeout=timeout)
    assert "Traceback" not in output + err
    return running.returncode, json.loads(output) if output else {}, err


def outcome(out: Path) -> dict[str, tuple[str, str]]:
    """Run -> trajectory hash, and the scores but for those of wall time."""
    found = {}
    for record in sorted(out.glob("challenge-2020/*/*/*/run.json")):
        lines = (record.parent / "scores.csv").read_text().splitlines()
        scores = "\n".join(line for line in lines if "planner_time" not in line)
        document = json.loads(record.read_text())
        name = record.parent.relative_to(out).as_posix()
        found[name] = (document["hashes"]["trajectory"], scores)
    return found
