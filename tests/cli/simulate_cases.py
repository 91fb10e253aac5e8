"""Calling `crowdbot simulate`, in this process and in others."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from crowdbot import cli
from tests.waiting import AT_MOST

ID = "in-d0125-slow-c01-r02"
FILES = {"run.json", "scenario.yaml", "run.mcap", "scores.csv", "replay.html"}


def limit(seconds: float) -> list[str]:
    return ["--set", f"robots.robot.task.time_limit={seconds:g} s"]


@dataclass
class Answer:
    code: int
    out: str
    err: str

    @property
    def json(self) -> dict[str, Any]:
        return dict(json.loads(self.out))


class Shell:
    """Calls the command in this process and looks at what it says."""

    def __init__(self, out: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.out, self._capsys = out, capsys

    def __call__(self, *more: str, id_: str = ID, seconds: float = 1.0) -> Answer:
        return self.run(["challenge-2020", id_, *limit(seconds), "--out", str(self.out), *more])

    def run(self, argv: Sequence[str]) -> Answer:
        self._capsys.readouterr()
        code = cli.main(["simulate", *argv])
        shown = self._capsys.readouterr()
        assert "Traceback" not in shown.out + shown.err
        return Answer(code, shown.out, shown.err)

    def runs(self) -> list[Path]:
        return sorted(p.parent for p in self.out.glob("challenge-2020/**/run.json"))

    def leftovers(self) -> list[str]:
        """Everything that is not under a final name."""
        found = [p for p in self.out.rglob("*") if ".partial" in p.name or ".old" in p.name]
        found += [p for p in self.out.rglob("*") if p.name in (".lock", "run.json.part")]
        return sorted(p.name for p in found)


def planner_file(folder: Path, step: str = "return (0.3, 0.1)", **more: str) -> str:
    """A planner in a file; ``step``, ``reset``, ``init``, ``top`` are lines of Python."""
    body = {"top": "pass", "init": "pass", "reset": "pass", **more}
    text = (
        "import sys, time, os\n"
        f"{body['top']}\n"
        "class Mine:\n"
        f"    needs = {body.get('needs', '()')}\n"
        f"    def __init__(self): {body['init']}\n"
        f"    def reset(self, task, limits, sensors, seed): {body['reset']}\n"
        f"    def step(self, obs):\n        {step}\n"
    )
    path = folder / "mine.py"
    path.write_text(text, encoding="utf-8")
    return f"{path}:Mine"


def process(out: Path, *more: str, seconds: float = 1.0) -> subprocess.Popen[str]:
    """The command in a process of its own; its watchdog has little patience."""
    code = (
        "import sys; from crowdbot.cli import main; "
        "from crowdbot.core.planning.watchdog import Watchdog; "
        "Watchdog.__init__.__defaults__ = (1.0, 0.5, None); sys.exit(main())"
    )
    argv = ["simulate", "challenge-2020", ID, *limit(seconds), "--out", str(out), *more]
    return subprocess.Popen(
        [sys.executable, "-c", code, *argv],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip


def finished(running: subprocess.Popen[str], timeout: float = AT_MOST) -> Answer:
    out, err = running.communicate(timeout=timeout)
    assert "Traceback" not in out + err
    return Answer(running.returncode, out, err)
