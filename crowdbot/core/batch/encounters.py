"""The space that robots leave to people, as metrics measure it, at each step; compiled.

Gap, advance and demanded work are those of the metrics ``intrusion`` and ``push_work``, with their
default parameters, but computed once per step. The push of people who are forced aside is that of
the metric ``safe_efficiency``, computed at each tick.
"""

from __future__ import annotations

import math

from crowdbot.core.batch.robot_tables import DriveStateRecord
from crowdbot.core.crowd.contact.robot_contact import RobotRecord, corners_of, overlap
from crowdbot.core.crowd.state import PRESENT, People
from crowdbot.core.crowd.traits import TraitsRecord
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array

#: People farther off do not evade, m; a person with this gap has room, m.
_NEAR, _ROOM = 2.0, 0.75
#: Gap that people have to get, m; longest time before that they evade in, s.
_DEMANDED, _HORIZON = 0.5, 2.0
#: Nothing is planned in less than this, s, or with more than people reach, m/s^2.
_SOONEST, _MOST = 0.5, 3.0
#: Lower relative speeds bring no one nearer, m/s.
_STILL = 1e-3
#: People farther off than this have no part in a step, m.
_SIGHT = 8.0
#: Those whom the robot reaches sooner, if they stand, are forced aside, s; looks ahead until then.
_HEADWAY, _LOOKS = 0.5, 4
#: A person who is pushed by more in an episode is driven aside, J/kg.
FORCED_PUSH = 0.25
#: More than rounding.
_CLEARLY = 1.0 + 1e-9


@kernel
def meet(
    drive: DriveStateRecord, robot: RobotRecord, outlines: Array, r: int, people: People,
    traits: Rows[TraitsRecord], dt: float,
) -> None:  # fmt: skip
    """Compute ``gap``, ``advance`` and ``work`` of a step.

    Args:
        outlines: (R, K, 2) of the robots, of which this is number ``r``.
        dt: length of the step, s.
    """
    outline = outlines[r][: corners_of(outlines, r)]
    drive.gap, drive.advance, drive.work = math.inf, 0.0, 0.0
    for i in range(people.shape[0]):
        if people[i].waiting != PRESENT:
            continue
        px, py = people[i].x - robot.x, people[i].y - robot.y
        if px * px + py * py > _CLEARLY * max(_SIGHT, drive.gap) ** 2:
            continue  # roots are expensive
        away = math.hypot(px, py)
        if away > _SIGHT or away == 0.0:
            drive.gap = min(drive.gap, away)
            continue
        depth = overlap(robot.yaw, outline, -px, -py, robot.body + traits[i].radius)[0]
        gap = -depth
        drive.gap = min(drive.gap, gap)
        approach = max(0.0, (robot.vx * px + robot.vy * py) / away)
        if approach == 0.0:
            continue
        if away <= _NEAR:
            drive.advance += dt * approach * min(1.0, max(0.0, 1.0 - gap / _ROOM))
        wx, wy = people[i].vx - robot.vx, people[i].vy - robot.vy
        until = -(px * wx + py * wy) / max(wx * wx + wy * wy, _STILL * _STILL)
        if 0.0 < until < _HORIZON:
            miss = math.hypot(px + until * wx, py + until * wy)
            shift = max(0.0, away - gap + _DEMANDED - miss)
            need = min(_MOST, 2.0 * shift / max(until, _SOONEST) ** 2)
            drive.work += dt * need * approach * traits[i].mass


@kernel
def press(
    drive: DriveStateRecord, robot: RobotRecord, outlines: Array, r: int, people: People,
    traits: Rows[TraitsRecord], pressed: Array, dt: float,
) -> None:  # fmt: skip
    """Add a tick's push to ``drive.forced``, and people whom it drives aside to ``drive.aside``.

    Args:
        outlines: (R, K, 2) of the robots, of which this is number ``r``.
        pressed: (N,) the push of each person since the episode began, J/kg, changed.
        dt: length of the tick, s.
    """
    outline = outlines[r][: corners_of(outlines, r)]
    for i in range(people.shape[0]):
        pushed = people[i].push_x != 0.0 or people[i].push_y != 0.0
        if people[i].waiting != PRESENT or pushed:
            continue
        px, py = people[i].x - robot.x, people[i].y - robot.y
        far2 = px * px + py * py
        approach = robot.vx * px + robot.vy * py
        evades = people[i].ax * px + people[i].ay * py
        if far2 > _NEAR * _NEAR or approach <= 0.0 or evades <= 0.0:
            continue
        if _within_headway(robot, outline, px, py, robot.body + traits[i].radius):
            push = dt * evades * approach / far2
            drive.forced += push
            drive.aside -= driven_aside(pressed[i])
            pressed[i] += push
            drive.aside += driven_aside(pressed[i])


@kernel
def driven_aside(push: float) -> float:
    """Return how far a person counts as driven aside, 0 to 1; 1 as in the score.

    Below 1 it is the square of the push, so that small pushes cost little, but not nothing.
    """
    return min(1.0, (push / FORCED_PUSH) ** 2)


@kernel
def _within_headway(robot: RobotRecord, outline: Array, px: float, py: float, reach: float) -> bool:
    """Return True if a robot that keeps its velocity soon touches a person who stands.

    Args:
        px, py: of the person, from the robot, m.
        reach: rounding of the outline and radius of the person, m.
    """
    if overlap(robot.yaw, outline, -px, -py, reach)[0] >= 0.0:
        return False  # who is touched does not evade
    for k in range(1, _LOOKS + 1):
        t = _HEADWAY * k / _LOOKS
        x, y = robot.vx * t - px, robot.vy * t - py
        if overlap(robot.yaw, outline, x, y, reach)[0] >= 0.0:
            return True
    return False
