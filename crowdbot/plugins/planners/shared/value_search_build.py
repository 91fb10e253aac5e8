"""Actions, rewards and network inputs of CrowdNav's one-step search; compiled where hot.

Chen, Liu, Kreiss, Alahi, ICRA 2019, and their published configuration: an action's worth is the
reward of one step and the discounted value of the state after it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, kernel

#: Numbers of a joint state, the first ones of the robot.
OF_PAIR, OF_ROBOT = 13, 6
#: Rewards of the published configuration: goal, hit, and share of a missing clearance and second.
GOAL, HIT, CLOSE = 1.0, -0.25, 0.5


class ValueSearchRobot(NamedTuple):
    """The robot as the network sees it: m, m/s, rad."""

    x: float
    y: float
    yaw: float
    radius: float
    goal_x: float
    goal_y: float
    speed: float


def actions(speed: float, speeds: int, rotations: int, *, unicycle: bool) -> Array:
    """Return (1 + speeds * rotations, 2) speeds and directions, m/s and rad; the first is rest.

    Directions are absolute, or changes of the heading within 45° for a unicycle.
    """
    steps = (np.exp((np.arange(speeds) + 1) / speeds) - 1.0) / (math.e - 1.0) * speed
    if unicycle:
        turns = np.linspace(-math.pi / 4.0, math.pi / 4.0, rotations)
    else:
        turns = np.linspace(0.0, 2.0 * math.pi, rotations, endpoint=False)
    grid = np.column_stack([np.tile(steps, rotations), np.repeat(turns, speeds)])
    return np.vstack([[0.0, 0.0], grid])


@kernel
def look_ahead(
    robot: ValueSearchRobot,
    choices: Array,
    people: Array,
    times: tuple[float, float],
    unicycle: bool,
    states: NDArray[np.float32],
    rewards: Array,
) -> None:
    """Write the joint state after each action, and its reward.

    Args:
        robot: before the action.
        choices: (A, 2) from `actions`.
        people: (N, 5) x, y, vx, vy, radius, m and m/s: at the end of the step.
        times: length of the step, s, and clearance below which there is a penalty, m.
        unicycle: True if directions are changes of the heading.
        states: (A, N, 13), for the network.
        rewards: (A,).
    """
    step, discomfort = times
    for a in range(choices.shape[0]):
        yaw = robot.yaw + choices[a, 1] if unicycle else choices[a, 1]
        vx, vy = choices[a, 0] * math.cos(yaw), choices[a, 0] * math.sin(yaw)
        x, y = robot.x + vx * step, robot.y + vy * step
        gx, gy = robot.goal_x - x, robot.goal_y - y
        turn = math.atan2(gy, gx)
        c, s, away = math.cos(turn), math.sin(turn), math.sqrt(gx * gx + gy * gy)
        least = math.inf
        for i in range(people.shape[0]):
            dx, dy = people[i, 0] - x, people[i, 1] - y
            apart = math.sqrt(dx * dx + dy * dy)
            least = min(least, apart - robot.radius - people[i, 4])
            out = states[a, i]
            out[0], out[1] = away, robot.speed
            out[2] = yaw - turn if unicycle else 0.0
            out[3] = robot.radius
            out[4], out[5] = vx * c + vy * s, vy * c - vx * s
            out[6], out[7] = dx * c + dy * s, dy * c - dx * s
            out[8] = people[i, 2] * c + people[i, 3] * s
            out[9] = people[i, 3] * c - people[i, 2] * s
            out[10], out[11], out[12] = people[i, 4], apart, robot.radius + people[i, 4]
        rewards[a] = 0.0
        if least < 0.0:
            rewards[a] = HIT
        elif away < robot.radius:
            rewards[a] = GOAL
        elif least < discomfort:
            rewards[a] = (least - discomfort) * CLOSE * step


@kernel
def touches(choices: Array, yaw: float, points: Array, reach: tuple[float, float], k: int) -> bool:
    """Return True if action ``k`` would bring the robot to one of the points.

    Args:
        choices: (A, 2) speeds and directions.
        yaw: added to the directions, rad.
        points: (P, 2) from the robot, m.
        reach: radius that stays clear, m, and time, s.
    """
    angle = yaw + choices[k, 1]
    ux, uy, way = math.cos(angle), math.sin(angle), choices[k, 0] * reach[1]
    for i in range(points.shape[0]):
        along = points[i, 0] * ux + points[i, 1] * uy
        if along <= 0.0:
            continue  # it only comes farther
        on = min(along, way)
        dx, dy = points[i, 0] - on * ux, points[i, 1] - on * uy
        if dx * dx + dy * dy < reach[0] * reach[0]:
            return True
    return False
