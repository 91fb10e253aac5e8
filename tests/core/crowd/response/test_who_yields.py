"""How people take the robot: all yield, nobody does, or some."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from pydantic import ValidationError

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdView, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.response.parameters import Human
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.dsl.scenario.robot_response import HumanResponse
from tests.core.crowd.crowd_reference import Array
from tests.core.crowd.crowd_worlds import TICKS, Straight, rows, walkers

PARKED = np.array([[20.0, 0.0, 0.0, 0.0, 0.178, 0.428]])


def _stream(ignores: object) -> Agents:
    x = np.arange(10) * 1.5
    return Agents.of(
        x=x, y=np.linspace(-0.5, 0.5, 10), preferred_speed=1.2, routes=[[(60.0, 0.0)]] * 10,
        ignores_robot=ignores,  # type: ignore[arg-type]
    )  # fmt: skip


def _touched(ignores: object, response: Human | None = None) -> NDArray[np.bool_]:
    engine = walkers(_stream(ignores), response=response or Human())
    flat = engine.initial_state()
    for _ in range(25 * TICKS):
        engine.advance(flat, PARKED)
    return np.asarray(s.contact_with(flat)[1][:, s.TOUCHES] > 0.0, np.bool_)


def test_who_yields_never_touches_a_parked_robot_who_ignores_it_does() -> None:
    assert not np.any(_touched(False))
    assert np.mean(_touched(True)) > 0.5
    some = np.arange(10) % 2 == 1
    assert not np.any(_touched(some)[~some])
    assert np.any(_touched(some)[some])


DISTRACTED = Human(all_stop_short=True)


def test_who_is_distracted_stops_short_of_a_robot_that_stands() -> None:
    assert not np.any(_touched(True, DISTRACTED))
    assert not np.any(_touched(np.arange(10) % 2 == 1, DISTRACTED))


def test_who_is_distracted_takes_no_notice_of_one_that_moves() -> None:
    """Until they touch it: the same motion, bit by bit, as of people who ignore it."""
    robot = PARKED.copy()
    robot[0, 2] = -1.0
    states = []
    for response in (Human(), DISTRACTED):
        engine = walkers(_stream(True), response=response)
        flat, row = engine.initial_state(), robot.copy()
        for _ in range(8 * TICKS):
            engine.advance(flat, row)
            row[0, 0] += row[0, 2] / TICKS
        touches = s.contact_with(flat)[1][:, [s.TOUCHES]]
        states.append(np.hstack([rows(flat)[:, [s.X, s.Y, s.VX, s.VY]], touches]))
    np.testing.assert_array_equal(states[0], states[1])
    assert np.any(states[0][:, 4] > 0.0)


class Spy(Straight):
    def __init__(self) -> None:
        self.calls: list[tuple[int, list[bool]]] = []

    def accelerations(self, view: CrowdView) -> Array:
        assert view.decides is not None
        self.calls.append((len(view.robot), view.decides.tolist()))
        return np.zeros_like(view.position)


@pytest.mark.parametrize(
    ("response", "shown"),
    [
        (Human(), [False, False, False]),
        (Human(shown_to_policies=True), [False, True, False]),
    ],
)
def test_policies_are_shown_the_robot_for_those_who_plan_around_it(
    response: Human, shown: list[bool]
) -> None:
    """Of somebody who ignores it, somebody attentive and somebody late."""
    spy = Spy()
    agents = Agents.of(x=[0.0, 3.0, 6.0], y=0.0, ignores_robot=[True, False, False],
                       late=[False, False, True], routes=[[(9.0, 0.0)]] * 3)  # fmt: skip
    engine = CrowdEngine(agents, CrowdWorld(response=response), spy)
    engine.advance(engine.initial_state(), PARKED)
    groups = [(1, shown), (0, [not one for one in shown])]
    assert spy.calls == [(count, who) for count, who in groups if any(who)]
    engine.advance_alone(engine.initial_state(), 1)
    assert spy.calls[-1] == (0, [True, True, True])


def test_people_who_ignore_the_robot_walk_as_without_it() -> None:
    far = PARKED + np.array([0.0, 3.0, 0.0, 0.0, 0.0, 2.0])  # seen as a giant, touched by nobody
    here, alone = walkers(_stream(True)), walkers(_stream(True))
    flat, other = here.initial_state(), alone.initial_state()
    for _ in range(10 * TICKS):
        here.advance(flat, far)
        alone.advance(other)
    assert np.array_equal(rows(flat), rows(other))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "ignoring", "late"),
    [
        ("{}", 0.0, 0.4),
        ("{late_fraction: 0.1}", 0.0, 0.1),
        ("{reaction: ignore}", 1.0, 0.0),
        ("{reaction: mixed, ignoring_fraction: 0.4}", 0.4, 0.24),
        ("{reaction: distracted, ignoring_fraction: 0.4}", 0.4, 0.24),
    ],
)
def test_the_scenario_says_it(words: str, ignoring: float, late: float) -> None:
    registry = discover()
    suite = open_spec("challenge-2020", registry, [f"crowd.robot_response={words}"])
    scenario = pick(suite, "in-d0500-slow-c01-r02")
    parts = build_environment(registry, scenario.environment)
    engine = build_crowd(scenario, realise(scenario), parts, registry)
    assert engine is not None
    ignores = engine.agents.ignores_robot
    assert np.mean(ignores) == pytest.approx(ignoring, abs=0.1)
    assert np.mean(engine.agents.late & ~ignores) == pytest.approx(late, abs=0.1)


@pytest.mark.parametrize(
    "given",
    [
        {"reaction": "mixed"},
        {"reaction": "yield", "ignoring_fraction": 0.5},
        {"reaction": "mixed", "ignoring_fraction": 1.0},
        {"reaction": "flee"},
        {"reaction": "distracted"},
        {"late_fraction": 1.5},
        {"standing_speed": 0.3},
        {"field_of_view": 7.0},
    ],
)
def test_what_makes_no_sense_is_refused(given: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        HumanResponse(**given)  # type: ignore[arg-type]
