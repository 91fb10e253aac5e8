"""The contract of whole policies: velocities or accelerations, several beside each other."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdPolicy, CrowdView, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.desired_acceleration import candidates_of, relaxation_time_of
from crowdbot.core.crowd.policy import CONTACT_STIFFNESS
from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.types.candidates import VelocityCandidates
from crowdbot.dsl.scenario.steering import SteeringSpec, WanderSpec
from crowdbot.errors import PluginError
from tests.core.crowd.crowd_reference import Array
from tests.core.crowd.crowd_worlds import TICKS, Straight, ToGoal, rows

SOME = Agents.of(
    id=[7, 3, 5], x=[0.0, 2.0, 4.0], y=0.0, preferred_speed=1.0, routes=[[(30.0, 0.0)]] * 3
)


class Wish:
    """Wants one velocity for all."""

    def __init__(self, *wish: float) -> None:
        self.wish = wish

    def velocities(self, view: CrowdView, dt: float) -> Array:
        assert dt == view.dt == 1.0 / 16.0
        return np.tile(self.wish, (len(view.position), 1))


def _after(policy: Any, seconds: float, agents: Agents = SOME) -> Array:
    engine = CrowdEngine(agents, CrowdWorld(), policy)
    flat = engine.initial_state()
    for _ in range(round(seconds * TICKS)):
        engine.advance(flat)
    return rows(flat)


def test_wanted_velocities_are_reached_as_fast_as_legs_allow() -> None:
    at_once = _after(Wish(1.2, 0.1), 1.0 / 16.0)
    assert at_once[:, s.VX : s.VY + 1] == pytest.approx(np.tile([1.2, 0.1], (3, 1)))
    turned = _after(Wish(-1.0, 0.0), 0.25)  # 5 m/s^2 for a quarter of a second
    assert turned[:, s.VX] == pytest.approx([1.0 - 5.0 * 0.25] * 3)
    assert _after(Wish(9.0, 0.0), 3.0)[:, s.VX] == pytest.approx([3.0] * 3)


def test_several_policies_each_for_its_own() -> None:
    agents = Agents.of(x=[0.0, 2.0, 4.0], y=0.0, preferred_speed=1.0, policy=[1, 0, 1],
                       routes=[[(30.0, 0.0)]] * 3)  # fmt: skip
    found = _after([Wish(0.5, 0.0), Wish(0.0, 1.0)], 1.0, agents)
    assert found[:, s.VX : s.VY + 1] == pytest.approx(np.array([[0, 1], [0.5, 0], [0, 1]]))


def test_each_policy_says_how_hard_its_people_push() -> None:
    agents = Agents.of(x=[0.0, 0.3], y=0.0, preferred_speed=0.0, policy=[0, 1], routes=[[]] * 2)
    found = _after([Straight(contact_stiffness=10.0), Wish(0.0, 0.0)], 1.0 / TICKS, agents)
    assert found[:, s.PUSH_X] == pytest.approx([-10.0 * 0.36, CONTACT_STIFFNESS * 0.36])


def test_a_policy_may_be_made_for_the_agents() -> None:
    seen: list[Agents] = []

    def make(agents: Agents) -> CrowdPolicy:
        seen.append(agents)
        return ToGoal()

    CrowdEngine(SOME, CrowdWorld(), make)
    assert seen == [SOME]


class Says:
    def __init__(self, answer: Any) -> None:
        self.answer = answer

    def accelerations(self, view: CrowdView) -> Any:
        assert len(view.position) == 3
        return self.answer


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (np.zeros((2, 2)), r"Says': returned shape \(2, 2\) instead of \(3, 2\)"),
        (np.zeros(3), r"instead of \(3, 2\)"),
        (None, "a NoneType where an array of numbers is wanted"),
        (np.array([[0, 0], [0, np.nan], [0, 0]]), r"\[0.0, nan\] for agent 3 at t = 0 s"),
        (np.full((3, 2), np.inf), "for agent 7"),
    ],
)
def test_a_policy_that_answers_nonsense_is_named(answer: Any, message: str) -> None:
    with pytest.raises(PluginError, match=message):
        _after(Says(answer), 0.5)


def test_what_is_said_of_absent_people_does_not_matter() -> None:
    agents = Agents.of(x=[0.0, 2.0, 4.0], y=0.0, preferred_speed=1.0, start_time=[0, 9, 0],
                       routes=[[(30.0, 0.0)]] * 3)  # fmt: skip
    answer = np.array([[0, 0], [np.nan, np.nan], [0, 0.0]])
    found = _after(Says(answer), 1.0, agents)
    assert np.all(np.isfinite(found))


def test_run_samples_positions() -> None:
    agents = Agents.of(x=[0.0, 2.0], y=0.0, preferred_speed=1.0, start_time=[0.0, 0.5],
                       routes=[[(30.0, 0.0)]] * 2)  # fmt: skip
    t, place = CrowdEngine(agents, CrowdWorld(), ToGoal()).run(2.0, 8.0)
    assert t.tolist() == (np.arange(17) / 8.0).tolist()
    assert place.shape == (17, 2, 2)
    assert place[:, 0, 0] == pytest.approx(t)
    assert list(np.isfinite(place[:, 1, 0])) == list(t >= 0.5)
    assert CrowdEngine(Agents.of(x=[], y=[]), CrowdWorld(), ToGoal()).run(1.0)[1].shape == (
        17,
        0,
        2,
    )


class Lists(ToGoal):
    def __init__(self, candidates: object) -> None:
        self._candidates = candidates

    @property
    def velocity_candidates(self) -> object:
        print("out of a property")
        if isinstance(self._candidates, Exception):
            raise self._candidates
        return self._candidates


@pytest.mark.parametrize(
    ("candidates", "message"),
    [
        (RuntimeError("none today"), "Lists': velocity_candidates: .*none today"),
        ([[1.0, 0.0]], "Lists': velocity_candidates is a list, not VelocityCandidates"),
    ],
)
def test_candidates_that_fail_are_named(candidates: object, message: str) -> None:
    with pytest.raises(PluginError, match=message):
        candidates_of(Lists(candidates))


class Takes(ToGoal):
    def __init__(self, time: object) -> None:
        self._time = time

    @property
    def relaxation_time(self) -> object:
        print("out of a property")
        if isinstance(self._time, Exception):
            raise self._time
        return self._time


@pytest.mark.parametrize(
    ("time", "message"),
    [
        (RuntimeError("never"), "Takes': relaxation_time: .*never"),
        ("soon", "Takes': relaxation_time: .*could not convert string to float"),
        (-0.5, r"Takes': relaxation_time is -0\.5 s"),
        (math.nan, "Takes': relaxation_time is nan s"),
    ],
)
def test_a_relaxation_time_that_fails_names_the_policy(time: object, message: str) -> None:
    """Steering parts ask for it, inside the boundary."""
    engine = CrowdEngine(
        SOME, CrowdWorld(steering=Steering(SteeringSpec(wander=WanderSpec()))), Takes(time)
    )
    with pytest.raises(PluginError, match=message):
        engine.run(1.0)


def test_a_relaxation_time_is_asked_for_inside_the_boundary(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert relaxation_time_of(Takes(0.5)) == 0.5
    assert capsys.readouterr() == ("", "out of a property\n")
    assert relaxation_time_of(ToGoal()) == 0.0


def test_candidates_are_asked_for_inside_the_boundary(capsys: pytest.CaptureFixture[str]) -> None:
    listed = VelocityCandidates(np.zeros((1, 2)), 0.5)
    assert candidates_of(Lists(listed)) is listed
    assert capsys.readouterr() == ("", "out of a property\n")
    assert candidates_of(ToGoal()) is None
