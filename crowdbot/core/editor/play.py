"""The first ten seconds of an edited scenario, simulated in a separate process."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from crowdbot.core.recording.recording import Recording
from crowdbot.core.runs.run_directory import RECORDING
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

#: Simulated time, s, and longest wait for it, which compiles kernels the first time, s.
SECONDS, _PATIENCE = 10.0, 300.0
#: Frames in a second of what is played.
_RATE = 8.0


def play(text: str, file: Path, robots: list[str]) -> dict[str, Any]:
    """Return the times (s) and the positions of people and robots, from simulating a document.

    Args:
        text: the document.
        file: its file, beside which `extends` and tables lie.
        robots: names of its robots.

    Raises:
        InputError: the simulation failed; the message has the last lines of its output.
    """
    aside = file.with_name(f".{file.stem}.{os.getpid()}.play.yaml")
    with tempfile.TemporaryDirectory(prefix="crowdbot-edit-") as folder:
        try:
            aside.write_text(text, encoding="utf-8")
            done = subprocess.run(
                _command(aside, Path(folder), robots), capture_output=True, text=True,
                timeout=_PATIENCE, check=False,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            raise InputError(
                f"the simulation took more than {_PATIENCE:g} s and was ended; play fewer people "
                "or a shorter time"
            ) from None
        finally:
            aside.unlink(missing_ok=True)
        recordings = sorted(Path(folder).rglob(RECORDING))
        if not recordings:
            raise InputError("\n".join(done.stderr.strip().splitlines()[-4:]) or "nothing was run")
        return _frames(recordings[0], robots)


def _command(file: Path, out: Path, robots: list[str]) -> list[str]:
    words = [sys.executable, "-m", "crowdbot", "simulate", str(file), "--out", str(out),
             "--no-references"]  # fmt: skip
    if not robots:
        return [*words, "--duration", f"{SECONDS:g}"]
    for name in robots:
        words += ["--set", f"robots.{name}.task.time_limit={SECONDS:g}"]
    return [*words, "--planner", "dwa"] if len(robots) == 1 else [
        *words, *(word for name in robots for word in ("--planner", f"{name}=dwa"))
    ]  # fmt: skip


def _frames(recording: Path, robots: list[str]) -> dict[str, Any]:
    with Recording(recording) as opened:
        runs = {name: opened.trajectories(name if len(robots) > 1 else None) for name in robots}
        run = next(iter(runs.values()), None) or opened.trajectories()
    times = np.arange(0.0, min(SECONDS, float(run.t[-1])) + 1e-9, 1.0 / _RATE)
    rows = np.clip(np.searchsorted(run.t, times - 1e-9), 0, len(run.t) - 1)
    agents = run.agents
    people = [] if agents is None else _places(agents.x[rows], agents.y[rows])
    return {
        "t": np.round(run.t[rows], 3).tolist(),
        "people": [[None if p[0] != p[0] else p for p in frame] for frame in people],
        "radius": [] if agents is None else np.round(agents.radius, 3).tolist(),
        "robots": {
            name: _places(one.robot.x[rows], one.robot.y[rows])
            for name, one in runs.items()
            if one.robot is not None
        },
    }


def _places(x: Array, y: Array) -> list[Any]:
    places: list[Any] = np.round(np.stack([x, y], axis=-1), 3).tolist()
    return places
