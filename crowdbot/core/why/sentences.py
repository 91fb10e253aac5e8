"""The decisive moment in words: event, people involved, sensor data, planner's log."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator

import numpy as np

from crowdbot.core.geometry.footprint import body_side
from crowdbot.core.recording.reading.scans import ReplayScan
from crowdbot.core.support.text import plural
from crowdbot.core.trajectories.encounters import encounter, people, robot_of
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.trajectories.worst_moment import JUMP_SPEED
from crowdbot.core.types.ending import Ending
from crowdbot.core.why.causes import Cause
from crowdbot.core.why.decisive_moment import DecisiveMoment, late_moment

_SIDES = {"front": "ahead", "left": "on the left", "right": "on the right", "rear": "behind"}
_SIDES_OF_ROBOT = {
    "front": "ahead of", "left": "left of", "right": "right of", "rear": "behind",
}  # fmt: skip
#: The beginning of a reason that names the planner, and its file.
_PLANNER = re.compile(r"^planner '[^']*'( \([^)]*\))?:? ")
#: Sensors that have a line of their own.
_NEAREST = 4


def what_happened(run: Trajectories, moment: DecisiveMoment, reason: str = "") -> list[str]:
    """Return the event, and the motion of the person and the robot, in words.

    Args:
        reason: why the run ended; included if the planner failed.
    """
    sample = max(0, int(np.searchsorted(run.t, moment.t, side="right")) - 1)
    happened = moment.cause.happened.format(stood=moment.stood)
    if moment.cause == Ending.PLANNER_FAILED and reason:
        happened += f": {_PLANNER.sub('', reason)}"
    return [f"{moment.t:.1f} s: {happened}", *_person(run, moment, sample), _robot(run, sample)]


def why_late(run: Trajectories) -> str:
    """Return what a robot did that ran out of time."""
    moment = late_moment(run)
    if moment.cause == Cause.BLOCKED:
        return f"it stood for {moment.stood:.1f} s from {moment.t:.1f} s on"
    return "it moved until time was up"


def what_was_seen(
    run: Trajectories, moment: DecisiveMoment, scans: Iterable[ReplayScan]
) -> list[str]:
    """Return the readings of each sensor at that moment, and the planner's log, in words."""
    return [*_seen(scans, moment.t), *_logged(run, moment.t)]


def _person(run: Trajectories, moment: DecisiveMoment, sample: int) -> Iterator[str]:
    if moment.agent is None:
        return
    pair, crowd, agent = encounter(run, JUMP_SPEED), people(run), moment.agent
    gap = float(pair.gap[sample, agent])
    if not math.isfinite(gap):
        return
    bearing = math.atan2(pair.py[sample, agent], pair.px[sample, agent]) - float(pair.theta[sample])
    speed = math.hypot(float(crowd.vx[sample, agent]), float(crowd.vy[sample, agent]))
    walks = f"walked at {speed:.2f} m/s" if speed > 0.05 else "stood"
    side = _SIDES_OF_ROBOT[body_side(bearing)]
    apart = f"{gap:.2f} m away" if gap > 0.0 else "in touch"
    yield f"person {int(crowd.id[agent])} {walks}, {side} the robot, {apart}"


def _robot(run: Trajectories, sample: int) -> str:
    robot = robot_of(run)
    left = ""
    if robot.goal is not None:
        x, y = robot.goal
        distance = math.hypot(x - float(robot.x[sample]), y - float(robot.y[sample]))
        left = f", {max(0.0, distance - robot.goal_radius):.1f} m from its goal"
    speed, rate = float(robot.v[sample]), math.degrees(float(robot.w[sample]))
    place = f"({float(robot.x[sample]):z.1f}, {float(robot.y[sample]):z.1f})"
    if abs(speed) < 0.005 and abs(rate) < 0.5:
        return f"the robot stood at {place}{left}"
    return f"the robot at {place} drove at {speed:z.2f} m/s and turned at {rate:z.0f} °/s{left}"


def _seen(scans: Iterable[ReplayScan], t: float) -> Iterator[str]:
    """Yield sentences on the nearest returns of range sensors, from their last reading before t."""
    found = sorted(_returns(scans, t))
    for _, text in found[:_NEAREST]:
        yield text
    if len(found) > _NEAREST:
        yield f"{plural(len(found) - _NEAREST, 'further sensor')} saw nothing nearer"


def _returns(scans: Iterable[ReplayScan], t: float) -> Iterator[tuple[float, str]]:
    """Yield each sensor's least distance, m, and a sentence about it."""
    for scan in scans:
        k = int(np.searchsorted(scan.t, t, side="right")) - 1
        if k < 0:
            continue
        row = scan.ranges[k]
        seen = np.isfinite(row)
        age = t - float(scan.t[k])
        if not seen.any():
            text = f"{scan.sensor} saw nothing within {scan.range_max:g} m, {age:.2f} s before"
            yield math.inf, text
            continue
        beam = int(np.argmin(np.where(seen, row, np.inf)))
        angle = scan.mount[3] + float(np.mean(scan.angles) if scan.cone else scan.angles[beam])
        side = _SIDES[body_side(angle)]
        yield float(row[beam]), f"{scan.sensor} saw {row[beam]:.2f} m {side}, {age:.2f} s before"


def _logged(run: Trajectories, t: float) -> Iterator[str]:
    """Yield the last value of each signal that the planner logged."""
    values = []
    for name, rows in run.signals.items():
        k = int(np.searchsorted(rows[:, 0], t, side="right")) - 1
        if k >= 0:
            values.append(f"{name} {rows[k, 1]:.4g}")
    if values:
        yield f"the planner logged {', '.join(values)}"
