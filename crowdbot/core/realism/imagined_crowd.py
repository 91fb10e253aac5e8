"""ImaginedCrowd: people whom a planner imagines, who decide as those of a crowd do."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.engine import CrowdEngine
from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.crowd.world import CrowdWorld
from crowdbot.core.realism.near_robots.responses import open_responding, response_of_crowd
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.types.arrays import Array

_NO_ROBOT = np.zeros((0, 8))


class ImaginedCrowd:
    """A fixed number of people on an empty floor, whom the caller places for each decision.

    They take the policy, the steering parts without `wander`, and the response to robots of a
    crowd; all of them have noticed a robot that is within sight.

    Args:
        crowd: name of a crowd, file of one, or kind of a response to robots.
        preferred_speed: (N,) m/s.
        radius: (N,) m; None: that of the crowd.
        registry: the installed components; default: discovered now.

    Raises:
        UnknownNameError: there is no such crowd.
    """

    def __init__(
        self,
        crowd: str,
        preferred_speed: Array,
        radius: Array | None = None,
        registry: Registry | None = None,
    ) -> None:
        known = registry or discover()
        response = response_of_crowd(open_responding(crowd, known), known)
        people = response.crowd
        count = len(preferred_speed)
        agents = Agents.of(
            x=np.zeros(count),
            y=np.zeros(count),
            preferred_speed=preferred_speed,
            radius=people.radius if radius is None else radius,
            avoided_radius=people.avoided_radius if radius is None else radius,
            max_speed=people.max_speed,
            max_acceleration=people.max_acceleration,
            routes=[[(0.0, 0.0)]] * count,
        )
        steering = Steering(people.steering.spec.model_copy(update={"wander": None}))
        world = CrowdWorld(
            steering=steering,
            response=response.human,
            cohesion=None,
            robot_visible=response.visible,
            decision_rate=people.decision_rate,
        )
        self._engine = CrowdEngine(agents, world, people.policy)

    def accelerations(
        self,
        position: Array,
        velocity: Array,
        goal: Array,
        present: NDArray[np.bool_],
        robot: Array = _NO_ROBOT,
    ) -> Array:
        """Return the accelerations (N, 2) that people want, m/s^2; zero for those not present.

        Args:
            position, velocity, goal: (N, 2), m and m/s.
            present: (N,) False for people to leave out.
            robot: (R, 8) as for `CrowdEngine.advance`.
        """
        return self._engine.decide(position, velocity, goal, present, robot)
