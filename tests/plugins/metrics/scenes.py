"""Small worlds with known scores, and the changes of view that must not change a score."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.registry.registry import Plugin, Registry, assemble
from crowdbot.core.scoring.evaluate import score
from crowdbot.core.trajectories.commands import Commands
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.score import Score
from tests.built_in import built_in

Array = NDArray[np.float64]

ROBOT_RADIUS = 0.18
AGENT_RADIUS = 0.25
REACH = ROBOT_RADIUS + AGENT_RADIUS
REGISTRY: Registry = assemble(
    [Plugin(name="builtin", distribution="crowdbot", components=built_in("metric"))]
)


@dataclass(frozen=True)
class Body:
    """Positions and velocities (N,) of one body."""

    x: Array
    y: Array
    vx: Array
    vy: Array


def grid(end: float, dt: float = 0.1) -> Array:
    return np.linspace(0.0, end, round(end / dt) + 1, dtype=np.float64)


def line(t: Array, start: tuple[float, float], velocity: tuple[float, float]) -> Body:
    """Constant velocity."""
    vx, vy = velocity
    return Body(start[0] + vx * t, start[1] + vy * t, np.full(len(t), vx), np.full(len(t), vy))


def polyline(t: Array, corners: Sequence[tuple[float, float, float]]) -> Body:
    """Through (time, x, y), straight between them."""
    times, xs, ys = np.array(corners).T
    k = np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(times) - 2)
    step = np.diff(times)[k]
    return Body(
        np.interp(t, times, xs),
        np.interp(t, times, ys),
        np.diff(xs)[k] / step,
        np.diff(ys)[k] / step,
    )


def present_during(body: Body, here: NDArray[np.bool_]) -> Body:
    return Body(*(np.where(here, getattr(body, n), np.nan) for n in ("x", "y", "vx", "vy")))


def scene(
    t: ArrayLike,
    robot: Body | None = None,
    agents: Sequence[Body] = (),
    *,
    goal_time: float | None = None,
    agent_radius: ArrayLike = AGENT_RADIUS,
    velocities: bool = True,
    **more: Any,
) -> Trajectories:
    """A run; ``velocities=False`` leaves the people's velocities to be derived."""
    given: dict[str, Any] = {}
    if robot is not None:
        given |= {
            "robot_x": robot.x,
            "robot_y": robot.y,
            "robot_theta": np.arctan2(robot.vy, robot.vx),
            "robot_v": np.hypot(robot.vx, robot.vy),
            "robot_w": np.zeros(len(robot.x)),
            "robot_radius": ROBOT_RADIUS,
            "robot_mass": 6.3,
            "robot_goal_time": goal_time,
        }
    if agents:
        names = ("x", "y", "vx", "vy") if velocities else ("x", "y")
        given |= {f"agent_{n}": np.stack([getattr(a, n) for a in agents], 1) for n in names}
        given |= {"agent_radius": agent_radius, "agent_mass": 70.0}
    return Trajectories.from_arrays(t=t, **given, **more)


def driven(
    t: ArrayLike,
    *,
    v: ArrayLike = 0.0,
    w: ArrayLike = 0.0,
    goal_time: float | None = None,
    **more: Any,
) -> Trajectories:
    """A lone robot along its heading, with these speeds (m/s, rad/s)."""
    t = np.asarray(t, dtype=np.float64)
    speed, rate = (np.broadcast_to(np.asarray(a, dtype=np.float64), t.shape) for a in (v, w))

    def integral(values: Array) -> Array:
        steps = np.diff(t) * (values[1:] + values[:-1]) / 2
        return np.concatenate([[0.0], np.cumsum(steps)])

    theta = integral(rate)
    given = {
        "robot_x": integral(speed * np.cos(theta)),
        "robot_y": integral(speed * np.sin(theta)),
        "robot_theta": theta,
        "robot_radius": ROBOT_RADIUS,
        "robot_mass": 6.3,
        "robot_goal_time": goal_time,
    }
    return Trajectories.from_arrays(t=t, robot_v=speed, robot_w=rate, **{**given, **more})


def trips(*rows: tuple[int, float, float, bool]) -> dict[str, Any]:
    """Agent, start, end, reached."""
    agent, t0, t1, reached = zip(*rows, strict=True)
    return {"trip_agent": agent, "trip_t0": t0, "trip_t1": t1, "trip_reached": reached}


def scores_of(
    metric: str,
    run: Trajectories | None,
    robot_alone: Trajectories | None = None,
    crowd_alone: Trajectories | None = None,
    *,
    commands: Commands | None = None,
    commands_baseline: Commands | None = None,
    questionnaires: Mapping[str, Any] | None = None,
    **fields: Any,
) -> dict[str, Score]:
    """Variant -> score."""
    found = score(
        REGISTRY,
        run,
        robot_alone,
        crowd_alone,
        commands,
        commands_baseline,
        questionnaires,
        metrics=metric,
        parameters={metric: fields},
    )
    return {s.variant: s for s in found}


def values(found: dict[str, Score]) -> dict[str, float | None]:
    return {name: s.value for name, s in found.items()}


def why(found: dict[str, Score]) -> set[tuple[str, str]]:
    return {(s.status, s.reason) for s in found.values()}


def value_of(found: dict[str, Score], variant: str = "corrected") -> float:
    value = found[variant].value
    assert value is not None, found[variant]
    return value


# -------------------------------------------------------------- changes of view
def moved(
    run: Trajectories, *, angle: float = 0.0, shift: tuple[float, float] = (0, 0), mirror: int = 1
) -> Trajectories:
    """Mirror about the x axis, rotate, translate."""
    c, s = math.cos(angle), math.sin(angle)

    def turned(x: Array, y: Array) -> tuple[Array, Array]:
        return c * x - s * mirror * y, s * x + c * mirror * y

    def placed(x: Array, y: Array) -> tuple[Array, Array]:
        x, y = turned(x, y)
        return x + shift[0], y + shift[1]

    robot, agents = run.robot, run.agents
    if robot is not None:
        x, y = placed(robot.x, robot.y)
        theta, w = mirror * robot.theta + angle, mirror * robot.w
        robot = dataclasses.replace(robot, x=x, y=y, theta=theta, w=w)
    if agents is not None:
        (x, y), (vx, vy) = placed(agents.x, agents.y), turned(agents.vx, agents.vy)
        agents = dataclasses.replace(agents, x=x, y=y, vx=vx, vy=vy)
    return dataclasses.replace(run, robot=robot, agents=agents)


def later(run: Trajectories, by: float) -> Trajectories:
    robot = run.robot
    if robot is not None and robot.goal_time is not None:
        robot = dataclasses.replace(robot, goal_time=robot.goal_time + by)
    return dataclasses.replace(run, t=run.t + by, robot=robot)


def with_columns(run: Trajectories, columns: Sequence[int]) -> Trajectories:
    """Only these people, in this order."""
    agents, pick = run.agents, np.array(columns, dtype=int)
    assert agents is not None
    rows = {n: getattr(agents, n)[:, pick] for n in ("x", "y", "vx", "vy")}
    ends = {n: getattr(agents, n)[pick] for n in ("id", "radius", "mass")}
    jump = None if agents.jump is None else agents.jump[:, pick]
    return dataclasses.replace(run, agents=dataclasses.replace(agents, **rows, **ends, jump=jump))


def perturbed(run: Trajectories, size: float, seed: int) -> Trajectories:
    """Every position and velocity off by up to ``size``."""
    rng = np.random.default_rng(seed)

    def off(values: Array) -> Array:
        return values + rng.uniform(-size, size, values.shape)

    robot, agents = run.robot, run.agents
    if robot is not None:
        rows: dict[str, Any] = {n: off(getattr(robot, n)) for n in ("x", "y", "theta", "v", "w")}
        robot = dataclasses.replace(robot, **rows)
    if agents is not None:
        rows = {n: off(getattr(agents, n)) for n in ("x", "y", "vx", "vy")}
        agents = dataclasses.replace(agents, **rows)
    return dataclasses.replace(run, robot=robot, agents=agents)


# ------------------------------------------------------------------ random worlds
def random_scene(seed: int) -> Trajectories:
    """A robot on its way through up to six wandering people, some of whom come and go."""
    rng = np.random.default_rng(seed)
    n, m = int(rng.integers(2, 80)), int(rng.integers(1, 7))
    t = np.cumsum(rng.uniform(0.05, 0.15, n)) - 0.05
    agents = [_wanderer(rng, t) for _ in range(m)]
    here = rng.random((n, m)) > rng.choice([0.0, 0.1])
    goal_time = float(rng.uniform(t[0], t[-1] + 0.04)) if rng.random() < 0.7 else None
    return scene(
        t,
        _wanderer(rng, t),
        [present_during(a, here[:, i]) for i, a in enumerate(agents)],
        goal_time=goal_time,
        agent_radius=rng.uniform(0.2, 0.4, m),
        velocities=bool(rng.random() < 0.7),
        agent_jump=rng.random((n - 1, m)) < 0.02 if rng.random() < 0.5 else None,
    )


def _wanderer(rng: np.random.Generator, t: Array) -> Body:
    steps = np.diff(t, prepend=t[0])[:, None]
    velocity = rng.uniform(-1, 1, 2) + np.cumsum(rng.normal(0, 0.3, (len(t), 2)), axis=0) * 0.3
    position = rng.uniform(-2, 2, 2) + np.cumsum(velocity * steps, axis=0)
    return Body(position[:, 0], position[:, 1], velocity[:, 0], velocity[:, 1])


Change = Callable[[Trajectories], Trajectories]
