"""Small crowds for tests of the engine."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdView, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.plugin import Range
from crowdbot.plugins.crowd.cost_functions.rvo import RvoSpec
from crowdbot.plugins.crowd.cost_functions.ttca_dca.ttca_dca import TtcaDcaSpec
from crowdbot.plugins.crowd.policies.velocity_space import VelocitySpaceSpec
from crowdbot.plugins.crowd.policies.velocity_space_build import VelocitySpace
from tests.core.crowd.crowd_reference import Array, agents_of
from tests.core.crowd.oracle_cases import compiled

WALLS = np.array([[-1.0, -5.0, 51.0, -5.0], [51.0, 5.0, -1.0, 5.0]])
ENTRANCE, OUT = np.array([-1.0, 0.0, -5.0, 5.0]), np.array([50.0, 51.0, -5.0, 5.0])
TICKS = 128


@dataclass
class Straight:
    """Everybody goes on as before; no pushes."""

    contact_stiffness: float = 0.0

    def accelerations(self, view: CrowdView) -> Array:
        return np.zeros_like(view.position)


@dataclass
class ToGoal:
    """Everybody walks straight to the goal, through everything, and stops there; no pushes."""

    contact_stiffness: float = 0.0

    def velocities(self, view: CrowdView, dt: float) -> Array:
        assert dt > 0.0
        offset = view.goal - view.position
        distance = np.hypot(offset[:, 0], offset[:, 1])
        pace = np.where(distance > view.agents.radius, view.agents.preferred_speed, 0.0)
        return np.asarray(offset * (pace / np.maximum(distance, 1e-9))[:, np.newaxis])


def world(**changes: object) -> CrowdWorld:
    """The challenge's corridor."""
    given: dict[str, object] = {
        "walls": WALLS, "entrance": ENTRANCE, "out": OUT,
        "robot_visible": True, "stiffness": 30000.0, "dissipation": 0.3, "goal_key": 2020,
        "decision_rate": 16.0,
    }  # fmt: skip
    return CrowdWorld(**{**given, **changes})  # type: ignore[arg-type]


def straight(position: Array, speed: float | Array = 1.2, **changes: object) -> CrowdEngine:
    """People who walk straight on through everything."""
    return CrowdEngine(agents_of(position, speed), world(**changes), lambda _: Straight())


def unmoved(at: tuple[float, float], speed: float) -> CrowdEngine:
    """One person who walks straight on and ignores robots."""
    agents = replace(agents_of(np.array([at]), speed), ignores_robot=np.array([True]))
    return CrowdEngine(agents, world(), lambda _: Straight())


def walkers(agents: Agents, **changes: object) -> CrowdEngine:
    """People of the challenge's kind."""
    mix = [
        TtcaDcaSpec(
            weight=20.0, range=Range(value=5.0), sigma_ttca=0.3, sigma_dca=0.3,
            sigma_angle_goal=3.0, sigma_speed_goal=0.01,
        ),
        RvoSpec(range=Range(value=0.3, measure="surface")),
    ]  # fmt: skip
    return CrowdEngine(
        agents, world(**changes),
        lambda a: VelocitySpace(VelocitySpaceSpec(), [compiled(c) for c in mix], a),
    )  # fmt: skip


def challenge(id_: str) -> CrowdEngine:
    """The crowd of a scenario of the challenge."""
    registry = discover()
    scenario = pick(open_spec("challenge-2020", registry), id_)
    parts = build_environment(registry, scenario.environment)
    engine = build_crowd(scenario, realise(scenario), parts, registry)
    assert engine is not None
    return engine


def rows(flat: Array) -> Array:
    """The agents' part of the state."""
    return s.view(flat)[1]
