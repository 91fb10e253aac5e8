"""A stand-in for the library jupedsim: the few calls our adapter makes, and its refusals.

People walk straight to their target at the desired speed. Like the library it refuses bodies that
overlap, people outside the floor and calls with unknown arguments.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(kw_only=True)
class CollisionFreeSpeedModel:
    strength_neighbor_repulsion: float = 8.0


@dataclass(kw_only=True)
class AnticipationVelocityModel:
    rng_seed: int


@dataclass(kw_only=True)
class CollisionFreeSpeedModelAgentParameters:
    position: tuple[float, float]
    desired_speed: float
    radius: float
    time_gap: float
    journey_id: int
    stage_id: int


class AnticipationVelocityModelAgentParameters(CollisionFreeSpeedModelAgentParameters):
    pass


class JourneyDescription:
    def __init__(self, stages: list[int]) -> None:
        self.stages = stages


@dataclass
class Agent:
    position: tuple[float, float]
    speed: float
    radius: float
    target: tuple[float, float] | None = None


class Simulation:
    made: int = 0

    def __init__(self, *, model: Any, geometry: Any, dt: float) -> None:
        self._dt, self._geometry, self._agents = dt, geometry, list[Agent]()
        self._model = model
        Simulation.made += 1

    def add_direct_steering_stage(self) -> int:
        return 1

    def add_journey(self, journey: JourneyDescription) -> int:
        assert journey.stages == [1]
        return 2

    def add_agent(self, p: CollisionFreeSpeedModelAgentParameters) -> int:
        assert (p.journey_id, p.stage_id) == (2, 1)
        anticipates = isinstance(self._model, AnticipationVelocityModel)
        assert isinstance(p, AnticipationVelocityModelAgentParameters) == anticipates
        assert self._geometry == "floor"
        for other in self._agents:
            if math.dist(other.position, p.position) <= other.radius + p.radius:
                raise RuntimeError("Model constraint violation: Agent too close to agent")
        self._agents.append(Agent(p.position, p.desired_speed, p.radius))
        return len(self._agents) - 1

    def agent(self, number: int) -> Agent:
        return self._agents[number]

    def iterate(self, count: int) -> None:
        for agent in self._agents:
            assert agent.target is not None
            away = math.dist(agent.position, agent.target)
            way = min(away, agent.speed * self._dt * count)
            if away > 0.0:
                share = way / away
                agent.position = (
                    agent.position[0] + share * (agent.target[0] - agent.position[0]),
                    agent.position[1] + share * (agent.target[1] - agent.position[1]),
                )


class FakeArea:
    shape = "floor"

    def nearest(self, point: NDArray[np.float64]) -> tuple[float, float]:
        return (float(point[0]), float(point[1]))


class FakeAreas:
    """One floor without end."""

    def of(
        self, points: NDArray[np.float64], walls: NDArray[np.float64]
    ) -> Iterator[tuple[FakeArea, NDArray[np.bool_]]]:
        del walls
        yield FakeArea(), np.ones(len(points), np.bool_)
