"""A watcher is shown what planners draw, placed in the world like in the replay."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crowdbot.core.recording.messages as ros
from crowdbot.core.recording.drawings import drawing_in_world, drawn_lines, text_markers
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.text_lines import text_lines
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.sim.simulate import simulate
from crowdbot.core.types.arrays import Array
from tests.core.sim.sim_worlds import alone, registry


class Drawing:
    """Drives a bend and draws the person that it knows of, and a path."""

    needs = ()

    def reset(self, task: Any, limits: Any, sensors: Any, seed: int) -> None:
        del task, limits, sensors, seed

    def step(self, obs: Any) -> tuple[float, float]:
        obs.draw("tracks", [[7, 2.0, 1.0, 0.5, -0.25]])
        obs.draw("plan", [[0.0, 0.0], [1.0, 0.0], [2.0, 0.5]])
        obs.draw("why", [[0.5, 0.0]], text="passes")
        return 0.4, 0.5


class Watcher:
    def __init__(self) -> None:
        self.poses: dict[float, Sequence[float]] = {}
        self.seen: list[tuple[float, str, str, Array]] = []
        self.texts: list[tuple[str, ...]] = []

    def begin(self, shared: RecordingHeader, robots: Mapping[str, RecordingHeader]) -> None:
        assert list(robots) == ["robot"]
        del shared

    def sample(self, t: float, robots: Mapping[str, Sequence[float]], agents: Array | None) -> None:
        del agents
        self.poses[t] = robots["robot"][:3]

    def drawing(
        self,
        t: float,
        robot: str,
        name: str,
        columns: Array,
        texts: Sequence[str] | None = None,
    ) -> None:
        self.seen.append((t, robot, name, columns))
        if texts is not None:
            self.texts.append((name, *texts))


def test_what_a_planner_draws_is_shown_while_it_drives(tmp_path: Path) -> None:
    watcher = Watcher()
    run = simulate(
        alone("robots.robot.task.time_limit=1"), registry(), planner=Drawing, out=tmp_path,
        options=RunOptions(references=False, replay=False, record="all"), watchers=[watcher],
    )  # fmt: skip
    recorded = Recording(run.directory / "run.mcap").drawings()
    times = {name: [one.t for one in drawn] for name, drawn in recorded.items()}
    for name, columns in (("tracks", 4), ("plan", 2)):
        shown = [one for one in watcher.seen if one[2] == name]
        assert {one[1] for one in shown} == {"robot"}
        assert [t for t, *_ in shown] == pytest.approx(times[name][-len(shown) :])
        assert len(shown) >= 15  # all but the first, before the robot's first sample
        assert all(one[3].shape[0] == columns for one in shown)
    assert set(watcher.texts) == {("why", "passes")}
    t, _, _, last = next(one for one in reversed(watcher.seen) if one[2] == "tracks")
    before = max(stamp for stamp in watcher.poses if stamp <= t)
    x, y, yaw = watcher.poses[before]
    way = np.hypot(last[0, 0] - x, last[1, 0] - y)
    assert way == pytest.approx(np.hypot(2.0, 1.0), abs=0.05)
    assert yaw > 0.2


def test_rows_turn_with_the_robot() -> None:
    tracks = drawing_in_world(1.0, 2.0, np.pi / 2, [[3, 1.0, 0.0, 0.5, 0.0]], tracks=True)
    assert tracks.ravel() == pytest.approx([1.0, 3.0, 0.0, 0.5])
    start, end = drawn_lines(tracks)
    assert start.ravel() == pytest.approx([1.0, 3.0])
    assert end.ravel() == pytest.approx([1.0, 3.5])
    path = drawing_in_world(0.0, 0.0, 0.0, [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]], tracks=False)
    assert drawn_lines(path)[1].tolist() == [[1.0, 0.0], [1.0, 2.0]]
    assert drawn_lines(path[:, :1]).shape == (2, 0, 2)
    assert drawn_lines(path[:, :0]).shape == (2, 0, 2)


def test_points_and_arrows_have_lines_of_their_own() -> None:
    rows = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]]
    columns = drawing_in_world(0.0, 0.0, 0.0, rows, tracks=False)
    points = drawn_lines(columns, "points/near")
    np.testing.assert_allclose(points.mean(axis=0), rows)
    np.testing.assert_allclose(np.ptp(points, axis=0), [[0.1, 0.0]] * 3)
    assert drawn_lines(columns, "arrows").tolist() == [[[0.0, 0.0]], [[1.0, 0.0]]]
    assert drawn_lines(columns[:, :0], "arrows").shape == (2, 0, 2)
    assert drawn_lines(columns[:, :0], "points").shape == (2, 0, 2)


def test_texts_are_markers_that_face_the_reader() -> None:
    data = text_markers(2, "why", np.array([[1.0, 3.0], [2.0, 4.0]]), ["", "waits"])
    (entries,) = [ros.from_cdr(one, "visualization_msgs/msg/Marker") for one in data]
    assert (entries.type, entries.ns, entries.id, entries.text) == (
        entries.TEXT_VIEW_FACING,
        "why",
        1,
        "waits",
    )
    assert (entries.pose.position.x, entries.pose.position.y) == (3.0, 4.0)
    assert entries.scale.z > 0.1
    assert entries.lifetime.nanosec > 0


def test_texts_without_letters_are_outlines_around_their_place() -> None:
    start, end = text_lines(np.array([[2.0, 9.0], [1.0, 9.0]]), ["MMM $x$", "\u200d"])
    assert start.shape == end.shape
    assert len(start) > 20
    low, high = start.min(axis=0), start.max(axis=0)
    assert (low + high) / 2 == pytest.approx([2.0, 1.0])
    assert high[1] - low[1] > 3 * (high[0] - low[0])  # along y, letters upright along x
    assert text_lines(np.zeros((2, 0)), []).shape == (2, 0, 2)
