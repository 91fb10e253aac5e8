"""A session is the run that a planner with the same commands would have."""

from __future__ import annotations

import functools
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
from numpy.typing import NDArray

import crowdbot
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.registry.registry import discover
from crowdbot.core.runs.provenance import trajectory_hash
from crowdbot.core.sim.run_thread import Exchange
from crowdbot.core.types.sensor import Pinhole
from tests.waiting import wait_until


@functools.cache
def scenario(seconds: float = 1.0) -> crowdbot.Scenario:
    return crowdbot.load(
        "challenge-2020",
        "counter-d0250-dispersed-c20-r05",
        set={"robots.robot.task.time_limit": seconds},
    )


@pytest.mark.slow
def test_the_same_logic_gives_the_same_trajectory(tmp_path: Path) -> None:
    run = crowdbot.simulate(
        scenario(3.0),
        planner="dwa",
        seed=3,
        references=False,
        metrics="success",
        replay=False,
        out=tmp_path / "runs",
    )
    choice = resolve_planner("dwa", discover())
    planner, steps = choice.build(), 0
    with crowdbot.Session(
        scenario(3.0), seed=3, sensors=choice.needs, recording=tmp_path / "run.mcap"
    ) as session:
        obs = session.reset()
        planner.reset(session.task, session.limits, session.sensors, session.planner_seed)
        while not session.done:
            obs = session.step(planner.step(obs))
            steps += 1
    assert (session.status, session.t, steps) == ("timeout", 3.0, 48)
    assert trajectory_hash(session.trajectories) == run.record.hashes.trajectory
    assert sorted(p.name for p in tmp_path.iterdir()) == ["run.mcap", "runs"]


@pytest.mark.slow
def test_a_session_begins_again_and_writes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    session = crowdbot.Session(scenario(), sensors=["lidar"])
    with pytest.raises(crowdbot.CrowdbotError, match="has not begun"):
        session.observe()
    first = session.reset()
    assert session.observe() is first
    assert (first.t, session.t, session.status, session.done) == (0.0, 0.0, "running", False)
    lidar = next(iter(session.sensors))
    assert [*first.readings] == [*session.sensors]
    second = session.step((0.3, 0.1))
    assert second.t == session.t == 0.0625
    for wrong in ("go", (1.0,), (1.0, float("nan")), (True, 0.0), 3, None):
        with pytest.raises(crowdbot.CrowdbotError, match="a command is"):
            session.step(wrong)  # type: ignore[arg-type]
    assert session.t == 0.0625, "a wrong command moves nothing"
    again = session.reset()
    np.testing.assert_array_equal(again.readings[lidar].values, first.readings[lidar].values)
    assert not np.array_equal(
        session.reset(seed=1).readings[lidar].values, first.readings[lidar].values
    )
    while not session.done:
        last = session.step([0.3, 0.0])
    assert session.observe() is last
    with pytest.raises(crowdbot.CrowdbotError, match="has ended: time limit of 1 s"):
        session.step((0.3, 0.0))
    with pytest.raises(crowdbot.CrowdbotError, match="was not recorded"):
        _ = session.trajectories
    session.close()
    session.close()
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_session_that_is_closed_early_leaves_what_was_recorded(tmp_path: Path) -> None:
    session = crowdbot.Session(
        scenario(), sensors=[], privileged=True, recording=tmp_path / "run.mcap"
    )
    assert session.reset().truth is not None
    with pytest.raises(crowdbot.CrowdbotError, match="has not ended"):
        _ = session.trajectories
    session.step((0.1, 0.0))
    session.close()
    assert (session.status, session.done) == ("interrupted", True)
    assert session.trajectories.robot is not None


def test_what_the_run_raises_is_raised_in_reset(tmp_path: Path) -> None:
    session = crowdbot.Session(scenario(), sensors=[], recording=tmp_path / "no" / "run.mcap")
    with pytest.raises(crowdbot.CrowdbotError, match="cannot be written"):
        session.reset()
    session.close()


@pytest.mark.slow
def test_python_ends_with_a_session_that_nobody_closed() -> None:
    code = """
import crowdbot
scenario = crowdbot.load("challenge-2020", "counter-d0250-dispersed-c20-r05")
session = crowdbot.Session(scenario, sensors=[])
session.reset()
print('begun')
print(session.step((0.1, 0.0)).t)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "begun\n0.0625\n", "")


def test_stdout_is_the_callers_however_fast_the_run_goes_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The run redirects stdout while its planner waits, which may be before the session waits."""
    answer = Exchange.answer

    def slowly(self: Exchange, commands: Any) -> None:
        answer(self, commands)
        wait_until(lambda: sys.stdout is sys.stderr)

    monkeypatch.setattr(Exchange, "answer", slowly)
    mine = sys.stdout
    with crowdbot.Session(scenario(), sensors=[]) as session:
        session.reset()
        session.step((0.1, 0.0))
        assert sys.stdout is mine


class FakeRenderer:
    """Notes in which thread it draws and is closed; needs no EGL."""

    closed_in: ClassVar[list[tuple[str, str]]] = []

    def __init__(self, _scene: Any, camera: Pinhole, *_: Any) -> None:
        self._image = np.zeros((camera.height, camera.width, 3), np.uint8)
        self._drawn_in = "nowhere"

    def __call__(self, *_: Any) -> NDArray[np.uint8]:
        self._drawn_in = threading.current_thread().name
        return self._image

    def close(self) -> None:
        """Note the thread."""
        self.closed_in.append((self._drawn_in, threading.current_thread().name))


@pytest.mark.slow
def test_graphics_are_freed_in_the_thread_that_drew(monkeypatch: pytest.MonkeyPatch) -> None:
    """Otherwise each mesh complains when Python collects the diagram in another thread."""
    monkeypatch.setattr("crowdbot.core.sim.cameras.rendering.Renderer", FakeRenderer)
    monkeypatch.setattr(FakeRenderer, "closed_in", [])
    seen = crowdbot.load(
        "challenge-2020",
        "in-d0125-slow-c01-r02",
        set={"robots.robot.sensors.camera.colour": True},
    )
    session = crowdbot.Session(seen, sensors=["camera"])
    for _ in range(2):
        assert session.reset().readings["camera"].colour is not None
        session.step((0.3, 0.0))
    assert FakeRenderer.closed_in == [("session", "session")], "the first run has ended"
    session.close()
    assert FakeRenderer.closed_in == [("session", "session")] * 2
