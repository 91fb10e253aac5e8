"""Planners in files, run in a process of their own without a simulator."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.core.planning.choice import ANYWHERE, PlannerPlace
from crowdbot.core.planning.containment.offer import kernel_offer
from crowdbot.core.planning.host import PlannerHost
from crowdbot.core.planning.process.process_planner import ProcessPlanner
from crowdbot.core.planning.process.server_handle import POOL
from crowdbot.core.planning.resolve import PlannerChoice, resolve_planner
from crowdbot.core.registry.registry import discover
from crowdbot.plugin import Observation, Pose, Reading, RobotLimits, SensorInfo, Task
from tests.waiting import wait_until

LIMITS = RobotLimits(v_min=-0.2, v_max=0.65, w_max=3.14, a_max=1.0, alpha_max=2.0)
ZONE = np.array([[45.0, -5.0], [50.0, -5.0], [50.0, 5.0], [45.0, 5.0]])
TASK = Task(start=Pose(2.5, 0, 0), goal=(47.5, 0.0), goal_zone=ZONE, time_limit=180.0)
FRONT = SensorInfo(
    category="lidar", frame="front", mount=(0.2, 0.0, 0.1, 0.0), rate=16.0, shape=(480,),
    ros_type="sensor_msgs/msg/LaserScan", angles=np.linspace(-2.0, 2.0, 480), range_max=8.0,
)  # fmt: skip
REGISTRY = discover(allow=())


def planner_text(step: str = "return (0.3, 0.1)", **more: str) -> str:
    """A file with a planner; ``top``, ``init``, ``reset`` are lines of Python."""
    body = {"top": "pass", "init": "pass", "reset": "pass", **more}
    return (
        "import ctypes, os, signal, subprocess, sys, threading, time\n"
        f"{body['top']}\n"
        "class Mine:\n"
        f"    def __init__(self): {body['init']}\n"
        f"    def reset(self, task, limits, sensors, seed): {body['reset']}\n"
        f"    def step(self, obs):\n        {step}\n"
    )


def choose(folder: Path, text: str, place: PlannerPlace = ANYWHERE) -> PlannerChoice:
    """The planner ``Mine`` of a file with this text."""
    file = folder / "mine.py"
    file.write_text(text, encoding="utf-8")
    return resolve_planner(f"{file}:Mine", REGISTRY, place=place)


def observation(t: float = 0.0, **readings: Any) -> Observation:
    """One with scans by name."""
    return Observation(
        t=t, pose=Pose(1.0, 2.0, 3.0), twist=(0.5, -0.25), goal=TASK.goal, goal_zone=ZONE,
        readings={n: Reading(t, values) for n, values in readings.items()},
    )  # fmt: skip


@contextmanager
def hosted(choice: PlannerChoice, **sensors: SensorInfo) -> Iterator[PlannerHost]:
    """A host of the planner, reset; its process is ended afterwards."""
    planner = choice.build()
    assert isinstance(planner, ProcessPlanner)
    try:
        host = PlannerHost(planner, choice.name, LIMITS, origin=choice.origin)
        host.reset(TASK, sensors, 7)
        yield host
    finally:
        planner.close()


def is_alive(pid: int) -> bool:
    """Whether there is such a process, other than one that only waits to be reaped."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def below(pid: int) -> list[int]:
    """All descendants of a process."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            fields = (folder / "stat").read_text(errors="replace").rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[1]) == pid and fields[0] != "Z":
            found += [int(folder.name), *below(int(folder.name))]
    return found


def left(name: str) -> Path:
    """A file that a running planner wrote into its home, the only folder that it may write to."""
    pattern = f"crowdbot-planner-*/*/{name}"
    wait_until(lambda: any(f.read_text() for f in Path(tempfile.gettempdir()).glob(pattern)))
    return next(Path(tempfile.gettempdir()).glob(pattern))


@contextmanager
def older_kernel(monkeypatch: pytest.MonkeyPatch, landlock: int = 0) -> Iterator[None]:
    """One whose Landlock is older; 0: one that contains nothing."""
    POOL.close()
    monkeypatch.setenv("CROWDBOT_LANDLOCK", str(landlock))
    kernel_offer.cache_clear()
    try:
        yield
    finally:
        monkeypatch.delenv("CROWDBOT_LANDLOCK")
        kernel_offer.cache_clear()
        POOL.close()


def descriptors() -> int:
    """How many this process has open."""
    return len(list(Path("/proc/self/fd").iterdir()))
