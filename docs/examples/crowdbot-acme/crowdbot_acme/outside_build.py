"""Outside: the planner that hands every question on to a process."""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from crowdbot.plugin import (
    Command,
    NoValidCommand,
    Observation,
    RobotLimits,
    SensorInfo,
    Task,
)

from crowdbot_acme.json_process import JsonProcess
from crowdbot_acme.outside import OutsideSpec

_OWN = (sys.executable, "-I", str(Path(__file__).parent / "outside_child.py"))


class Outside:
    """One process a run; it is ended when the next run begins or the planner is let go."""

    def __init__(self, spec: OutsideSpec) -> None:
        self._spec = spec
        self._process: JsonProcess | None = None

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Start a process and tell it what it is asked to do.

        Raises:
            OSError: the program cannot be started.
            ProcessError: it does not answer.
        """
        if self._process is not None:
            self._process.close()
        self._process = JsonProcess(self._spec.command or _OWN)
        self._ask(
            {
                "reset": {
                    "goal": task.goal,
                    "limits": {"v_max": limits.v_max, "v_min": limits.v_min, "w_max": limits.w_max},
                    "sensors": {name: {"category": i.category} for name, i in sensors.items()},
                    "seed": seed,
                }
            },
            self._spec.start_time,
        )

    def step(self, obs: Observation) -> Command:
        """Return the answer of the process.

        Raises:
            NoValidCommand: it says that it knows none.
            ProcessError: it died, answered nonsense, or not within the budget.
        """
        answer = self._ask(
            {
                "step": {
                    "t": obs.t,
                    "pose": obs.pose,
                    "twist": obs.twist,
                    "goal": obs.goal,
                    "nearest": {n: _nearest(r.values.tolist()) for n, r in obs.readings.items()},
                }
            },
            self._spec.budget,
        )
        if answer.get("stop"):
            raise NoValidCommand(str(answer["stop"]))
        return Command(answer.get("v", math.nan), answer.get("w", math.nan), answer.get("vy", 0.0))

    def _ask(self, message: Mapping[str, Any], patience: float) -> dict[str, Any]:
        assert self._process is not None
        return self._process.ask(message, patience)


def _nearest(values: list[float]) -> float | None:
    """The nearest return, m; JSON has no infinity."""
    nearest = min(values, default=math.inf)
    return nearest if math.isfinite(nearest) else None


def build(spec: OutsideSpec) -> Outside:
    """A planner from its spec; the process starts with the run."""
    return Outside(spec)
