"""Trajectories: the typed arrays of a run, which are all that metrics may use.

The layout is that of the metric specification, section 1. Arrays are float64, read-only,
shape-checked.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any, Literal, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.support.arguments import expect
from crowdbot.core.support.immutable import immutable, immutable_fields
from crowdbot.core.trajectories.commands import Commands
from crowdbot.core.trajectories.from_recordings import FromRecordings
from crowdbot.core.trajectories.given_tracks import (
    agent_tracks,
    contact_events,
    given_arrival,
    given_speed_limit,
    read_only,
    robot_track,
    signals_of,
    trips_of,
)
from crowdbot.core.trajectories.tracks import AgentTracks, ContactEvents, RobotTrack, Trips
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.person_task import TaskPerson
from crowdbot.errors import InputError

_Cached = TypeVar("_Cached")
#: Stands for the run in its own cache. A reference to itself would keep its arrays, which may take
#: 100 MB, until the garbage collector runs.
_ITSELF = object()


def _for_all(value: _Cached) -> _Cached:
    """Return the value with read-only arrays."""
    found: Any = value
    if isinstance(found, np.ndarray):
        return cast(_Cached, immutable(found))
    if type(found) is tuple:
        return cast(_Cached, tuple(_for_all(part) for part in found))
    if is_dataclass(found):
        return cast(_Cached, immutable_fields(cast(Any, found)))
    return value


@dataclass(frozen=True, slots=True, kw_only=True)
class Trajectories(FromRecordings):
    """One run. ``robot`` or ``agents`` is None in the calibration runs.

    Attributes:
        t: (N,) sample times, s.
        goal_zone: (K, 2) polygon, m.
        walls: (S, 4) segments x0, y0, x1, y1, m.
        planner_step_time: (P,) seconds per planner step.
        robot_footprint: outline of the robot in its own frame (x forward), m: the (K, 2) corners
            of a polygon in either sense, K >= 3; or the (2, 2) ends of the axis of a capsule,
            whose radius is ``robot.radius``. None: a disc of ``robot.radius``.
        robot_speed_limit: the robot's top speed, m/s; None: unknown.
        signals: name -> (P, 2) time (s) and value.
        person: the person or group that the robot's task is about; None: the goal is a place.
        commands: of the robot's driver and its planner, where both were recorded.
    """

    t: Array
    robot: RobotTrack | None = None
    agents: AgentTracks | None = None
    trips: Trips | None = None
    goal_zone: Array | None = None
    contacts: ContactEvents | None = None
    walls: Array | None = None
    planner_step_time: Array | None = None
    robot_footprint: Array | None = None
    robot_speed_limit: float | None = None
    signals: Mapping[str, Array] = field(default_factory=dict)
    commands: Commands | None = None
    person: TaskPerson | None = None
    _cache: dict[Hashable, Any] = field(default_factory=dict, init=False, repr=False, compare=False)

    def cached(self, key: Hashable, compute: Callable[[], _Cached]) -> _Cached:
        """Return the result of ``compute`` for this run, cached for all metrics.

        A run never changes, and its cache is freed with it. Cached arrays (single, in tuples or
        dataclasses) are read-only.
        """
        if key not in self._cache:
            made = _for_all(compute())
            self._cache[key] = _ITSELF if made is self else made
        found = self._cache[key]
        return cast(_Cached, self if found is _ITSELF else found)

    @classmethod
    def from_arrays(
        cls,
        *,
        t: ArrayLike,
        robot_x: ArrayLike | None = None,
        robot_y: ArrayLike | None = None,
        robot_theta: ArrayLike | None = None,
        robot_v: ArrayLike | None = None,
        robot_w: ArrayLike | None = None,
        robot_vx: ArrayLike | None = None,
        robot_vy: ArrayLike | None = None,
        robot_radius: float | None = None,
        robot_mass: float | None = None,
        robot_goal_time: float | Literal["derived"] | None = "derived",
        robot_goal: tuple[float, float] | None = None,
        robot_goal_radius: float = 0.0,
        robot_speed_limit: float | None = None,
        agent_id: ArrayLike | None = None,
        agent_x: ArrayLike | None = None,
        agent_y: ArrayLike | None = None,
        agent_vx: ArrayLike | None = None,
        agent_vy: ArrayLike | None = None,
        agent_radius: ArrayLike | None = None,
        agent_mass: ArrayLike | None = None,
        agent_jump: ArrayLike | None = None,
        trip_agent: ArrayLike | None = None,
        trip_t0: ArrayLike | None = None,
        trip_t1: ArrayLike | None = None,
        trip_reached: ArrayLike | None = None,
        goal_zone: ArrayLike | None = None,
        contacts: Mapping[str, ArrayLike] | None = None,
        walls: ArrayLike | None = None,
        planner_step_time: ArrayLike | None = None,
        robot_footprint: ArrayLike | None = None,
        signals: Mapping[str, ArrayLike] | None = None,
        person: TaskPerson | None = None,
    ) -> Trajectories:
        """Build from plain arrays; ``robot_*`` or ``agent_*`` may be left out.

        An omnidirectional robot gives ``robot_vx`` and ``robot_vy`` (world frame, m/s), and may
        leave out ``robot_v``. Velocities that are left out, or NaN, are derived from positions
        and headings. ``robot_goal_time`` is when the robot arrived, s; None: never; left out, it is
        the first time within ``robot_goal_radius`` (or the robot's radius) of ``robot_goal``, or
        inside ``goal_zone``. ``robot_footprint`` is a polygon (K, 2), or the (2, 2) ends of a
        capsule of radius ``robot_radius``, in the robot's frame. ``contacts`` has the columns of
        `ContactEvents`, of which ``bearing`` may be left out.

        Raises:
            InputError: a shape is wrong, time does not increase, a part is missing.
        """
        if person is not None:
            expect("person", person, TaskPerson)
        arguments = locals()
        arguments["robot_goal_time"] = given_arrival(arguments)
        run = cls(
            t=read_only(t),
            robot=robot_track(arguments) if robot_x is not None else None,
            agents=agent_tracks(arguments) if agent_x is not None else None,
            trips=trips_of(arguments) if trip_agent is not None else None,
            goal_zone=None if goal_zone is None else read_only(goal_zone),
            contacts=None if contacts is None else contact_events(contacts),
            walls=None if walls is None else read_only(walls),
            planner_step_time=None if planner_step_time is None else read_only(planner_step_time),
            robot_footprint=None if robot_footprint is None else read_only(robot_footprint),
            robot_speed_limit=given_speed_limit(robot_speed_limit),
            signals=signals_of(signals or {}),
            person=person,
        )
        _check(run)
        _check_travellers(run)
        return run


def cached_beside(
    run: Trajectories, other: Trajectories, key: Hashable, compute: Callable[[], _Cached]
) -> _Cached:
    """Return the result of ``compute`` for two runs, cached like `Trajectories.cached`."""
    done: dict[int, tuple[Trajectories, _Cached]] = run.cached(("beside", key), dict)
    if id(other) not in done:  # keep the other run as well, so that its id is not reused
        done[id(other)] = other, _for_all(compute())
    return done[id(other)][1]


def _check_travellers(run: Trajectories) -> None:
    """Refuse trips of unknown people, which would be counted with wrong lengths."""
    if run.trips is None or run.agents is None:
        return
    unknown = np.setdiff1d(run.trips.agent, run.agents.id)
    if len(unknown):
        some = ", ".join(map(str, unknown[:3])) + (", …" if len(unknown) > 3 else "")
        raise InputError(f"trajectories: trip_agent has ids that no agent_id has: {some}")


def _check(run: Trajectories) -> None:
    n = len(run.t)
    if run.t.ndim != 1 or n == 0 or not np.all(np.isfinite(run.t)):
        raise InputError("trajectories: t must be a non-empty row of finite times")
    if np.any(np.diff(run.t) <= 0):
        raise InputError("trajectories: t must strictly increase")
    if run.robot is not None:
        for name in ("x", "y", "theta", "v", "w", "vx", "vy"):
            if getattr(run.robot, name) is not None:
                _check_shape(f"robot_{name}", getattr(run.robot, name), (n,))
        _check_non_negative("robot_radius", run.robot.radius)
        _check_non_negative("robot_mass", run.robot.mass)
        _check_non_negative("robot_goal_radius", run.robot.goal_radius)
    if run.agents is not None:
        m = run.agents.x.shape[1] if run.agents.x.ndim == 2 else 0
        _check_shape("agent_id", run.agents.id, (m,))
        if len(np.unique(run.agents.id)) < m:
            raise InputError("trajectories: agent_id holds a number twice")
        _check_non_negative("agent_radius", run.agents.radius)
        _check_non_negative("agent_mass", run.agents.mass)
        for name in ("x", "y", "vx", "vy"):
            _check_shape(f"agent_{name}", getattr(run.agents, name), (n, m))
        if run.agents.jump is not None:
            _check_shape("agent_jump", run.agents.jump, (n - 1, m))
    for table in (run.trips, run.contacts):
        if table is not None:
            k = table.agent.shape
            for column in fields(table):
                _check_shape(column.name, getattr(table, column.name), k)
    if run.trips is not None and not np.all(run.trips.t0 <= run.trips.t1):
        raise InputError("trajectories: trip_t0 and trip_t1 must be times, trip_t1 the later one")
    if run.walls is not None and run.walls.size:
        _check_shape("walls", run.walls, (len(run.walls), 4))
    for name, least in (("goal_zone", 3), ("robot_footprint", 2)):
        outline = getattr(run, name)
        if outline is not None:
            _check_outline(name, outline, least)


def _check_outline(name: str, corners: Array, least: int) -> None:
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < least:
        raise InputError(
            f"trajectories: {name} has shape {corners.shape}, expected (K, 2), K >= {least}"
        )
    if not np.all(np.isfinite(corners)):
        raise InputError(f"trajectories: {name} has a corner that is not finite")


def _check_non_negative(name: str, values: float | Array) -> None:
    if not (np.all(np.isfinite(values)) and np.all(np.asarray(values) >= 0)):
        raise InputError(f"trajectories: {name} must be finite and not negative")


def _check_shape(name: str, array: NDArray[Any], shape: tuple[int, ...]) -> None:
    if array.shape != shape:
        raise InputError(f"trajectories: {name} has shape {array.shape}, expected {shape}")
