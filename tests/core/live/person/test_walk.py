"""A person walks among people: with human limits, seen and avoided, and repeated exactly."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from crowdbot import cli
from crowdbot.cli.commands.run.walk import _with_person
from crowdbot.cli.serving.person_run import PersonRun, request_of
from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.live.live_robot import LiveRobot
from crowdbot.core.live.person.seat import Seat
from crowdbot.core.live.person.stick import Stick
from crowdbot.core.live.person.walk import walk, walk_again
from crowdbot.core.live.person.walking import (
    ACCELERATION,
    COMFORTABLE,
    FASTEST,
    PERSON,
    Steps,
    WalkerBody,
    with_person,
)
from crowdbot.core.live.session import LiveSession
from crowdbot.core.recording.recording import Recording
from crowdbot.core.registry.registry import discover
from crowdbot.core.runs.run import Request, Run
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.scenarios.lock import population
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError
from tests.paths import DATA

SHORT = str(DATA / "short_way.yaml")


class Scripted(Seat):
    """A seat without a page: the stick is a function of time."""

    def __init__(self) -> None:
        super().__init__(LiveSession(robots={"": LiveRobot(name="person")}))

    def pace(self, t: float) -> None:
        """Wait for no one."""

    def take(self, t: float) -> Stick:
        """Ahead, then back."""
        self.log.steps += 1
        return Stick(1, ahead=1.0 if t < 0.8 else -1.0, aside=0.3, yaw=0.2)


def _request(out: Path, *overrides: str) -> Request:
    given = PersonRun(
        spec=SHORT, scenario=None, overrides=overrides, seed=0, out=out, record="none",
        references=False, duration=1.0,
    )  # fmt: skip
    return request_of(given, discover())


def _walked(out: Path, body: WalkerBody, *overrides: str) -> tuple[Run, Trajectories]:
    without = _request(out, *overrides)
    request, builts = _with_person(without, body, (), ())
    run = walk(request, builts, Scripted(), without.scenario, body.speed)
    with Recording(run.directory / "run.mcap") as recording:
        return run, recording.trajectories()


def _me(run: Trajectories) -> int:
    assert run.agents is not None
    return int(np.flatnonzero(run.agents.id == PERSON)[0])


def test_the_person_walks_within_human_limits_and_is_repeated(tmp_path: Path) -> None:
    limit = "robots.robot.task.time_limit=1.5"
    run, tracks = _walked(tmp_path, WalkerBody(at=(0.8, -1.5), speed=FASTEST), limit)
    assert tracks.agents is not None
    me = _me(tracks)
    x, y = tracks.agents.x[:, me], tracks.agents.y[:, me]
    velocity = np.diff(np.column_stack([x, y]), axis=0) / np.diff(tracks.t)[:, None]
    speed = np.hypot(*velocity.T)
    change = np.hypot(*np.diff(velocity, axis=0).T) / np.diff(tracks.t)[1:]
    assert 1.0 < speed.max() <= FASTEST + 1e-6
    assert 0.9 * ACCELERATION < change.max() <= ACCELERATION + 1e-6
    way = math.atan2(y[8] - y[0], x[8] - x[0])
    assert way == pytest.approx(0.2 + math.atan2(0.3, 1.0), abs=0.02)
    assert tracks.trips is not None
    assert PERSON not in tracks.trips.agent  # its own way is not scored
    live = run.record.live
    assert live is not None
    assert live.steps == len(tracks.signals["walker/vx"]) == 24

    without = _request(tmp_path / "again", limit)
    request, builts = _with_person(without, WalkerBody(at=(0.8, -1.5), speed=FASTEST), (), ())
    again = walk_again(request, builts, without.scenario, run.directory)
    assert again.record.hashes == run.record.hashes


def test_people_alone_are_joined_and_a_goal_makes_a_trip(tmp_path: Path) -> None:
    nobody = ("robots={}",)
    run, tracks = _walked(tmp_path, WalkerBody(at=(3.0, -1.0), goal=(3.6, -0.8)), *nobody)
    assert tracks.trips is not None
    assert PERSON in tracks.trips.agent
    assert run.record.people_alone
    assert run.directory.parent.parent.name.endswith("+walk")


def test_others_see_and_avoid_the_person() -> None:
    """One who stands in the way of a pedestrian makes that one go around."""
    aside = []
    for at in ((5.0, 0.0), (5.0, -1.65)):
        scenario, registry = _one_pedestrian(), discover()
        joined = with_person(scenario, registry, WalkerBody(at=at))
        parts = build_environment(registry, joined.environment)
        engine = build_crowd(joined, population(joined, registry).agents, parts, registry)
        assert engine is not None
        _, places = engine.run(6.0)
        walker = int(np.flatnonzero(engine.agents.id == PERSON)[0])
        aside.append(float(np.abs(places[:, 1 - walker, 1]).max()))
        assert places[:, walker].tolist() == [list(at)] * len(places)
    assert aside[0] > 0.3 > aside[1]


def _one_pedestrian() -> Scenario:
    text = {
        "crowd.agents": "[{id: 0, x: 1.0, y: 0.0, speed: 1.2, goals: [[9.0, 0.0]]}]",
        "crowd.flow": "null",
        "robots": "{}",
    }
    given = [f"{k}={v}" for k, v in text.items()]
    return pick(open_spec(SHORT, discover(), given), None)


def test_neither_robots_nor_evasion_change_what_the_person_wants() -> None:
    scenario, registry = pick(open_spec(SHORT, discover()), None), discover()
    joined = with_person(scenario, registry, WalkerBody(at=(3.0, 0.4)))
    parts = build_environment(registry, joined.environment)
    engine = build_crowd(joined, population(joined, registry).agents, parts, registry)
    assert engine is not None
    me = int(np.flatnonzero(engine.agents.id == PERSON)[0])
    flat = engine.initial_state()
    robot = np.array([[2.4, 0.4, 1.0, 0.0, 0.2, 0.2, 0.0, 0.0]])  # it drives at the person
    for _ in range(24):
        engine.advance(flat, robot)
        assert s.view(flat)[1][me, s.AX : s.AY + 1].tolist() == [0.0, 0.0]


def test_a_stick_is_a_velocity_in_the_direction_of_the_view() -> None:
    seat = Scripted()
    vx, vy = Steps(seat, COMFORTABLE)(0.0)
    assert math.hypot(vx, vy) == pytest.approx(COMFORTABLE)
    assert math.atan2(vy, vx) == pytest.approx(0.2 + math.atan2(0.3, 1.0))


def test_a_free_place_is_found_and_a_taken_one_refused() -> None:
    scenario, registry = pick(open_spec(SHORT, discover()), None), discover()
    joined = with_person(scenario, registry, WalkerBody())
    assert joined.crowd is not None
    person = joined.crowd.agents[-1]
    assert math.dist((person.x, person.y), (1.5, 0.4)) > 1.0
    for at in ((1.5, 0.4), (3.0, 1.9)):  # the robot, the wall
        with pytest.raises(InputError, match="not free"):
            with_person(scenario, registry, WalkerBody(at=at))
    with pytest.raises(InputError, match="a walker already"):
        with_person(replace_id(joined), registry, WalkerBody())


def replace_id(scenario: Scenario) -> Scenario:
    return scenario.model_copy(update={"id": "again"})


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        (["--at", "1"], "a place is X,Y"),
        (["--at", "nan,0"], "write two numbers"),
        (["--at", "1.5,0.4"], "not free"),
        (["--set", "robots={}", "--planner", "dwa"], "has no robot"),
        (["--replay", str(DATA / "recordings" / "format_3.mcap")], "no person walks in it"),
    ],
)
def test_what_cannot_be_walked_is_said(
    more: list[str], expected: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["walk", SHORT, "--out", str(tmp_path), "--no-references", *more]) != 0
    assert expected in capsys.readouterr().err
    assert not any(tmp_path.iterdir())
