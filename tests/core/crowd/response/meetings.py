"""One or a few people and robots on an endless floor, to see what people do about robots."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdView, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact.robot_contact import DISC
from crowdbot.core.crowd.response.parameters import Human
from crowdbot.core.support.ticks import TICK
from tests.core.crowd.crowd_reference import Array

BODY, PERSON = 0.178, 0.33
FAR = 90.0  # m, where goals lie

Place = tuple[float, float]


def robot(x: float, y: float, vx: float = 0.0, vy: float = 0.0, *rest: float) -> list[float]:
    """A row of robots: a disc, or with ``rest`` its radius, heading and yaw rate."""
    radius, yaw, w = rest or (BODY, 0.0, 0.0)
    return [x, y, vx, vy, radius, radius + 0.25, yaw, w]


class _Walk:
    """Everybody gets back to the way to the goal within half a second, through everything."""

    contact_stiffness = 0.0

    def accelerations(self, view: CrowdView) -> Array:
        offset = view.goal - view.position
        way = offset / np.maximum(np.hypot(offset[:, 0], offset[:, 1]), 1e-9)[:, None]
        return np.asarray((way * view.agents.preferred_speed[:, None] - view.velocity) / 0.5)


class Meeting:
    """People who walk straight on, through everything, but for what they do about robots.

    Args:
        people: where they start.
        velocities: how they walk.
        robots: rows; robots keep their course.
        late: who notices late.
        outline: as of `robot_contact`.
        response: how they respond.
    """

    def __init__(
        self,
        people: Sequence[Place],
        velocities: Sequence[Place],
        robots: Sequence[Sequence[float]],
        late: bool | Sequence[bool] = False,
        outline: Array = DISC,
        response: Human | None = None,
    ) -> None:
        at, v = np.array(people), np.array(velocities)
        speed = np.hypot(v[:, 0], v[:, 1])
        ways = v / np.maximum(speed, 1e-12)[:, None]
        agents = Agents.of(
            x=at[:, 0], y=at[:, 1], preferred_speed=speed, late=late,
            routes=[[tuple(p)] for p in (at + FAR * ways).tolist()],
        )  # fmt: skip
        world = CrowdWorld(response=response or Human())
        self.engine, self.outline = CrowdEngine(agents, world, _Walk()), outline
        self.robots = np.array(robots, np.float64).reshape(-1, 8)
        self.flat = self.engine.initial_state(max(1, len(self.robots)))
        self.people = s.view(self.flat)[1]
        self.accelerations: list[Array] = []

    @property
    def now(self) -> float:
        """s."""
        return float(self.flat[s.TICK]) * TICK

    def tick(self) -> None:
        """One tick of people and robots."""
        before = self.people[:, s.VX : s.VY + 1].copy()
        self.engine.advance(self.flat, self.robots, self.outline)
        self.robots[:, :2] += self.robots[:, 2:4] * TICK
        self.robots[:, 6] += self.robots[:, 7] * TICK
        self.accelerations.append((self.people[:, s.VX : s.VY + 1] - before) / TICK)

    def run(self, seconds: float, until: Callable[[], bool] = lambda: False) -> Meeting:
        """Go on for a while, or until something has happened."""
        end = self.now + seconds
        while self.now < end and not until():
            self.tick()
        return self

    @property
    def touched(self) -> bool:
        """Whether anybody has touched a robot."""
        each = (s.contact_with(self.flat, k)[1] for k in range(len(self.robots)))
        return any(np.any(t[:, s.TOUCHES] + t[:, s.TOUCHING]) for t in each)

    @property
    def peak(self) -> float:
        """Largest acceleration of anybody so far, m/s^2."""
        return float(np.max(np.hypot(*np.moveaxis(np.array(self.accelerations), -1, 0))))

    @property
    def state(self) -> bytes:
        """Everything about the people."""
        return self.flat.tobytes()
