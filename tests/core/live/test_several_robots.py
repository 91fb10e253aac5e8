"""A live run of two robots: one connection, without a network."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from crowdbot.api import registry
from crowdbot.core.live.message import LiveMessage, OfferedTopic
from crowdbot.core.live.serve import LiveServe, live_robots, serve_runs
from crowdbot.core.live.session import LiveSession
from crowdbot.core.live.step_policy import StepPolicy
from crowdbot.core.planning.resolve import PlannerChoice
from crowdbot.core.runs.run import Request, Run
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.types.motion import Command
from crowdbot.dsl.scenario.scenario import Scenario
from tests.core.live.live_cases import until
from tests.core.sim.fleets import PEOPLE, robot, scenario

pytestmark = pytest.mark.slow


class Driver:
    """Hears everything, and answers each clock with a command for each of its robots."""

    def __init__(self, session: LiveSession, speeds: dict[str, float]) -> None:
        self._session, self._speeds = session, speeds
        self.opened: list[Sequence[OfferedTopic]] = []
        self.heard: list[LiveMessage] = []

    def open(self, offers: Sequence[OfferedTopic]) -> None:
        self.opened.append(offers)
        for name in self._speeds:
            self._session.drive(self, name)

    def wants(self, topic: str) -> bool:
        return bool(topic)

    def publish(self, messages: Sequence[LiveMessage]) -> None:
        self.heard += messages
        if any(message.topic == "/clock" for message in messages):
            for name, v in self._speeds.items():
                self._session.command(self, Command(v, 0.0), robot=name)

    def close(self) -> None:
        """Nothing to close."""

    def on(self, topic: str) -> list[LiveMessage]:
        return [message for message in self.heard if message.topic == topic]


def _live(
    folder: Path,
    speeds: dict[str, float],
    *,
    b: float = 0.5,
    budget: float = 60.0,
    people: str = "",
) -> tuple[LiveServe, Driver]:
    """A run of a (0.5 s) and b, with a driver for those that have speeds."""
    both = {
        "a": robot(-2.0, 1.0, 0.0, "east", limit=0.5),
        "b": robot(2.0, -1.0, 0.0, "east", limit=b),
    }
    world = scenario(folder, registry(), both, people)
    session = LiveSession(robots=live_robots([world]))
    driver = Driver(session, speeds)

    def request(chosen: Scenario, choice: PlannerChoice, seed: int) -> Request:
        options = RunOptions(references=bool(people), replay=False)
        return Request(
            scenario=chosen, choice=choice, registry=registry(),
            seed=seed, out=folder, options=options,
        )  # fmt: skip

    policy = StepPolicy(budget=budget, wait=0.0)
    live = LiveServe(
        session=session, connections=[driver], policy=policy, scenarios=(world,), request=request
    )
    return live, driver


def _way(run: Run, name: str) -> float:
    found = run.robots[name].robot
    assert found is not None
    return float(found.x[-1] - found.x[0])


def test_a_step_is_published_once_for_all_robots(tmp_path: Path) -> None:
    live, driver = _live(tmp_path, {"a": 0.4, "b": 0.2})
    run = serve_runs(live)
    part = run.record.live
    assert part is not None
    clocks = [m.ns for m in driver.on("/clock")]
    assert part.missed_steps == 0
    assert part.steps == len(clocks) == len(set(clocks)) == len(driver.on("/a/odom"))
    assert _way(run, "a") > _way(run, "b") > 0.0
    (offers,) = driver.opened
    topics = [offer.topic for offer in offers]
    assert len(topics) == len(set(topics))
    assert {m.topic for m in driver.heard} <= set(topics)
    each = {f"/{r}/{t}" for r in "ab" for t in ("scan", "odom", "goal_pose", "crowdbot/task")}
    assert each <= set(topics)
    assert run.record.planner.label == "live"


def test_frames_have_the_names_of_the_robots(tmp_path: Path) -> None:
    live, driver = _live(tmp_path, {"a": 0.4, "b": 0.2})
    serve_runs(live)
    (static,) = driver.on("/tf_static")
    children = {t.child_frame_id for t in static.fields.transforms}
    assert {f"{r}/{f}" for r in "ab" for f in ("odom", "base_link", "lidar")} == children
    moved = {m.fields.transforms[0].header.frame_id for m in driver.on("/tf")}
    assert moved == {"a/odom", "b/odom"}
    for name in "ab":
        assert driver.on(f"/{name}/scan")[0].fields.header.frame_id == f"{name}/lidar"
        assert driver.on(f"/{name}/odom")[0].fields.child_frame_id == f"{name}/base_footprint"
    assert [r.name for r in live.session.here] == ["a", "b"]
    assert live.session.robots["b"].pose[0] > 2.0


def test_a_robot_without_a_driver_stands_and_does_not_stop_the_other(tmp_path: Path) -> None:
    live, _ = _live(tmp_path, {"a": 0.4}, budget=0.01)
    run = serve_runs(live)
    assert run.record.live is not None
    assert run.record.live.missed_steps >= run.record.live.steps
    assert _way(run, "a") > 0.0
    assert _way(run, "b") == pytest.approx(0.0, abs=1e-3)


def test_calibration_runs_are_driven_as_well(tmp_path: Path) -> None:
    live, driver = _live(tmp_path, {"a": 0.4, "b": 0.2}, people=PEOPLE)
    run = serve_runs(live)
    assert run.record.live is not None
    assert run.record.live.missed_steps == 0
    assert "robot_alone" in run.record.references
    assert len(driver.opened) == 2


def test_real_time_keeps_one_pace_for_all_robots(tmp_path: Path) -> None:
    live, driver = _live(tmp_path, {"a": 0.4, "b": 0.2})
    run = serve_runs(replace(live, policy=StepPolicy(rate=1.0, wait=0.0)))
    assert run.record.live is not None
    assert run.record.live.steps == len(driver.on("/clock")) == len(driver.on("/b/odom"))
    assert run.record.live.missed_steps == 0
    assert _way(run, "a") > _way(run, "b") > 0.0


def test_a_robot_that_has_ended_is_not_asked(tmp_path: Path) -> None:
    live, driver = _live(tmp_path, {"a": 0.4, "b": 0.2}, b=1.0)
    run = serve_runs(live)
    assert run.record.live is not None
    assert run.record.live.missed_steps == 0
    assert run.record.live.steps == len(driver.on("/b/odom")) > len(driver.on("/a/odom"))


def test_steps_are_counted_once_for_all_robots(tmp_path: Path) -> None:
    live, driver = _live(tmp_path, {"a": 0.4, "b": 0.2})
    session = live.session
    session.pause(True)
    session.step(3)
    thread = threading.Thread(target=serve_runs, args=(live,))
    thread.start()
    until(lambda: session.counts.steps == 3)
    thread.join(0.2)
    assert (session.counts.steps, len(driver.on("/clock"))) == (3, 3)
    session.pause(False)
    thread.join(60.0)
    assert not thread.is_alive()
