"""A person who walks in the crowd: body, position and commanded velocities.

Limits of a healthy adult: fastest walk 2.5 m/s, comfortable walk 1.4 m/s (Bohannon, "Comfortable
and maximum walking speed of adults aged 20-79 years", Age and Ageing 26, 1997, pp. 15-19: 2.53 and
1.39 m/s of men of 20 to 29); acceleration 2.4 m/s^2, which is the walking speed of 1.29 m/s over
the relaxation time of 0.54 s (Moussaid et al., "Experimental study of the behavioural mechanisms
underlying self-organization in human crowds", Proceedings of the Royal Society B 276, 2009).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

from crowdbot.core.environments.build import build_environment
from crowdbot.core.live.person.seat import Seat
from crowdbot.core.live.person.stick import CENTRED, Stick
from crowdbot.core.population.ground import Ground
from crowdbot.core.population.occupancy import Occupancy
from crowdbot.core.registry.registry import Registry
from crowdbot.core.types.arrays import Point
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.scenario.crowd import Crowd, NamedPolicy
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.spawning import Agent
from crowdbot.errors import InputError

FASTEST, COMFORTABLE, ACCELERATION = 2.5, 1.4, 2.4  # m/s, m/s, m/s^2
#: Number of the person, which no sampled person has.
PERSON = 1_000_000
#: Name of the person's policy, and the names of the recorded commands.
WALKER, SIGNALS = "walker", ("walker/vx", "walker/vy")
_LONG = 1e6  # s; a person without a goal of its own stays on no trip
_STEP = 0.5  # m, between places that are tried


@dataclass(frozen=True, kw_only=True)
class WalkerBody:
    """The body of a person who walks.

    Attributes:
        at: start, m; None: a free place.
        heading: direction of the first view, rad.
        goal: end of the person's trip, which is scored like others; None: no trip is scored.
        speed: of full deflection, m/s.
    """

    at: Point | None = None
    heading: float | None = None
    goal: Point | None = None
    speed: float = COMFORTABLE


def with_person(scenario: Scenario, registry: Registry, body: WalkerBody) -> Scenario:
    """Return the scenario with one more person, whose id has ``+walk`` at its end.

    Raises:
        InputError: the person's place is not free, or there is none.
    """
    policy = registry.find("crowd policy", WALKER).spec.model_validate({"kind": WALKER})
    crowd = scenario.crowd or Crowd(policy=policy)
    if crowd.names_nobody and crowd.policy.record is not None:
        raise InputError(f"{scenario.id} shows recorded people, whom no one can join")
    if WALKER in crowd.policies or any(agent.id == PERSON for agent in crowd.agents):
        raise InputError(f"{scenario.id} has a walker already")
    parts = build_environment(registry, scenario.environment)
    x, y = _place(scenario, crowd, parts, body.at)
    person = Agent(
        id=PERSON,
        x=x,
        y=y,
        heading=_heading(scenario, body, (x, y)),
        speed=min(body.speed, FASTEST),
        max_speed=FASTEST,
        max_acceleration=ACCELERATION,
        policy=WALKER,
        attention=0.0,
        goals=(body.goal or (x, y),),
        pauses=() if body.goal else (_LONG,),
        at_goal="stop",
    )
    changed = crowd.model_copy(
        update={
            "agents": (*crowd.agents, person),
            "policies": {**crowd.policies, WALKER: NamedPolicy(policy=policy)},
        }
    )
    return scenario.model_copy(update={"id": f"{scenario.id}+walk", "crowd": changed})


def _heading(scenario: Scenario, body: WalkerBody, at: Point) -> float:
    """Return the direction of the first view: default to the first robot, or to the goal."""
    if body.heading is not None:
        return body.heading
    starts = [robot.task.start[:2] for robot in scenario.robots.values()]
    x, y = body.goal or next(iter(starts), (at[0] + 1.0, at[1]))
    return math.atan2(y - at[1], x - at[0])


def _place(scenario: Scenario, crowd: Crowd, parts: EnvironmentParts, at: Point | None) -> Point:
    """Return where the person starts.

    Raises:
        InputError: the place is not free, or there is none.
    """
    free = Occupancy([r.task.start[:2] for r in scenario.robots.values()], Ground(parts, crowd))
    for agent in crowd.agents:
        free.add(agent.x, agent.y, agent.radius or crowd.body.radius)
    radius = crowd.body.radius
    if at is not None:
        if not free.is_free(*at, radius):
            raise InputError(
                f"--at {at[0]:g},{at[1]:g}: the place is not free: a wall, a person or a robot"
            )
        return at
    found = next((p for p in _places(parts) if free.is_free(*p, radius)), None)
    if found is None:
        raise InputError(f"{scenario.id} has no free place for a person; --at X,Y names one")
    return found


def _places(parts: EnvironmentParts) -> Iterator[Point]:
    """Yield places to try: middles of zones, then a grid over the walls, from its middle."""
    for zone in parts.zones.values():
        yield float(zone[:, 0].mean()), float(zone[:, 1].mean())
    if not len(parts.walls):
        yield 0.0, 0.0
        return
    xs, ys = parts.walls[:, ::2], parts.walls[:, 1::2]
    x0, x1, y0, y1 = float(xs.min()), float(xs.max()), float(ys.min()), float(ys.max())
    grid = [
        (x0 + _STEP * i, y0 + _STEP * j)
        for i in range(1, max(2, int((x1 - x0) / _STEP)))
        for j in range(1, max(2, int((y1 - y0) / _STEP)))
    ]
    middle = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
    yield from sorted(grid, key=lambda p: math.dist(p, middle))


@dataclass
class Steps:
    """Velocities that a person's stick commands, m/s, world frame; each step waits for real time.

    Attributes:
        yaw: direction of the view, rad.
    """

    seat: Seat
    speed: float
    yaw: float = field(default=0.0)

    def __call__(self, t: float) -> tuple[float, float]:
        """Return the velocity at a step."""
        self.seat.pace(t)
        taken = self.seat.take(t)
        stick = taken if isinstance(taken, Stick) else CENTRED
        ahead, aside = stick.ahead, stick.aside
        size = max(1.0, math.hypot(ahead, aside))
        v, w = self.speed * ahead / size, self.speed * aside / size
        c, s = math.cos(stick.yaw), math.sin(stick.yaw)
        return v * c - w * s, v * s + w * c


def led_by(source: Callable[[float], tuple[float, float]]) -> Callable[[Any, Any], None]:
    """Return a hook by which a source of velocities moves the person; its commands are recorded."""

    def on_crowd(engine: Any, signal: Callable[[float, str, float], None]) -> None:
        walker = next(p for p in engine.policies if getattr(p, "commanded", False))

        def recorded_velocity(t: float) -> tuple[float, float]:
            velocity = source(t)
            for name, value in zip(SIGNALS, velocity, strict=True):
                signal(t, name, value)
            return velocity

        walker.lead(recorded_velocity)

    return on_crowd
