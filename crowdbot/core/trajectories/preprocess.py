"""Preprocess trajectories for metrics: cropping, valid steps, velocities, weights.

Section 1.1 of the metric specification. N samples, M people; world frame, SI units.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any, TypeVar

import numpy as np

from crowdbot.core.support.immutable import immutable
from crowdbot.core.trajectories.tracks import AgentTracks, ContactEvents, RobotTrack, Trips
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Indices, Mask
from crowdbot.errors import InputError

#: Times closer than this are equal, s.
TIME_TOLERANCE = 1e-9
#: Tolerance of the teleport rule, m: rounding must not turn a step into a teleport.
STEP_TOLERANCE = 1e-9

_Table = TypeVar("_Table", Trips, ContactEvents)


# ----------------------------------------------------------------------- time
def truncate_at_arrival(run: Trajectories) -> Trajectories:
    """Return the run up to the robot's arrival; all of it without an arrival or robot.

    Raises:
        InputError: the arrival is before the first sample, or not finite.
    """
    arrival = run.robot.goal_time if run.robot is not None else None
    if arrival is None:
        return truncate(run, float(run.t[-1]))
    if not run.t[0] - TIME_TOLERANCE <= arrival < np.inf:
        raise InputError(f"trajectories: goal_time {arrival} s is not after the first sample")
    return truncate(run, arrival)


def truncate(run: Trajectories, end: float) -> Trajectories:
    """Return the part of a run up to ``end`` (absolute, s), at or after the first sample.

    Samples, trips and contacts that start later are dropped; trips that end later become
    unfinished at ``end``, contacts end there. Step times and signals, which need not lie on the
    grid of samples, stay whole.
    """
    return run.cached(("truncate", end), lambda: _truncate(run, end))


def _truncate(run: Trajectories, end: float) -> Trajectories:
    last = end + TIME_TOLERANCE
    if run.t[-1] <= last and not any(
        table is not None and np.any(table.t1 > last) for table in (run.trips, run.contacts)
    ):
        return run
    keep = int(np.searchsorted(run.t, last, side="right"))
    return replace(
        run,
        t=run.t[:keep],
        robot=None if run.robot is None else _first_robot_samples(run.robot, keep),
        agents=None if run.agents is None else _first_agent_samples(run.agents, keep),
        trips=None if run.trips is None else _first_trips(run.trips, end),
        contacts=None if run.contacts is None else _first_contacts(run.contacts, end),
    )


def truncate_to_shorter(a: Trajectories, b: Trajectories) -> tuple[Trajectories, Trajectories]:
    """Return both runs, cut to the duration of the shorter record."""
    shorter = min(duration(a.t), duration(b.t))
    return truncate(a, float(a.t[0]) + shorter), truncate(b, float(b.t[0]) + shorter)


def samples_of_shorter(a: Trajectories, b: Trajectories) -> tuple[Trajectories, Trajectories]:
    """Return both runs as in `truncate_to_shorter`, but keep the shorter run unchanged.

    Its trips and contacts may end after its last sample.
    """
    shorter = min(duration(a.t), duration(b.t))
    first, second = (
        run if duration(run.t) == shorter else truncate(run, float(run.t[0]) + shorter)
        for run in (a, b)
    )
    return first, second


def duration(t: Array) -> float:
    """Return the time from the first to the last sample, s."""
    return float(t[-1] - t[0])


def travel_time(run: Trajectories, robot: RobotTrack) -> float:
    """Return the time to the arrival, which need not be a sample, else to the last sample, s."""
    end = run.t[-1] if robot.goal_time is None else robot.goal_time
    return float(end - run.t[0])


def time_weights(t: Array) -> Array:
    """Return trapezoidal weights (N,), s; they sum to the duration."""
    half = np.diff(t) / 2.0
    weights = np.zeros(len(t))
    weights[:-1] += half
    weights[1:] += half
    return weights


# ---------------------------------------------------------------------- steps
def valid_robot_steps(t: Array, robot: RobotTrack, jump_speed: float) -> Mask:
    """Return steps (N-1,) with known poses and no teleport (faster than ``jump_speed``, m/s)."""
    return _known_steps(robot.x, robot.y) & _plausible_steps(t, robot.x, robot.y, jump_speed)


def valid_agent_steps(t: Array, agents: AgentTracks, jump_speed: float) -> Mask:
    """Return steps (N-1, M) of people who are present at both ends and not teleported.

    Recorded jumps decide; without a record, steps faster than ``jump_speed`` (m/s).
    """
    if agents.jump is not None:
        return _known_steps(agents.x, agents.y) & ~agents.jump
    return _known_steps(agents.x, agents.y) & _plausible_steps(t, agents.x, agents.y, jump_speed)


def path_length(t: Array, robot: RobotTrack, jump_speed: float) -> float:
    """Return the robot's path length over its valid steps, m; turning on the spot adds nothing."""
    valid = valid_robot_steps(t, robot, jump_speed)
    return float(np.hypot(_steps(robot.x), _steps(robot.y))[valid].sum())


def heading_changes(t: Array, robot: RobotTrack, jump_speed: float) -> Array:
    """Return the robot's change of heading per step (N-1,), rad; NaN on invalid steps."""
    valid = valid_robot_steps(t, robot, jump_speed)
    return np.where(valid, wrap(_steps(inf_to_nan(robot.theta))), np.nan)


def inf_to_nan(values: Array) -> Array:
    """Replace infinite values by NaN, since both mean unknown; without any, return ``values``."""
    infinite = np.isinf(values)
    return np.where(infinite, np.nan, values) if infinite.any() else values


def wrap(angle: Array) -> Array:
    """Return angles in (-pi, pi], rad."""
    wrapped: Array = np.pi - np.mod(np.pi - angle, 2.0 * np.pi)
    return wrapped


# ----------------------------------------------------------------- velocities
def with_velocities(run: Trajectories, jump_speed: float = 10.0) -> Trajectories:
    """Return the run with missing velocities derived from its positions.

    A run with all velocities is returned unchanged. Values that cannot be derived stay NaN.

    Args:
        run: any run.
        jump_speed: faster steps are teleports, m/s; the metrics' default.
    """
    return run.cached(("with_velocities", jump_speed), lambda: _with_velocities(run, jump_speed))


def _with_velocities(run: Trajectories, jump_speed: float) -> Trajectories:
    robot, agents = run.robot, run.agents
    if robot is not None and not _moves_are_known(robot):
        rows: dict[str, Any] = dict(_of_parts(run, lambda part: _robot_moves(part, jump_speed)))
        robot = replace(robot, **rows)
    if agents is not None:
        here = present(agents.x, agents.y)
        if not np.array_equal(present(agents.vx, agents.vy) & here, here):
            moves = _of_parts(run, lambda part: _agent_moves(part, jump_speed))
            agents = replace(agents, vx=moves["vx"], vy=moves["vy"])
    if robot is run.robot and agents is run.agents:
        return run
    return replace(run, robot=robot, agents=agents)


def _of_parts(
    run: Trajectories, moves: Callable[[Trajectories], dict[str, Array]]
) -> dict[str, Array]:
    """Return velocities of a run; those up to the arrival do not use later samples."""
    whole = moves(run)
    for name, values in moves(truncate_at_arrival(run)).items():
        whole[name] = immutable(np.concatenate([values, whole[name][len(values) :]]))
    return whole


def _robot_moves(run: Trajectories, jump_speed: float) -> dict[str, Array]:
    assert run.robot is not None
    t, robot = run.t, run.robot
    moves = {"v": forward_speed(t, robot, jump_speed), "w": yaw_rate(t, robot, jump_speed)}
    if robot.vx is not None:
        moves["vx"], moves["vy"] = robot_velocity(t, robot, jump_speed)
    return moves


def _agent_moves(run: Trajectories, jump_speed: float) -> dict[str, Array]:
    assert run.agents is not None
    vx, vy = agent_velocities(run.t, run.agents, jump_speed)
    return {"vx": vx, "vy": vy}


def _moves_are_known(robot: RobotTrack) -> bool:
    rows = (robot.v, robot.w, robot.vx, robot.vy)
    return all(bool(np.all(np.isfinite(row))) for row in rows if row is not None)


def robot_velocity(t: Array, robot: RobotTrack, jump_speed: float) -> tuple[Array, Array]:
    """Return the robot's world velocity (N,), (N,), m/s; derived if not recorded, else NaN."""
    valid = valid_robot_steps(t, robot, jump_speed)
    if robot.vx is not None and robot.vy is not None:
        return _completed(t, (robot.x, robot.y), (robot.vx, robot.vy), valid)
    theta = np.where(np.isfinite(robot.theta) & np.isfinite(robot.v), robot.theta, np.nan)
    recorded = (robot.v * np.cos(theta), robot.v * np.sin(theta))
    return _completed(t, (robot.x, robot.y), recorded, valid)


def forward_speed(t: Array, robot: RobotTrack, jump_speed: float) -> Array:
    """Return the robot's signed forward speed (N,), m/s; derived if not recorded."""
    if np.all(np.isfinite(robot.v)):
        return robot.v
    vx, vy = robot_velocity(t, robot, jump_speed)
    theta = inf_to_nan(robot.theta)
    derived = vx * np.cos(theta) + vy * np.sin(theta)
    return np.where(np.isfinite(robot.v), robot.v, derived)


def yaw_rate(t: Array, robot: RobotTrack, jump_speed: float) -> Array:
    """Return the robot's yaw rate (N,), rad/s; derived if not recorded."""
    if np.all(np.isfinite(robot.w)):
        return robot.w
    turn = heading_changes(t, robot, jump_speed)
    known = np.isfinite(turn)
    heading = np.concatenate([[0.0], np.where(known, turn, 0.0).cumsum()])
    return np.where(np.isfinite(robot.w), robot.w, _secant(t, heading, known))


def agent_velocities(t: Array, agents: AgentTracks, jump_speed: float) -> tuple[Array, Array]:
    """Return people's world velocities (N, M), (N, M), m/s; NaN if absent or not derivable."""
    valid = valid_agent_steps(t, agents, jump_speed)
    return _completed(t, (agents.x, agents.y), (agents.vx, agents.vy), valid)


def present(x: Array, y: Array) -> Mask:
    """Return a mask of known positions."""
    return np.isfinite(x) & np.isfinite(y)


def _completed(
    t: Array, position: tuple[Array, Array], recorded: tuple[Array, Array], valid: Mask
) -> tuple[Array, Array]:
    """Return recorded velocities, the secant if missing, and NaN if absent."""
    known, here = present(*recorded), present(*position)
    vx, vy = recorded
    if not np.array_equal(known & here, here):  # the usual case needs no derivation
        vx = np.where(known, vx, _secant(t, position[0], valid))
        vy = np.where(known, vy, _secant(t, position[1], valid))
    return np.where(here, vx, np.nan), np.where(here, vy, np.nan)


def _secant(t: Array, p: Array, valid: Mask) -> Array:
    """Return the slope over the valid steps beside each sample, NaN if both are invalid."""
    column = (slice(None), *([None] * (p.ndim - 1)))
    rise = np.where(valid, _steps(p), 0.0)
    run = np.where(valid, np.diff(t)[column], 0.0)
    none = np.zeros((1, *p.shape[1:]))
    rise_both = np.concatenate([none, rise]) + np.concatenate([rise, none])
    run_both = np.concatenate([none, run]) + np.concatenate([run, none])
    slope = np.full(p.shape, np.nan)
    np.divide(rise_both, run_both, out=slope, where=run_both > 0)
    return slope


# -------------------------------------------------------------------- details
def _known_steps(x: Array, y: Array) -> Mask:
    known = present(x, y)
    return known[1:] & known[:-1]


def _plausible_steps(t: Array, x: Array, y: Array, jump_speed: float) -> Mask:
    longest = jump_speed * np.diff(t) + STEP_TOLERANCE
    plausible: Mask = np.hypot(_steps(x), _steps(y)) <= longest.reshape(-1, *([1] * (x.ndim - 1)))
    return plausible


def _steps(p: Array) -> Array:
    with np.errstate(invalid="ignore"):  # an infinite position is unknown
        steps: Array = np.diff(p, axis=0)
    return steps


def _first_robot_samples(robot: RobotTrack, keep: int) -> RobotTrack:
    names = ("x", "y", "theta", "v", "w", "vx", "vy")
    rows = {name: getattr(robot, name) for name in names}
    return replace(robot, **{n: row[:keep] for n, row in rows.items() if row is not None})


def _first_agent_samples(agents: AgentTracks, keep: int) -> AgentTracks:
    rows = {name: getattr(agents, name)[:keep] for name in ("x", "y", "vx", "vy")}
    jump = None if agents.jump is None else agents.jump[: max(keep - 1, 0)]
    return replace(agents, **rows, jump=jump)


def _first_trips(trips: Trips, end: float) -> Trips:
    trips = rows_of(trips, trips.t0 <= end + TIME_TOLERANCE)
    late = trips.t1 > end + TIME_TOLERANCE
    return replace(trips, t1=np.where(late, end, trips.t1), reached=trips.reached & ~late)


def _first_contacts(contacts: ContactEvents, end: float) -> ContactEvents:
    contacts = rows_of(contacts, contacts.t0 <= end + TIME_TOLERANCE)
    return replace(contacts, t1=np.minimum(contacts.t1, end))


def rows_of(table: _Table, which: Mask | Indices) -> _Table:
    """Return some rows of a table of columns, in the order of indices if these are given."""
    return replace(table, **{f.name: getattr(table, f.name)[which] for f in fields(table)})
