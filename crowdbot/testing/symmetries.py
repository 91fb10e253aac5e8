"""Transformed runs whose effect on scores is known: moved, rotated, mirrored, later, and more."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from crowdbot.core.trajectories.commands import Commands
from crowdbot.core.trajectories.preprocess import rows_of
from crowdbot.core.trajectories.tracks import AgentTracks, RobotTrack
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.person_task import PersonSide

Change = Callable[[Trajectories], Trajectories]

_SHIFT, _TURN, _DELAY = (17.0, -4.0), 2.1, 64.0


def without_velocities(run: Trajectories) -> Trajectories:
    """Return the same motion with only positions and headings recorded."""
    robot, agents = run.robot, run.agents
    if robot is not None:
        unknown = np.full(robot.x.shape, np.nan)
        robot = replace(robot, v=unknown, w=unknown, vx=None, vy=None)
    if agents is not None:
        unknown = np.full(agents.x.shape, np.nan)
        agents = replace(agents, vx=unknown, vy=unknown)
    return replace(run, robot=robot, agents=agents)


def move(
    run: Trajectories, *, angle: float = 0.0, shift: tuple[float, float] = (0, 0), mirror: int = 1
) -> Trajectories:
    """Return the run mirrored about x (``mirror=-1``), rotated (``angle``, rad) and shifted (m)."""
    c, s = math.cos(angle), math.sin(angle)

    def rotate(x: Any, y: Any) -> tuple[Any, Any]:
        return c * x - s * mirror * y, s * x + c * mirror * y

    def place(x: Any, y: Any) -> tuple[Any, Any]:
        x, y = rotate(x, y)
        return x + shift[0], y + shift[1]

    def points(rows: Array | None) -> Array | None:
        """Return transformed rows of points (x, y) or segments (x0, y0, x1, y1), m."""
        if rows is None:
            return None
        pairs = [place(rows[:, i], rows[:, i + 1]) for i in range(0, rows.shape[1], 2)]
        return np.column_stack([column for pair in pairs for column in pair])

    robot, agents = run.robot, run.agents
    if robot is not None:
        robot = _move_robot(robot, place, rotate, mirror, angle)
    if agents is not None:
        (x, y), (vx, vy) = place(agents.x, agents.y), rotate(agents.vx, agents.vy)
        agents = replace(agents, x=x, y=y, vx=vx, vy=vy)
    body, contacts, person = run.robot_footprint, run.contacts, run.person
    if person is not None:
        person = replace(
            person,
            facing=mirror * person.facing + angle,
            task=replace(person.task, side=_side(person.task.side, mirror)),
        )
    if contacts is not None:
        contacts = replace(contacts, bearing=mirror * contacts.bearing)
    return replace(
        run,
        contacts=contacts,
        person=person,
        robot=robot,
        agents=agents,
        goal_zone=points(run.goal_zone),
        walls=points(run.walls),
        robot_footprint=None if body is None else body * (1, mirror),
    )


def _side(side: PersonSide, mirror: int) -> PersonSide:
    """Return the side of a person on which to go; left and right are swapped if mirrored."""
    swapped: dict[PersonSide, PersonSide] = {"left": "right", "right": "left", "either": "either"}
    return swapped[side] if mirror < 0 else side


def _move_robot(
    robot: RobotTrack, place: Any, rotate: Any, mirror: int, angle: float
) -> RobotTrack:
    x, y = place(robot.x, robot.y)
    sideways = robot.vx is not None and robot.vy is not None
    vx, vy = rotate(robot.vx, robot.vy) if sideways else (None, None)
    theta, w = mirror * robot.theta + angle, mirror * robot.w
    goal = None if robot.goal is None else place(*robot.goal)
    return replace(robot, x=x, y=y, theta=theta, w=w, vx=vx, vy=vy, goal=goal)


def shift_time(run: Trajectories, by: float) -> Trajectories:
    """Return the run with everything ``by`` seconds later."""
    robot, trips, contacts = run.robot, run.trips, run.contacts
    signals = {name: rows + np.array([by, 0.0]) for name, rows in run.signals.items()}
    if robot is not None and robot.goal_time is not None:
        robot = replace(robot, goal_time=robot.goal_time + by)
    if trips is not None:
        trips = replace(trips, t0=trips.t0 + by, t1=trips.t1 + by)
    if contacts is not None:
        contacts = replace(contacts, t0=contacts.t0 + by, t1=contacts.t1 + by)
    return replace(run, t=run.t + by, robot=robot, trips=trips, contacts=contacts, signals=signals)


def permute(run: Trajectories) -> Trajectories:
    """Return people and trips in the opposite order."""
    if run.agents is None:
        return run
    run = with_people(run, range(len(run.agents.id))[::-1])
    if run.trips is None:
        return run
    return replace(run, trips=rows_of(run.trips, np.arange(len(run.trips.agent))[::-1]))


def shift_commands(commands: Commands) -> Commands:
    """Return the commands at later times, by the shift of `RUN_SYMMETRIES`."""
    return replace(commands, t=commands.t + _DELAY, t_end=commands.t_end + _DELAY)


def mirror_commands(commands: Commands) -> Commands:
    """Return the commands with left and right swapped."""
    return replace(commands, w_user=-commands.w_user, w_sc=-commands.w_sc)


#: The same for commands, which have neither positions nor people.
COMMAND_SYMMETRIES: Mapping[str, Callable[[Commands], Commands]] = {
    "shift_time": shift_commands,
    "reflect": mirror_commands,
}
#: Transformations by their names in `crowdbot.dsl.spec.metric_invariants.SYMMETRIES`.
RUN_SYMMETRIES: Mapping[str, Change] = {
    "translate": lambda run: move(run, shift=_SHIFT),
    "rotate": lambda run: move(run, angle=_TURN),
    "reflect": lambda run: move(run, mirror=-1),
    "shift_time": lambda run: shift_time(run, _DELAY),
    "permute": permute,
}


# ------------------------------------------------------------------------- others
def with_people(run: Trajectories, columns: Sequence[int]) -> Trajectories:
    """Return only these people, in this order, with their trips and contacts."""
    agents, pick = run.agents, np.array(columns, dtype=int)
    if agents is None:
        return run
    rows = {n: getattr(agents, n)[:, pick] for n in ("x", "y", "vx", "vy")}
    ends = {n: getattr(agents, n)[pick] for n in ("id", "radius", "mass")}
    jump = None if agents.jump is None else agents.jump[:, pick]
    kept = AgentTracks(**rows, **ends, jump=jump)
    trips, contacts = run.trips, run.contacts
    if trips is not None:
        trips = rows_of(trips, np.isin(trips.agent, kept.id))
    if contacts is not None:
        contacts = rows_of(contacts, np.isin(contacts.agent, [*kept.id, -1]))
    return replace(run, agents=kept, trips=trips, contacts=contacts)


def scale_masses(run: Trajectories, factor: float) -> Trajectories:
    """Return the run with all masses, impulses and forces multiplied by ``factor``."""
    robot, agents, contacts = run.robot, run.agents, run.contacts
    if robot is not None:
        robot = replace(robot, mass=robot.mass * factor)
    if agents is not None:
        agents = replace(agents, mass=agents.mass * factor)
    if contacts is not None:
        scaled = {n: getattr(contacts, n) * factor for n in ("impulse", "peak_force")}
        contacts = replace(contacts, **scaled)
    return replace(run, robot=robot, agents=agents, contacts=contacts)


def perturb(run: Trajectories, size: float, seed: int) -> Trajectories:
    """Return the run with random errors up to ``size`` (m, rad, m/s) on poses and velocities."""
    rng = np.random.default_rng(seed)

    def off(values: Array) -> Array:
        return values + rng.uniform(-size, size, values.shape)

    robot, agents = run.robot, run.agents
    if robot is not None:
        rows: dict[str, Any] = {n: off(getattr(robot, n)) for n in ("x", "y", "theta", "v", "w")}
        if robot.vx is not None and robot.vy is not None:
            rows |= {"vx": off(robot.vx), "vy": off(robot.vy)}
        robot = replace(robot, **rows)
    if agents is not None:
        rows = {n: off(getattr(agents, n)) for n in ("x", "y", "vx", "vy")}
        agents = replace(agents, **rows)
    return replace(run, robot=robot, agents=agents)


def arrays_of(value: Any, path: str = "") -> dict[str, bytes]:
    """Return name -> bytes of every array and number in a run, to detect changes."""
    if isinstance(value, np.ndarray):
        return {path: value.tobytes()}
    if isinstance(value, Mapping):
        return {k: v for name in value for k, v in arrays_of(value[name], f"{path}.{name}").items()}
    if hasattr(value, "__dataclass_fields__"):
        parts = [(f.name, getattr(value, f.name)) for f in fields(value) if f.init]
        return {k: v for name, part in parts for k, v in arrays_of(part, f"{path}.{name}").items()}
    return {path: repr(value).encode()}


def writable_copy(value: Any) -> Any:
    """Return a copy with writable arrays, unlike a recorded run."""
    if isinstance(value, np.ndarray):
        return value.copy()
    if isinstance(value, Mapping):
        return {name: writable_copy(part) for name, part in value.items()}
    if hasattr(value, "__dataclass_fields__"):
        names = [f.name for f in fields(value) if f.init]
        return replace(value, **{n: writable_copy(getattr(value, n)) for n in names})
    return value
