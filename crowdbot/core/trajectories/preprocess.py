"""What happens to trajectories before any metric sees them: crop, valid steps, velocities, weights.

Section 1.1 of the metric specification. N samples, M people; world frame, SI units.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any, TypeVar

import numpy as np

from crowdbot.core.support.immutable import immutable
from crowdbot.core.trajectories.trajectories import (
    AgentTracks,
    ContactEvents,
    RobotTrack,
    Trajectories,
    Trips,
)
from crowdbot.core.types.arrays import Array, Mask
from crowdbot.errors import InputError

#: Two instants closer than this are one, s.
TIME_TOLERANCE = 1e-9
#: Slack of the teleport rule, m: rounding must not turn a step into a teleport.
STEP_TOLERANCE = 1e-9

_Table = TypeVar("_Table", Trips, ContactEvents)


# ----------------------------------------------------------------------- time
def truncate_at_arrival(run: Trajectories) -> Trajectories:
    """The run up to the robot's arrival; all of it when the robot never arrived, or is absent.

    Raises:
        InputError: the arrival lies before the first sample, or is not finite.
    """
    arrival = run.robot.goal_time if run.robot is not None else None
    if arrival is None:
        return truncate(run, float(run.t[-1]))
    if not run.t[0] - TIME_TOLERANCE <= arrival < np.inf:
        raise InputError(f"trajectories: goal_time {arrival} s is not after the first sample")
    return truncate(run, arrival)


def truncate(run: Trajectories, end: float) -> Trajectories:
    """The part of a run up to ``end`` (absolute, s), which must not precede the first sample.

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
    """Both runs, cut to the duration of the shorter record."""
    shorter = min(duration(a.t), duration(b.t))
    return truncate(a, float(a.t[0]) + shorter), truncate(b, float(b.t[0]) + shorter)


def samples_of_shorter(a: Trajectories, b: Trajectories) -> tuple[Trajectories, Trajectories]:
    """As `truncate_to_shorter`, for who asks for samples: the shorter run stays as it is.

    Its trips and contacts may end after its last sample.
    """
    shorter = min(duration(a.t), duration(b.t))
    first, second = (
        run if duration(run.t) == shorter else truncate(run, float(run.t[0]) + shorter)
        for run in (a, b)
    )
    return first, second


def duration(t: Array) -> float:
    """From the first to the last sample, s."""
    return float(t[-1] - t[0])


def travel_time(run: Trajectories, robot: RobotTrack) -> float:
    """Seconds to the arrival, which need not be a sample; to the last sample without arrival."""
    end = run.t[-1] if robot.goal_time is None else robot.goal_time
    return float(end - run.t[0])


def time_weights(t: Array) -> Array:
    """Trapezoidal weights (N,), s; they sum to the duration."""
    half = np.diff(t) / 2.0
    weights = np.zeros(len(t))
    weights[:-1] += half
    weights[1:] += half
    return weights


# ---------------------------------------------------------------------- steps
def valid_robot_steps(t: Array, robot: RobotTrack, jump_speed: float) -> Mask:
    """Steps (N-1,) with both poses known and no teleport (faster than ``jump_speed``, m/s)."""
    return _known_steps(robot.x, robot.y) & _plausible_steps(t, robot.x, robot.y, jump_speed)


def valid_agent_steps(t: Array, agents: AgentTracks, jump_speed: float) -> Mask:
    """Steps (N-1, M) of people who are present at both ends and are not teleported.

    Recorded jumps decide; where none were recorded, a step faster than ``jump_speed`` (m/s).
    """
    if agents.jump is not None:
        return _known_steps(agents.x, agents.y) & ~agents.jump
    return _known_steps(agents.x, agents.y) & _plausible_steps(t, agents.x, agents.y, jump_speed)


def path_length(t: Array, robot: RobotTrack, jump_speed: float) -> float:
    """Length of the robot's path over its valid steps, m; turning on the spot adds nothing."""
    valid = valid_robot_steps(t, robot, jump_speed)
    return float(np.hypot(_steps(robot.x), _steps(robot.y))[valid].sum())


def heading_changes(t: Array, robot: RobotTrack, jump_speed: float) -> Array:
    """Change of the robot's heading on each step (N-1,), rad; NaN where a step is not valid."""
    valid = valid_robot_steps(t, robot, jump_speed)
    return np.where(valid, wrap(_steps(inf_to_nan(robot.theta))), np.nan)


def inf_to_nan(values: Array) -> Array:
    """NaN for what is infinite: both are unknown."""
    return np.where(np.isfinite(values), values, np.nan)


def wrap(angle: Array) -> Array:
    """The same angles in (-pi, pi], rad."""
    wrapped: Array = np.pi - np.mod(np.pi - angle, 2.0 * np.pi)
    return wrapped


# ----------------------------------------------------------------- velocities
def with_velocities(run: Trajectories, jump_speed: float = 10.0) -> Trajectories:
    """The run with the velocities that were not recorded, derived from its positions.

    Where a run has them all, it is returned as it is. What cannot be derived stays NaN.

    Args:
        run: any run.
        jump_speed: a step that is faster is a teleport, m/s; the default that metrics have.
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
    """Velocities of a run; up to the arrival they do not know what comes after it."""
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
    """World velocity (N,), (N,) of the robot, m/s; derived where not recorded, NaN if neither."""
    valid = valid_robot_steps(t, robot, jump_speed)
    if robot.vx is not None and robot.vy is not None:
        return _completed(t, (robot.x, robot.y), (robot.vx, robot.vy), valid)
    theta = np.where(np.isfinite(robot.theta) & np.isfinite(robot.v), robot.theta, np.nan)
    recorded = (robot.v * np.cos(theta), robot.v * np.sin(theta))
    return _completed(t, (robot.x, robot.y), recorded, valid)


def forward_speed(t: Array, robot: RobotTrack, jump_speed: float) -> Array:
    """Signed forward speed of the robot (N,), m/s; derived where not recorded."""
    if np.all(np.isfinite(robot.v)):
        return robot.v
    vx, vy = robot_velocity(t, robot, jump_speed)
    theta = inf_to_nan(robot.theta)
    derived = vx * np.cos(theta) + vy * np.sin(theta)
    return np.where(np.isfinite(robot.v), robot.v, derived)


def yaw_rate(t: Array, robot: RobotTrack, jump_speed: float) -> Array:
    """Yaw rate of the robot (N,), rad/s; derived where not recorded."""
    if np.all(np.isfinite(robot.w)):
        return robot.w
    turn = heading_changes(t, robot, jump_speed)
    known = np.isfinite(turn)
    heading = np.concatenate([[0.0], np.where(known, turn, 0.0).cumsum()])
    return np.where(np.isfinite(robot.w), robot.w, _secant(t, heading, known))


def agent_velocities(t: Array, agents: AgentTracks, jump_speed: float) -> tuple[Array, Array]:
    """World velocities (N, M), (N, M) of people, m/s; NaN where absent or not derivable."""
    valid = valid_agent_steps(t, agents, jump_speed)
    return _completed(t, (agents.x, agents.y), (agents.vx, agents.vy), valid)


def present(x: Array, y: Array) -> Mask:
    """Where a position is known."""
    return np.isfinite(x) & np.isfinite(y)


def _completed(
    t: Array, position: tuple[Array, Array], recorded: tuple[Array, Array], valid: Mask
) -> tuple[Array, Array]:
    """Recorded velocities, the secant where there is none, NaN where the body is absent."""
    known, here = present(*recorded), present(*position)
    vx, vy = recorded
    if not np.array_equal(known & here, here):  # the usual case costs no derivation
        vx = np.where(known, vx, _secant(t, position[0], valid))
        vy = np.where(known, vy, _secant(t, position[1], valid))
    return np.where(here, vx, np.nan), np.where(here, vy, np.nan)


def _secant(t: Array, p: Array, valid: Mask) -> Array:
    """Slope over the valid steps on either side of each sample, NaN where both are invalid."""
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
    with np.errstate(invalid="ignore"):  # an infinite position is an unknown one
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
    trips = _rows(trips, trips.t0 <= end + TIME_TOLERANCE)
    late = trips.t1 > end + TIME_TOLERANCE
    return replace(trips, t1=np.where(late, end, trips.t1), reached=trips.reached & ~late)


def _first_contacts(contacts: ContactEvents, end: float) -> ContactEvents:
    contacts = _rows(contacts, contacts.t0 <= end + TIME_TOLERANCE)
    return replace(contacts, t1=np.minimum(contacts.t1, end))


def _rows(table: _Table, keep: Mask) -> _Table:
    return replace(table, **{f.name: getattr(table, f.name)[keep] for f in fields(table)})
