"""The challenge of 2026: which conditions it has, who walks in them, what its labels say."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.scenarios.named_crowds import open_crowd
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.support.ticks import TICKS_PER_SECOND
from crowdbot.dsl.identity.canonical import content_hash
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.robot_response import RobotResponse
from crowdbot.dsl.suite.expansion import Expansion

REGISTRY = discover(allow=())
#: Where the people start, m, and the way that they walk before they come back to where they were.
ZONE, LOOP, WIDTH = (5.0, 45.0), 51.0, 10.0


@pytest.fixture(scope="module")
def suite() -> Expansion:
    return open_spec("challenge-2026", REGISTRY)


def crowds(suite: Expansion) -> dict[str, Crowd]:
    return {one.id: one.crowd for one in suite.scenarios if one.crowd is not None}


def test_eight_conditions_have_eighteen_draws_and_seven_are_controls(suite: Expansion) -> None:
    conditions = Counter(id_.rpartition("-")[0] for id_ in crowds(suite))
    tell = {k for k in conditions if not k.startswith("in-") and not k.endswith("attentive")}
    assert len(conditions) == 15
    assert {k for k, draws in conditions.items() if draws == 18} == tell
    assert sum(draws for k, draws in conditions.items() if k not in tell) == 18
    assert min(conditions.values()) == 2, "a stratum needs two draws"
    hashes = {content_hash(one, REGISTRY.spec_versions(one)) for one in suite.scenarios}
    assert len(hashes) == 162


def test_no_two_runs_share_a_draw(suite: Expansion) -> None:
    assert len({crowd.seed for crowd in crowds(suite).values()}) == 162


def test_the_densest_counterflow_has_39_runs(suite: Expansion) -> None:
    assert sum(id_.startswith("counter-d040-") for id_ in crowds(suite)) == 39


def test_labels_and_titles_say_the_density_that_is_realised(suite: Expansion) -> None:
    """People spread over the whole loop; the nominal density counts the start zone alone."""
    for scenario in suite.scenarios:
        assert scenario.crowd is not None
        assert scenario.crowd.flow is not None
        people = scenario.crowd.flow.density * (ZONE[1] - ZONE[0]) * WIDTH
        realised = people / (LOOP * WIDTH)
        assert scenario.id.split("-")[1] == f"d{round(100 * realised):03d}"
        assert f"{realised:.2f} realised" in scenario.title
        assert scenario.title.startswith(f"{scenario.crowd.flow.density:g} people")


@pytest.mark.parametrize(
    ("label", "ignoring", "late", "runs"),
    [("attentive", 0.0, 0.0, 14), ("late", 0.0, 0.4, 74), ("never", 0.1, 0.4, 74)],
)
def test_attention(suite: Expansion, label: str, ignoring: float, late: float, runs: int) -> None:
    found = [crowd.robot_response for id_, crowd in crowds(suite).items() if f"-{label}-" in id_]
    assert len(found) == runs
    assert {(r.kind, r.ignoring, r.late) for r in found} == {("giving_way", ignoring, late)}


def test_people_walk_as_people_do(suite: Expansion) -> None:
    """Mean of the fit, standard deviation of Weidmann 1993; a tail is cut off at three sd."""
    speeds = np.concatenate([realise(one).speed for one in suite.scenarios[::40]])
    assert np.mean(speeds) == pytest.approx(1.58, abs=0.04)
    assert np.std(speeds) == pytest.approx(0.26, abs=0.03)


def test_people_are_the_calibrated_crowd(suite: Expansion) -> None:
    """All that the part sets but the spread of speeds; people go straight ahead, as it was fitted.

    Nobody uses more than a leg can do, whether for others or for the robot.
    """
    part = open_crowd("calibrated", REGISTRY)
    assert part.speed is not None
    for crowd in crowds(suite).values():
        assert (crowd.policy, crowd.costs, crowd.steering) == (
            part.policy, part.costs, part.steering,
        )  # fmt: skip
        assert crowd.speed is not None
        assert crowd.speed.mean == part.speed.mean
        for name in ("radius", "avoided_radius"):
            assert getattr(crowd.body, name) == getattr(part.body, name)
        assert crowd.goal_point == "ahead"
        assert isinstance(crowd.robot_response, RobotResponse)
        assert crowd.body.max_acceleration <= crowd.robot_response.total_acceleration


@pytest.mark.slow
@pytest.mark.parametrize("condition", ["counter-d020", "both-d040"])
def test_the_density_is_realised(suite: Expansion, condition: str) -> None:
    scenario = pick(suite, f"{condition}-attentive-n01")
    parts = build_environment(REGISTRY, scenario.environment)
    engine = build_crowd(scenario, realise(scenario), parts, REGISTRY)
    assert engine is not None
    flat, inside = engine.initial_state(), []
    people = s.view(flat)[1]
    for _ in range(60 * TICKS_PER_SECOND // 64):
        for _ in range(64):
            engine.advance(flat)
        x = people[people[:, s.WAITING] == s.PRESENT, s.X]
        inside.append(np.count_nonzero((x > ZONE[0]) & (x < ZONE[1])))
    realised = np.mean(inside) / ((ZONE[1] - ZONE[0]) * WIDTH)
    assert realised == pytest.approx(int(condition[-3:]) / 100, rel=0.03)
