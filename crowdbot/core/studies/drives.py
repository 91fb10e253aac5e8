"""Drives of a study: their commands and run directories."""

from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
import threading
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from crowdbot.core.registry.registry import Registry
from crowdbot.core.studies.document import StudyCondition, planner_text
from crowdbot.core.studies.progress import StudyProgress
from crowdbot.core.studies.steps import Step
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.errors import InputError

_URL = re.compile(r"http://(?:127\.0\.0\.1|localhost|\[::1\]):\d+/\S*")
#: The last lines of a drive's messages that are kept.
_KEPT = 20


def drive_words(
    progress: StudyProgress, step: Step, registry: Registry, *, synthetic: bool
) -> list[str]:
    """Return the arguments, after ``crowdbot``, of the command for a trial's drive.

    Args:
        synthetic: True: a synthetic user drives; False: a person does, in the page of teleop.

    Raises:
        InputError: the planner is wrong, or cannot be written.
    """
    assert step.trial is not None
    study = progress.study
    words = [
        "simulate" if synthetic else "teleop",
        study.beside(step.trial.suite),
        step.trial.scenario,
        "--planner",
        _planner(progress, step, registry),
        "--seed",
        str(seed_of(progress, step)),
        "--out",
        str(root_of(progress, step).resolve()),
        "--json",
    ]
    if synthetic and study.spec.synthetic:
        number = study.spec.people.index(progress.participant)
        user = study.spec.synthetic[number % len(study.spec.synthetic)]
        words += ["--set", f"robots.robot.sensors.joystick={json.dumps(user)}"]
    return words


def root_of(progress: StudyProgress, step: Step) -> Path:
    """Return the root of the run directories of a step: one for each condition."""
    return progress.runs / step.condition


def seed_of(progress: StudyProgress, step: Step) -> int:
    """Return the seed of a drive: it depends on participant and trial, not on the condition."""
    spec = progress.study.spec
    number = spec.people.index(progress.participant)
    return (spec.seed + (1 + len(spec.trials)) * number + step.index) % 2**31


def shown_command(words: Sequence[str]) -> str:
    """Return a command as it is typed."""
    return shlex.join(["crowdbot", *words])


def finished_run(progress: StudyProgress, step: Step) -> Path | None:
    """Return the complete run directory of a step, if there is one."""
    found = root_of(progress, step).glob(f"**/seed-{seed_of(progress, step)}/run.json")
    return next((record.parent for record in sorted(found)), None)


def _planner(progress: StudyProgress, step: Step, registry: Registry) -> str:
    """Return the value of ``--planner``; a document with parameters is written beside the data."""
    condition: StudyCondition = progress.study.spec.conditions[step.condition]
    planner = condition.planner
    if not isinstance(planner, dict) or set(planner) == {"kind"}:
        return planner_text(progress.study, condition, registry)
    path = (progress.folder / "planners" / f"{step.condition}.yaml").resolve()
    atomic_write(path, json.dumps(planner, indent=2) + "\n")
    return str(path)


@dataclass
class Drive:
    """A drive that runs in a separate process.

    Attributes:
        words: of its command.
        url: of its page, once it has printed it; empty before, and of a simulation.
        lines: the last lines of its messages.
    """

    words: Sequence[str]
    url: str = ""
    lines: list[str] = field(default_factory=list)
    _process: subprocess.Popen[str] | None = None
    _reader: threading.Thread | None = None

    def start(self) -> None:
        """Start the process."""
        self._process = subprocess.Popen(
            [sys.executable, "-m", "crowdbot", *self.words],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            encoding="utf-8",
            errors="replace",
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self._process is not None
        assert self._process.stderr is not None
        with self._process.stderr as messages:
            for line in messages:
                found = _URL.search(line)
                if found and not self.url:
                    self.url = found.group()
                self.lines = [*self.lines, line.rstrip()][-_KEPT:]

    def ended(self) -> int | None:
        """Return the process's exit code; None while it runs."""
        return None if self._process is None else self._process.poll()

    def wait(self) -> None:
        """Wait for the process's end.

        Raises:
            InputError: it failed; with its last words.
        """
        assert self._process is not None
        assert self._reader is not None
        code = self._process.wait()
        self._reader.join()
        if code not in (0, 3):  # 3: the planner failed, which is a result
            raise InputError(self.problem(code))

    def problem(self, code: int) -> str:
        """Return why it failed, with its last line of output."""
        text = "\n".join(self.lines[-5:])
        return f"{shown_command(self.words)}: exit code {code}\n{text}".rstrip()

    def stop(self) -> None:
        """End the process, if it runs."""
        if self._process is not None and self._process.poll() is None:
            self._process.terminate()
            try:
                self._process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                self._process.kill()
