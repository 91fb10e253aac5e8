"""The same logic drives the same way, bit by bit: here, in another Python, in another language."""

from __future__ import annotations

import shutil
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from crowdbot.core.planning.choice import PlannerPlace
from crowdbot.core.planning.host import PlannerHost
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.sim.simulate import simulate
from crowdbot.plugin import RobotBody
from tests.core.planning.process.process_cases import LIMITS, REGISTRY, TASK, observation
from tests.core.planning.process.test_foreign import BARE, EXAMPLES

OTHER = {
    "bare Python": "bare.yaml",
    "Python with numpy": "full.yaml",
    "C": "goal_seek.yaml",
}
#: goal_seek once more, and scans that slow it down where the planner has any.
FILE = """
import math

class Mine:
    def reset(self, task, limits, sensors, seed):
        self.limits, self.reach = limits, task.robot.front if task.robot else 0.0

    def step(self, obs):
        dx, dy = obs.goal[0] - obs.pose.x, obs.goal[1] - obs.pose.y
        turn = math.remainder(math.atan2(dy, dx) - obs.pose.yaw, 2.0 * math.pi)
        scans = [r.values for n, r in obs.readings.items() if n.endswith("lidar")]
        near = min(float(min(scan)) for scan in scans) - self.reach if scans else 1.0
        return min(self.limits.v_max, 0.5 * max(near, 0.0)), 0.7 * turn
"""


@cache
def drive(planner: str, in_process: bool | None, folder: Path) -> str:
    """The trajectory's hash of a run of the demo's scenario."""
    suite = open_spec("challenge-2020", REGISTRY, ["robots.robot.task.time_limit=0.5 s"])
    world = pick(suite, "in-d0125-slow-c01-r02")
    run = simulate(
        world, REGISTRY, planner=planner, out=folder,
        options=RunOptions(
            references=False, metrics=(), replay=False, force=True,
            place=PlannerPlace(in_process=in_process),
        ),
    )  # fmt: skip
    assert run.status == "timeout", run.record.reason
    return run.record.hashes.trajectory


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("planners")
    (made / "bare_python").write_text(BARE)
    (made / "bare_python").chmod(0o755)
    (made / "mine.py").write_text(FILE)
    (made / "bare.yaml").write_text("python: ./bare_python\nplanner: mine.py:Mine\n")
    (made / "full.yaml").write_text(f"python: {sys.executable}\nplanner: mine.py:Mine\n")
    for file in EXAMPLES.glob("goal_seek.*"):
        shutil.copy(file, made)
    if compiler := shutil.which("cc"):
        subprocess.run(
            [compiler, "-O2", "-o", "goal_seek", "goal_seek.c", "-lm"], cwd=made, check=True
        )
    return made


@pytest.mark.slow
@pytest.mark.parametrize("other", OTHER)
def test_another_language_drives_the_same_way(other: str, folder: Path) -> None:
    if other == "C" and not (folder / "goal_seek").exists():
        pytest.skip("needs a C compiler")
    same = "goal_seek" if other == "C" else f"{folder}/mine.py:Mine"
    assert drive(str(folder / OTHER[other]), None, folder) == drive(same, True, folder)


@pytest.mark.parametrize("outline", [None, [[-0.2, 0.0], [0.3, 0.0]]])
def test_every_planner_is_told_of_the_robot(
    outline: list[list[float]] | None, tmp_path: Path
) -> None:
    footprint = None if outline is None else np.array(outline)
    body = RobotBody(
        drive="holonomic", radius=0.2, footprint=footprint, front=0.5, back=0.4, half_width=0.2
    )
    (tmp_path / "mine.py").write_text(
        "class Mine:\n"
        "    def reset(self, task, limits, sensors, seed): self.body = task.robot\n"
        "    def step(self, obs):\n"
        "        body = self.body\n"
        "        numbers = (body.radius, body.front, body.back, body.half_width)\n"
        "        outline = body.footprint\n"
        "        assert body.drive == 'holonomic' and numbers == (0.2, 0.5, 0.4, 0.2)\n"
        "        return 0.1, -1.0 if outline is None else float(outline[1][0])\n"
    )
    (tmp_path / "bare_python").write_text(BARE)
    (tmp_path / "bare_python").chmod(0o755)
    (tmp_path / "bare.yaml").write_text("python: ./bare_python\nplanner: mine.py:Mine\n")
    for planner in (f"{tmp_path}/mine.py:Mine", str(tmp_path / "bare.yaml")):
        made = resolve_planner(planner, REGISTRY).build()
        host = PlannerHost(made, "Mine", LIMITS, copies=False)
        host.reset(replace(TASK, robot=body), {}, 7)
        assert host.step(observation()).command == (0.1, -1.0 if outline is None else 0.3, 0.0)
        made.close()  # type: ignore[attr-defined]
