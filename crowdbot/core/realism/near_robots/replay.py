"""Simulate the person of an encounter beside the same robot."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.engine import CrowdEngine
from crowdbot.core.crowd.response.parameters import Human
from crowdbot.core.crowd.world import CrowdWorld
from crowdbot.core.realism.model import CrowdModel
from crowdbot.core.realism.near_robots.clip import smoothed
from crowdbot.core.realism.near_robots.encounters import BODY, RobotEncounter
from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND
from crowdbot.core.types.arrays import Array

#: Distance of the goal, straight on, m.
_FAR = 1e4


@dataclass(frozen=True, slots=True, kw_only=True)
class Response:
    """People who respond to a robot: a crowd's decisions and its response.

    Attributes:
        crowd: the crowd's policy, steering and limits.
        human: response to robots.
        ignoring, late: fractions of people who ignore the robot, and of the others who notice late.
        margin: perceived radius minus radius of the robot, m.
        visible: True if people see the robot's velocity.
    """

    crowd: CrowdModel
    human: Human
    ignoring: float = 0.0
    late: float = 0.0
    margin: float = 0.25
    visible: bool = True


def walk_all(
    response: Response, encounters: Sequence[RobotEncounter], seed: int = 0
) -> list[Array]:
    """Return (K, 2) smoothed positions of a simulated person in each encounter, m.

    Attention is cut into slices, and each encounter gets a number from another slice.
    """
    rng = np.random.default_rng([seed, 0x5EE])
    count = len(encounters)
    attention = (rng.permutation(count) + rng.uniform(0.0, 1.0, count)) / max(count, 1)
    return [
        _walk(response, e, float(attention[k]), seed * count + k) for k, e in enumerate(encounters)
    ]


def _walk(response: Response, e: RobotEncounter, attention: float, key: int) -> Array:
    engine = _engine(response, e, attention, key)
    flat = engine.initial_state()
    _, rows = s.view(flat)
    rows[0, s.VX : s.VY + 1] = e.velocity
    per = round(float(e.t[1] - e.t[0]) * TICKS_PER_SECOND)
    robots = _robots(e, per, response.margin)
    outline = np.ascontiguousarray(e.footprint.corners)
    found = np.empty((len(e.t), 2))
    for k in range(len(e.t)):
        found[k] = rows[0, s.X : s.Y + 1]
        for tick in range(per if k + 1 < len(e.t) else 0):
            engine.advance(flat, robots[k * per + tick : k * per + tick + 1], outline)
    return smoothed(found, float(e.t[1] - e.t[0]))


def _engine(response: Response, e: RobotEncounter, attention: float, key: int) -> CrowdEngine:
    model, speed = response.crowd, math.hypot(*e.velocity)
    far = e.person[0] + _FAR * e.velocity / speed
    ignores = attention < response.ignoring
    late = attention < response.ignoring + (1.0 - response.ignoring) * response.late
    agents = Agents.of(
        x=[e.person[0, 0]], y=[e.person[0, 1]], preferred_speed=speed, radius=BODY,
        max_speed=max(model.max_speed, speed), max_acceleration=model.max_acceleration,
        routes=[[(float(far[0]), float(far[1]))]], ignores_robot=ignores, late=late,
        attention=remaining(attention, response.ignoring),
    )  # fmt: skip
    world = CrowdWorld(
        response=response.human,
        steering=replace(model.steering, key=key),
        robot_visible=response.visible,
        stiffness=0.0,  # gaps below zero are compared, too
        decision_rate=model.decision_rate,
    )
    return CrowdEngine(agents, world, model.policy)


def remaining(attention: float, ignoring: float) -> float:
    """Return attention rescaled to 0 to 1 among people who do not ignore robots."""
    return max(0.0, attention - ignoring) / max(1.0 - ignoring, 1e-9)


def _robots(e: RobotEncounter, per: int, margin: float) -> Array:
    """Return (K * per, 8) the robot at each tick, as `CrowdEngine.advance` takes it."""
    t = np.arange((len(e.t) - 1) * per + 1) * TICK
    pose = np.column_stack([np.interp(t, e.t, e.pose[:, k]) for k in range(3)])
    motion = np.gradient(e.pose, e.t, axis=0)
    motion = np.column_stack([np.interp(t, e.t, motion[:, k]) for k in range(3)])
    body = e.footprint.radius
    seen = np.full(len(t), e.footprint.reach + margin)
    return np.column_stack(
        [pose[:, :2], motion[:, :2], np.full(len(t), body), seen, pose[:, 2], motion[:, 2]]
    )
