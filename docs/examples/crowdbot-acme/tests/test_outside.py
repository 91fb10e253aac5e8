"""The planner in its own process: what it does when the other side does not play along."""

from __future__ import annotations

import gc
import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from crowdbot.plugin import NoValidCommand, Observation, Pose, RobotLimits, Task

from crowdbot_acme.json_process import ProcessError
from crowdbot_acme.outside import OutsideSpec
from crowdbot_acme.outside_build import Outside, build

ZONE = np.array([[4.0, -1.0], [6.0, -1.0], [6.0, 1.0], [4.0, 1.0]])
TASK = Task(start=Pose(0.0, 0.0, 0.0), goal=(5.0, 0.0), goal_zone=ZONE, time_limit=10.0)
LIMITS = RobotLimits(v_min=-1.0, v_max=1.0, w_max=2.0, a_max=1.0, alpha_max=2.0)
SEEN = Observation(t=0.0, pose=TASK.start, twist=(0.0, 0.0), goal=TASK.goal, goal_zone=ZONE)


def planner(tmp_path: Path, *answers: str, budget: float = 5.0) -> Outside:
    """A planner whose process runs these statements, one for each line that it reads."""
    script = tmp_path / "other.py"
    lines = ["import sys, time, os", *(f"sys.stdin.readline(); {a}" for a in answers)]
    script.write_text("\n".join(lines), encoding="utf-8")
    made = build(OutsideSpec(command=(sys.executable, str(script)), budget=budget))
    made.reset(TASK, LIMITS, {}, 1)
    return made


def pid_of(made: Outside) -> int:
    assert made._process is not None
    return made._process.pid


def is_there(pid: int) -> bool:
    """Return True if a process exists; a zombie does."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.fixture
def own() -> Iterator[Outside]:
    made = build(OutsideSpec())
    made.reset(TASK, LIMITS, {}, 1)
    yield made
    del made


READY = 'print("{}", flush=True)'


def test_its_own_program_drives_to_the_goal(own: Outside) -> None:
    v, w, vy = own.step(SEEN)
    assert (v, w, vy) == (1.0, 0.0, 0.0)


def test_a_process_that_dies(tmp_path: Path) -> None:
    made = planner(tmp_path, READY, "sys.exit(3)")
    with pytest.raises(ProcessError, match="ended with status 3"):
        made.step(SEEN)


def test_a_process_that_is_late(tmp_path: Path) -> None:
    made = planner(tmp_path, READY, "time.sleep(60)", budget=0.2)
    pid, begin = pid_of(made), time.monotonic()
    with pytest.raises(ProcessError, match=r"did not answer within 0\.2 s"):
        made.step(SEEN)
    assert time.monotonic() - begin < 10.0
    assert not is_there(pid)


def test_a_process_that_talks_nonsense(tmp_path: Path) -> None:
    made = planner(tmp_path, READY, 'print("forward!", flush=True)')
    with pytest.raises(ProcessError, match="is not a JSON object"):
        made.step(SEEN)


def test_a_process_that_knows_no_command(tmp_path: Path) -> None:
    made = planner(tmp_path, READY, """print('{"stop": "lost"}', flush=True)""")
    with pytest.raises(NoValidCommand, match="lost"):
        made.step(SEEN)


def test_a_program_that_is_not_there() -> None:
    made = build(OutsideSpec(command=("/nowhere/at/all",)))
    with pytest.raises(FileNotFoundError):
        made.reset(TASK, LIMITS, {}, 1)


def test_no_process_is_left(tmp_path: Path) -> None:
    made = planner(tmp_path, READY, "time.sleep(60)")
    first = pid_of(made)
    made._spec = OutsideSpec()
    made.reset(TASK, LIMITS, {}, 2)
    assert not is_there(first), "the process of the run before goes on"
    second = pid_of(made)
    assert is_there(second)
    del made
    gc.collect()
    assert not is_there(second), "the process of the last run goes on"
