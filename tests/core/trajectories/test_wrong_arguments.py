"""What recordings are told beside their tables: what is of another kind is our own error."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.core.trajectories.commands import Commands
from crowdbot.core.trajectories.questionnaires import Questionnaires
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import CrowdbotError, InputError

ROWS = {"t": [0.0, 0.1, 0.2], "x": [0.0, 0.1, 0.2], "y": [0.0, 0.0, 0.0]}
ONE = {"t": [0.0, 0.1], "v_user": [0, 0], "w_user": [0, 0], "v_sc": [0, 0], "w_sc": [0, 0]}
ZONE = [[0, 0], [1, 0], [1, 1]]

WRONG: list[tuple[dict[str, Any], str]] = [
    ({"robot_radius": "a"}, "robot_radius must be a number in m, not a str"),
    ({"robot_mass": math.nan}, "robot_mass must be a number in kg, not nan"),
    ({"columns": 3}, "columns must be a mapping"),
    ({"columns": {"robot": {"x": 5}}}, "a column's name must be a str, not an int"),
    ({"resample": 1e12}, "more than 1e+08"),
    ({"resample": [1]}, "resample must be a number in Hz, not a list"),
    ({"clock_offset": "a"}, "clock_offset must be a number in s"),
    ({"max_gap": None}, "max_gap must be a number in s, not None"),
    ({"frame_rate": "a"}, "frame_rate must be a number"),
    ({"robot_goal": 3}, "robot_goal must be (x, y), two numbers in m, not 3"),
    ({"robot_goal": (1, 2, 3)}, "robot_goal must be (x, y)"),
    ({"robot_goal": "ab"}, "robot_goal must be (x, y)"),
    ({"robot_goal": (math.nan, 0)}, "robot_goal must be (x, y)"),
    ({"robot_goal": (1, 1), "robot_goal_radius": "a"}, "robot_goal_radius must be a number"),
    ({"robot_goal": (1, 1), "robot_goal_radius": -1}, "robot_goal_radius must be finite and not"),
    ({"robot_goal_time": math.nan}, "robot_goal_time must be a number in s, not nan"),
    ({"goal_zone": "x"}, "goal_zone must be (K, 2) corners"),
    ({"goal_zone": [1, 2, 3]}, "goal_zone must be (K, 2) corners"),
    ({"signals": 4}, "signals must be a mapping"),
    ({"signals": {"a": [1]}}, "signal 'a' has shape (1,), expected (P, 2)"),
    ({"agent_radius": "a"}, "agent_radius must be a number in m"),
    ({"robot_speed_limit": "a"}, "robot_speed_limit must be a number in m/s"),
]


@pytest.mark.parametrize(("arguments", "message"), WRONG, ids=[m for _, m in WRONG])
def test_what_tables_are_told(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        Trajectories.from_pandas(ROWS, **{"robot_radius": 0.2, "robot_mass": 6.0, **arguments})


def test_numbers_of_numpy_are_numbers() -> None:
    run = Trajectories.from_pandas(
        ROWS,
        robot_radius=np.float32(0.25),  # type: ignore[arg-type]
        robot_mass=np.int64(6),  # type: ignore[arg-type]
        robot_goal=np.array([0.2, 0.0]),  # type: ignore[arg-type]
        resample=np.float64(20.0),
        goal_zone=np.array(ZONE),
    )
    assert run.robot is not None
    assert (run.robot.radius, run.robot.mass, run.robot.goal) == (0.25, 6.0, (0.2, 0.0))


def test_times_are_durations() -> None:
    t = np.array([0, 100, 200], dtype="timedelta64[ms]")
    run = Trajectories.from_pandas({**ROWS, "t": t}, robot_radius=0.2, robot_mass=6.0)
    assert run.t.tolist() == [0.0, 0.1, 0.2]


@pytest.mark.parametrize("name", ["from_csv", "from_rosbag", "from_trajnet", "from_mcap"])
def test_what_is_no_path(name: str, tmp_path: Path) -> None:
    for wrong in (3, b"x", "a\0b", tmp_path):
        with pytest.raises(CrowdbotError, match=r"path|folder|director|read|bag|topic"):
            getattr(Trajectories, name)(wrong)


def test_complex_positions_are_no_positions() -> None:
    with pytest.raises(InputError, match="complex"):
        Trajectories.from_arrays(t=[0.0, 1.0], agent_x=np.array([[1j], [0]]), agent_y=[[0], [0]],
                                 agent_radius=0.3, agent_mass=70)  # fmt: skip


def test_limits_of_commands_are_numbers() -> None:
    with pytest.raises(InputError, match="v_max must be a number"):
        Commands.from_arrays(**ONE, v_max="a", w_max=1)  # type: ignore[arg-type]
    for wrong in (None, 3):
        with pytest.raises(InputError, match="path must be a path"):
            Commands.from_csv(wrong, v_max=1, w_max=1)  # type: ignore[arg-type]
        with pytest.raises(InputError, match="path must be a path"):
            Questionnaires.from_csv(wrong)  # type: ignore[arg-type]
