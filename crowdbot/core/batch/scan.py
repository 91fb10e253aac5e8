"""Lidar readings in one world, compiled; rays are those of `crowdbot.core.sensing`.

Ranges, incidence limits, digits and dropouts are those of `RangeModel`. Noise has the same
distributions, but random numbers of its own counter.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.batch import scanner_tables as c
from crowdbot.core.batch.array_tables import floats1, floats2, floats3, ints1, ints2, mask1
from crowdbot.core.batch.scanner_tables import SCANNER, ScannerRecord
from crowdbot.core.crowd.contact.robot_contact import RobotRecord
from crowdbot.core.crowd.state import PRESENT, People
from crowdbot.core.crowd.velocity_search.counter_rng import uniform
from crowdbot.core.sensing.appearance_model import place_looks, place_things
from crowdbot.core.sensing.body_model import place_people
from crowdbot.core.sensing.raycast_columns import cast_columns
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows, as_record
from crowdbot.core.support.ticks import TICKS_PER_SECOND
from crowdbot.core.types.arrays import Array, Indices

_SLACK = 1e-9  # as in `crowdbot.core.support.ticks`


@kernel
def is_due(tick: int, rate: float) -> bool:
    """Return True if a sensor with this rate is read at a tick."""
    if tick == 0:
        return True
    now = math.floor(tick * rate / TICKS_PER_SECOND + _SLACK)
    return bool(now > math.floor((tick - 1) * rate / TICKS_PER_SECOND + _SLACK))


@kernel
def scan(
    own: Indices, people: People, robots: Rows[RobotRecord], tick: int, key: np.uint64
) -> None:
    """Write the ranges of a scanner, m; inf without a return.

    Args:
        own: (F, 4) entries of a `scanner_table`.
        people, robots: (N,), (R,) of the world.
        tick: the present one.
        key: of the random numbers of this scanner and episode.
    """
    sensor = as_record(floats1(own, c.OWN), SCANNER)
    _place(own, people, robots)
    robot = robots[int(sensor.robot)]
    cos, sin = math.cos(robot.yaw), math.sin(robot.yaw)
    ranges, incidence = floats2(own, c.RANGES), floats2(own, c.INCIDENCE)
    cast_columns(
        robot.x + cos * sensor.x - sin * sensor.y, robot.y + sin * sensor.x + cos * sensor.y,
        sensor.z, robot.yaw + sensor.yaw, sensor.most, sensor.floor != 0.0,
        floats1(own, c.AZIMUTH), floats1(own, c.COS), floats1(own, c.SIN), floats1(own, c.SLOPE),
        floats1(own, c.SLOPE_SCALE), floats3(own, c.WORK), ints1(own, c.FILLED),
        floats2(own, c.DIRECTIONS), ints2(own, c.RUNS), floats2(own, c.WALLS),
        floats2(own, c.WALL_HEIGHTS), floats2(own, c.DISCS), ints1(own, c.OWNER),
        ints1(own, c.ORDER), floats1(own, c.BOUND), ranges, incidence, ints2(own, c.BODY),
    )  # fmt: skip
    for r in range(incidence.shape[0]):
        for k in range(incidence.shape[1]):
            if incidence[r, k] > sensor.most_incidence:
                ranges[r, k] = math.inf
    _disturb(ranges, floats2(own, c.NOISE), tick, key)
    _finish(ranges, sensor, tick, key)
    sensor.new = 1.0


@kernel
def _place(own: Indices, people: People, robots: Rows[RobotRecord]) -> None:
    """Place people, their objects and the other robots in the scanner's scene."""
    rows, direction, walked = (
        floats2(own, c.PEOPLE),
        floats2(own, c.DIRECTION),
        floats1(own, c.WALKED),
    )
    present, discs = mask1(own, c.PRESENT), floats2(own, c.DISCS)
    for i in range(people.shape[0]):
        rows[i, 0], rows[i, 1] = people[i].x, people[i].y
        rows[i, 2], rows[i, 3] = people[i].vx, people[i].vy
        direction[i, 0], direction[i, 1] = people[i].dir_x, people[i].dir_y
        walked[i], present[i] = people[i].walked, people[i].waiting == PRESENT
    radius, height = floats1(own, c.RADIUS), floats1(own, c.HEIGHT)
    gait, things = floats2(own, c.GAIT), floats2(own, c.THINGS)
    if gait.shape[0] == 0:
        place_people(rows, present, direction, walked, radius, height, discs)
    else:
        place_looks(rows, present, direction, walked, radius, height, gait, discs)
        place_things(rows, present, direction, things, discs.shape[0] - things.shape[0], discs)
    _place_robots(own, robots, discs)


@kernel
def _place_robots(own: Indices, robots: Rows[RobotRecord], discs: Array) -> None:
    others, sides, walls = ints2(own, c.OTHERS), floats2(own, c.SIDES), floats2(own, c.WALLS)
    first = 0
    for o in range(others.shape[0]):
        robot, plate, count = (
            robots[others[o, c.O_ROBOT]],
            others[o, c.O_PLATE],
            others[o, c.O_PLATES],
        )
        if others[o, c.O_DISC] >= 0:
            discs[others[o, c.O_DISC], 0], discs[others[o, c.O_DISC], 1] = robot.x, robot.y
            continue
        cos, sin = math.cos(robot.yaw), math.sin(robot.yaw)
        for k in range(count):
            ax, ay = sides[first + k, 0], sides[first + k, 1]
            x, y = robot.x + cos * ax - sin * ay, robot.y + sin * ax + cos * ay
            walls[plate + k, 0], walls[plate + k, 1] = x, y
            walls[plate + (k + count - 1) % count, 2] = x
            walls[plate + (k + count - 1) % count, 3] = y
        first += count


@kernel
def _disturb(ranges: Array, noise: Array, tick: int, key: np.uint64) -> None:
    """Add noise to ranges (R, C)."""
    for n in range(noise.shape[0]):
        kind = int(noise[n, 0])
        for r in range(ranges.shape[0]):
            if kind == c.OFFSET:
                for k in range(ranges.shape[1]):
                    ranges[r, k] += noise[n, 1]
                continue
            for k in range(0, ranges.shape[1], 2):
                one, other = _normal_pair(key, r * ranges.shape[1] + k, tick, n)
                _add(ranges, r, k, noise[n], one, tick, key, n)
                if k + 1 < ranges.shape[1]:
                    _add(ranges, r, k + 1, noise[n], other, tick, key, n)


@kernel
def _add(
    ranges: Array, r: int, k: int, noise: Array, normal: float, tick: int, key: np.uint64, n: int
) -> None:
    """Add noise to one beam; noise of the kind ``PEAK`` only with its probability."""
    beam = r * ranges.shape[1] + k
    if int(noise[0]) != c.PEAK or uniform(key, beam, tick, n, 1) < noise[3]:
        ranges[r, k] += noise[1] + noise[2] * normal


@kernel
def _normal_pair(key: np.uint64, beam: int, tick: int, n: int) -> tuple[float, float]:
    """Return two standard normal numbers of one draw (Box and Muller, 1958)."""
    bits = uniform(key, beam, tick, n, 0) * 67108864.0  # 2 ** 26
    high = math.floor(bits)
    size = math.sqrt(-2.0 * math.log((high + 0.5) / 67108864.0))
    angle = 2.0 * math.pi * (bits - high)
    return size * math.cos(angle), size * math.sin(angle)


#: Purpose of the draws of dropouts.
_LOST = 1000


@kernel
def _finish(ranges: Array, sensor: ScannerRecord, tick: int, key: np.uint64) -> None:
    """Keep hits within range, round them down to digits, and lose some."""
    for r in range(ranges.shape[0]):
        for k in range(ranges.shape[1]):
            if ranges[r, k] < math.inf:
                ranges[r, k] = min(max(ranges[r, k], sensor.least), sensor.most)
                if sensor.step > 0.0:
                    whole = math.floor(ranges[r, k] / sensor.step) * sensor.step
                    ranges[r, k] = max(whole, sensor.least)
            if sensor.dropout > 0.0:
                beam = r * ranges.shape[1] + k
                if uniform(key, beam, tick, _LOST, 0) < sensor.dropout:
                    ranges[r, k] = math.inf
