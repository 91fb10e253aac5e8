"""The view in the browser: what it draws, and where."""

from __future__ import annotations

import struct
from typing import Any, cast

import numpy as np
import pytest

from crowdbot.core.recording.header import AgentsHeader, RecordingHeader, RobotHeader
from crowdbot.core.sim.meshcat_view import MeshcatView
from crowdbot.errors import InputError

WALLS = np.array([[0.0, -2.0, 10.0, -2.0], [0.0, 2.0, 0.0, 5.0]])
GOAL = np.array([[8.0, -1.0], [9.0, -1.0], [9.0, 1.0], [8.0, 1.0]])


@pytest.fixture(scope="module")
def view() -> MeshcatView:
    return MeshcatView()


def _header(people: int = 2) -> RecordingHeader:
    about = AgentsHeader(
        id=np.arange(people), radius=np.full(people, 0.3), mass=np.full(people, 75.0)
    )
    robot = RobotHeader(radius=0.2, mass=6.0)
    return RecordingHeader(scenario="x", robot=robot, agents=about, walls=WALLS, goal_zone=GOAL)


def _begin(view: MeshcatView, *robots: str, people: int = 2) -> None:
    """A run of one robot, or of several."""
    header = _header(people)
    view.begin(header, dict.fromkeys(robots or ("robot",), header))


def _pose(view: MeshcatView, path: str) -> tuple[list[float], float]:
    """Place (m) and yaw (rad) of a path, out of the message that the browser gets."""
    packed = cast(Any, view)._meshcat._GetPackedTransform(path)
    start = packed.index(b"matrix") + len("matrix") + 3  # an array of 16 numbers of 9 bytes
    rows = [struct.unpack_from(">d", packed, start + 9 * k + 1)[0] for k in range(16)]
    return rows[12:15], float(np.arctan2(rows[1], rows[0]))


def _has(view: MeshcatView, path: str) -> bool:
    return bool(cast(Any, view)._meshcat.HasPath(path))


def _hidden(view: MeshcatView, path: str) -> bool:
    packed = cast(Any, view)._meshcat._GetPackedProperty(path, "visible")
    return bool(packed) and packed.endswith(b"\xc2")


def test_what_stands_still_is_drawn_where_it_is(view: MeshcatView) -> None:
    _begin(view)
    paths = (
        "goals/robot",
        "robots/robot/body",
        "robots/robot/front",
        "people/0/body",
        "people/1/body",
    )
    assert all(_has(view, f"crowdbot/{path}") for path in paths)
    assert _pose(view, "crowdbot/walls/0") == ([5.0, -2.0, 0.5], 0.0)
    place, yaw = _pose(view, "crowdbot/walls/1")
    assert place == [0.0, 3.5, 0.5]
    assert yaw == pytest.approx(0.5 * np.pi)


def test_everybody_is_moved_and_who_is_absent_is_hidden(view: MeshcatView) -> None:
    _begin(view)
    nan = np.nan
    view.sample(
        1.0,
        {"robot": (1.0, 0.5, 0.3, 0.0, 0.0)},
        np.array([[2.0, nan], [1.0, nan], [0, nan], [1, nan]]),
    )
    place, yaw = _pose(view, "crowdbot/robots/robot")
    assert place == [1.0, 0.5, 0.0]
    assert yaw == pytest.approx(0.3)
    place, yaw = _pose(view, "crowdbot/people/0")
    assert place == [2.0, 1.0, 0.0]
    assert yaw == pytest.approx(0.5 * np.pi)
    assert _hidden(view, "crowdbot/people/1")
    view.sample(2.0, {}, np.array([[2.0, 3.0], [1.0, 4.0], [0, -1], [1, 0]]))
    assert not _hidden(view, "crowdbot/people/1")
    assert _pose(view, "crowdbot/people/1")[0] == [3.0, 4.0, 0.0]


def test_several_robots_are_moved_and_one_that_has_left_is_hidden(view: MeshcatView) -> None:
    _begin(view, "a", "b")
    rows = {"a": (1.0, 0.5, 0.3, 0.0, 0.0), "b": (4.0, -0.5, 0.0, 0.0, 0.0)}
    view.sample(1.0, rows, None)
    assert _has(view, "crowdbot/goals/b")
    assert [_pose(view, f"crowdbot/robots/{name}")[0][0] for name in rows] == [1.0, 4.0]
    view.sample(2.0, {"b": rows["b"]}, None)
    assert _hidden(view, "crowdbot/robots/a")
    assert not _hidden(view, "crowdbot/robots/b")


def test_the_next_run_takes_the_place_of_the_last_one(view: MeshcatView) -> None:
    _begin(view, people=3)
    assert _has(view, "crowdbot/people/2")
    _begin(view, people=1)
    assert _has(view, "crowdbot/people/0")
    assert not _has(view, "crowdbot/people/2")


def test_a_run_without_robot_or_people_is_drawn(view: MeshcatView) -> None:
    view.begin(RecordingHeader(scenario="x"), {})
    view.sample(0.0, {}, None)
    assert not _has(view, "crowdbot/robots")


def test_the_scene_is_one_page(view: MeshcatView) -> None:
    _begin(view)
    assert view.page().lstrip().startswith("<!DOCTYPE html>")
    assert view.url.startswith("http://localhost:")


def test_a_port_that_cannot_be_had_is_told(view: MeshcatView) -> None:
    taken = int(view.url.rpartition(":")[2])
    with pytest.raises(InputError, match=f"--meshcat {taken}: that port cannot be had"):
        MeshcatView(taken)


def test_what_a_planner_draws_lies_on_the_floor(view: MeshcatView) -> None:
    _begin(view)
    path = np.array([[0.0, 1.0, 2.0], [0.0, 0.0, 1.0]])
    view.drawing(1.0, "robot", "plan", path)
    assert _has(view, "crowdbot/thoughts/robot/plan")
    view.drawing(1.1, "robot", "plan", path[:, :0])
    assert not _has(view, "crowdbot/thoughts/robot/plan")
    view.drawing(1.2, "robot", "why", path[:, :1], ["waits"])
    assert _has(view, "crowdbot/thoughts/robot/why")
    view.drawing(1.3, "robot", "why", path[:, :1], [""])
    assert not _has(view, "crowdbot/thoughts/robot/why")
