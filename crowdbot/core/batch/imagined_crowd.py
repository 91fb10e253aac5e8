"""ImaginedCrowd: people in a planner's prediction, who decide by the policy of a crowd."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.batch.compiled_walk import CompiledWalk, walks_compiled
from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.engine import CrowdEngine
from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.crowd.world import CrowdWorld
from crowdbot.core.realism.near_robots.responses import open_responding, response_of_crowd
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.types.arrays import Array

_NO_ROBOT = np.zeros((0, 8))


class ImaginedCrowd:
    """A fixed number of predicted people on an empty floor, placed by the caller.

    They have a crowd's policy, its steering parts without `wander`, and its response to robots; all
    of them have noticed every robot within sight.

    Args:
        crowd: name of a crowd, file of one, or kind of a response to robots.
        preferred_speed: (N,) m/s.
        radius: (N,) m; None: that of the crowd.
        registry: the installed components; default: discovered now.

    Attributes:
        is_compiled: True if `walk` is one compiled call.

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
        self.is_compiled, self._walks = walks_compiled(self._engine), dict[float, CompiledWalk]()

    def accelerations(
        self,
        position: Array,
        velocity: Array,
        goal: Array,
        present: NDArray[np.bool_],
        robot: Array = _NO_ROBOT,
    ) -> Array:
        """Return people's desired accelerations (N, 2), m/s^2; zero for those not present.

        Args:
            position, velocity, goal: (N, 2), m and m/s.
            present: (N,) False for people to leave out.
            robot: (R, 8) as for `CrowdEngine.advance`.
        """
        return self._engine.decide(position, velocity, goal, present, robot)

    def walk(
        self,
        position: Array,
        velocity: Array,
        goal: Array,
        present: NDArray[np.bool_],
        robots: Array,
        radius: float | None,
        dt: float,
    ) -> tuple[Array, Array, Array]:
        """Return positions, velocities and accelerations (K, N, 2) at K decisions, SI units.

        Accelerations are those of `accelerations`, and are kept until the next decision.

        Args:
            position, velocity, goal, present: at first, as in `accelerations`.
            robots: (K, 4) x, y, vx, vy of a robot at each decision.
            radius: of the robot, m; None: people do not see it.
            dt: between two decisions, s.
        """
        if self.is_compiled and radius is not None:
            if radius not in self._walks:
                self._walks = {radius: CompiledWalk(self._engine, radius)}
            return self._walks[radius].walk(position, velocity, goal, present, robots, dt)
        found = np.zeros((3, len(robots), *position.shape))
        for k, (x, y, vx, vy) in enumerate(robots.tolist()):
            row = [] if radius is None else [[x, y, vx, vy, radius, radius, 0.0, 0.0]]
            pull = self.accelerations(
                position, velocity, goal, present, np.array(row).reshape(-1, 8)
            )
            found[:, k] = position, velocity, pull
            after = velocity + dt * pull
            position, velocity = position + 0.5 * dt * (velocity + after), after
        return found[0], found[1], found[2]
