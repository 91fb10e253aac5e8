r"""Do our SARL and ORCA drive as published? A replication card of the source's own test.

Runs the test of CrowdNav (Chen, Liu, Kreiss, Alahi, ICRA 2019) in a small loop of its own: five
people cross a circle, the robot goes from its lowest point to its highest, in steps of 0.25 s:

    python benchmarks/learned_replication.py weights.pth --people orca --radius 4 --cases 500
    python benchmarks/learned_replication.py weights.npz --people sfm --radius 7 --step 0.0125
    python benchmarks/learned_replication.py orca

With ``orca`` in place of weights the robot takes ORCA's velocity, with the parameters of people.

People walk by ORCA (the parameters of CrowdNav), by the social force model with Guo's modification,
or by the headed one (the models and numbers of Social-Navigation-PyEnvs, with which weights for
these were trained). They do not see the robot, unless ``--visible``. A case ends at the goal, with
a touch, or after ``--limit`` seconds. With ``--truth`` the robot knows where people will be after
its step, as in the authors' test (``query_env``); otherwise it takes their velocity as constant.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.support.compiling.compile import kernel
from crowdbot.plugin import read_weights
from crowdbot.plugins.planners.cadrl.cadrl_build import CadrlNetwork
from crowdbot.plugins.planners.sarl.sarl import SarlSpec
from crowdbot.plugins.planners.sarl.sarl_build import SarlNetwork
from crowdbot.plugins.planners.shared.half_planes_build import avoid, best_velocity
from crowdbot.plugins.planners.shared.learned_planner_build import LearnedPlanner
from crowdbot.plugins.planners.shared.value_search_build import ValueSearchRobot, actions

Array = NDArray[np.float64]
#: Radius of all, m; wanted speed of all, m/s; gap at the start, m; step of the robot, s.
RADIUS, SPEED, GAP, STEP = 0.3, 1.0, 0.2, 0.25
#: Columns of people: place, velocity, goal, heading, yaw rate.
X, Y, VX, VY, GX, GY, YAW, RATE = range(8)
#: ORCA of CrowdNav: horizon, s; range of neighbours, m; what is added to radii, m.
HORIZON, NEAR, MORE = 5.0, 10.0, 0.01
#: Social forces: mass kg, relaxation s, A N, B m, C N, D m, k1 N/m, k2 kg/(m s).
MASS, RELAX, A, B, C, D, K1, K2 = 80.0, 0.5, 2000.0, 0.08, 120.0, 0.6, 120e3, 240e3
#: Headed model: ko, kd kg/s, alpha, k_lambda 1/(m kg) as published.
KO, KD, ALPHA, LAMBDA = 1.0, 500.0, 3.0, 0.3
MODELS = {"orca": 0, "sfm": 1, "hsfm": 2}


@kernel
def _orca(people: Array, i: int, others: int, step: float, lines: Array) -> tuple[float, float]:
    count = 0
    for j in range(others):
        if j == i:
            continue
        dx, dy = people[j, X] - people[i, X], people[j, Y] - people[i, Y]
        if dx * dx + dy * dy < NEAR * NEAR:
            own, other = (people[i, VX], people[i, VY]), (people[j, VX], people[j, VY])
            both = 2.0 * (RADIUS + MORE)
            avoid((dx, dy), own, other, both, HORIZON, step, 0.5, lines[count])
            count += 1
    wx, wy = people[i, GX] - people[i, X], people[i, GY] - people[i, Y]
    long = math.sqrt(wx * wx + wy * wy)
    if long > SPEED:
        wx, wy = wx * SPEED / long, wy * SPEED / long
    return best_velocity(lines, count, 0, SPEED, (wx, wy), lines[count:])


@kernel
def _forces(people: Array, i: int, others: int) -> tuple[float, float, float, float]:
    """Return the desired and the social force on a person, N."""
    gx, gy = people[i, GX] - people[i, X], people[i, GY] - people[i, Y]
    away = math.sqrt(gx * gx + gy * gy)
    dx = dy = sx = sy = 0.0
    if away > RADIUS:
        dx = MASS * (gx / away * SPEED - people[i, VX]) / RELAX
        dy = MASS * (gy / away * SPEED - people[i, VY]) / RELAX
    for j in range(others):
        if j == i:
            continue
        nx, ny = people[i, X] - people[j, X], people[i, Y] - people[j, Y]
        apart = max(math.sqrt(nx * nx + ny * ny), 1e-9)
        nx, ny = nx / apart, ny / apart
        tx, ty = -ny, nx
        deep = 2.0 * RADIUS - apart
        slide = (people[j, VX] - people[i, VX]) * tx + (people[j, VY] - people[i, VY]) * ty
        push = A * math.exp(deep / B) + K1 * max(0.0, deep)
        side = C * math.exp(deep / D) + K2 * max(0.0, deep) * slide
        sx, sy = sx + push * nx + side * tx, sy + push * ny + side * ty
    return dx, dy, sx, sy


@kernel
def walk(people: Array, own: int, model: int, step: float, lines: Array, out: Array) -> None:
    """Write the people after one step; rows from ``own`` on, the visible robot, are left alone."""
    others = people.shape[0]
    for i in range(own):
        for c in range(8):
            out[i, c] = people[i, c]
        if model == 0:
            out[i, VX], out[i, VY] = _orca(people, i, others, step, lines)
        else:
            dx, dy, sx, sy = _forces(people, i, others)
            fx, fy = dx + sx, dy + sy
            if model == 2:
                fx, fy = _headed(people, i, (dx, dy, sx, sy), step, out)
            vx, vy = people[i, VX] + fx / MASS * step, people[i, VY] + fy / MASS * step
            speed = math.sqrt(vx * vx + vy * vy)
            share = min(1.0, SPEED / max(speed, 1e-9))
            out[i, VX], out[i, VY] = vx * share, vy * share
        out[i, X] = people[i, X] + out[i, VX] * step
        out[i, Y] = people[i, Y] + out[i, VY] * step


@kernel
def _headed(
    people: Array, i: int, force: tuple[float, float, float, float], step: float, out: Array
) -> tuple[float, float]:
    """Return the force that a person with a heading follows, and turn the heading."""
    dx, dy, sx, sy = force
    c, s = math.cos(people[i, YAW]), math.sin(people[i, YAW])
    ahead = (dx + sx) * c + (dy + sy) * s
    aside = KO * (sy * c - sx * s) - KD * (people[i, VY] * c - people[i, VX] * s)
    total = math.sqrt((dx + sx) ** 2 + (dy + sy) ** 2)
    off = people[i, YAW] - math.atan2(dy + sy, dx + sx)
    off -= 2.0 * math.pi * round(off / (2.0 * math.pi))
    turn = -LAMBDA * total * off
    turn -= (1.0 + ALPHA) * math.sqrt(LAMBDA * total / ALPHA) * people[i, RATE]
    out[i, YAW] = people[i, YAW] + people[i, RATE] * step
    out[i, RATE] = people[i, RATE] + turn * step
    return ahead * c - aside * s, ahead * s + aside * c


def crossing(rng: np.random.Generator, count: int, circle: float) -> Array:
    """Return people (N, 8) on a circle, with goals on its other side."""
    placed = np.array([[0.0, -circle, 0.0, circle]])
    while len(placed) <= count:
        angle = rng.random() * 2.0 * math.pi
        x, y = circle * np.array([math.cos(angle), math.sin(angle)]) + (rng.random(2) - 0.5) * SPEED
        starts = np.hypot(placed[:, 0] - x, placed[:, 1] - y)
        goals = np.hypot(placed[:, 2] - x, placed[:, 3] - y)
        if min(starts.min(), goals.min()) >= 2.0 * RADIUS + GAP:
            placed = np.vstack([placed, [x, y, -x, -y]])
    people = np.zeros((count, 8))
    people[:, [X, Y, GX, GY]] = placed[1:]
    people[:, YAW] = np.arctan2(-people[:, Y], -people[:, X])
    return people


def nearest(place: Array, relative: Array) -> float:
    """Return the least gap (m) to the robot on lines from places (K, 2), less both radii."""
    along = -(place * relative).sum(axis=1) / np.maximum((relative**2).sum(axis=1), 1e-12)
    on = place + np.clip(along, 0.0, 1.0)[:, None] * relative
    return float(np.hypot(*on.T).min()) - 2.0 * RADIUS


class Learned:
    """A robot that a value network drives."""

    def __init__(self, planner: LearnedPlanner, given: argparse.Namespace) -> None:
        self.planner, self.truth, self.yaw = planner, given.truth, 0.5 * math.pi
        self.unicycle = given.kinematics == "unicycle"
        self.choices = actions(SPEED, 5, 16, unicycle=self.unicycle)

    def velocity(self, robot: Array, people: Array, after: Array) -> Array:
        """Return its velocity (2,), m/s; ``robot`` and people are rows (8,), now and then."""
        known = people[:, [X, Y, VX, VY]].copy()
        known[:, :2] += STEP * known[:, 2:]
        ahead = np.column_stack(
            [after[:, [X, Y, VX, VY]] if self.truth else known, np.full(len(people), RADIUS)]
        )
        x, y, gx, gy = robot[[X, Y, GX, GY]]
        state = ValueSearchRobot(x, y, self.yaw, RADIUS, gx, gy, SPEED)
        speed, angle = self.choices[int(np.argmax(self.planner.worths(state, self.choices, ahead)))]
        self.yaw = self.yaw + angle if self.unicycle else angle
        return np.array([speed * math.cos(self.yaw), speed * math.sin(self.yaw)])


class Orca:
    """A robot that avoids people as they avoid each other, and takes half of it upon itself."""

    def velocity(self, robot: Array, people: Array, _: Array) -> Array:
        """Return its velocity (2,), m/s."""
        seen = np.vstack([people, robot])
        own = len(people)
        return np.array(_orca(seen, own, own, STEP, np.zeros((4 * (own + 2), 4))))


def case(
    driver: Learned | Orca, rng: np.random.Generator, given: argparse.Namespace
) -> tuple[str, float, float]:
    """Run one case; return how it ended, its time (s), and the least clearance (m)."""
    people = crossing(rng, given.humans, given.radius)
    own, least, t = len(people), math.inf, 0.0
    robot, goal = np.array([0.0, -given.radius]), np.array([0.0, given.radius])
    velocity = np.zeros(2)
    lines = np.zeros((4 * (own + 2), 4))
    while t < given.limit:
        seen, after = _after(people, robot, velocity, goal, given, lines)
        itself = np.array([*robot, *velocity, *goal, 0.0, 0.0])
        velocity = driver.velocity(itself, seen[:own], after)
        relative = (people[:, [VX, VY]] - velocity) * STEP
        least = min(least, nearest(people[:, :2] - robot, relative))
        robot = robot + velocity * STEP
        t += STEP
        if least < 0.0:
            return "hit", t, least
        if np.hypot(*(robot - goal)) < RADIUS:
            return "arrived", t, least
        people = after
    return "late", t, least


def _after(
    people: Array,
    robot: Array,
    velocity: Array,
    goal: Array,
    given: argparse.Namespace,
    lines: Array,
) -> tuple[Array, Array]:
    """Return the people, and the robot that they see, now; and people after a step of the robot."""
    seen = people
    if given.visible:
        seen = np.vstack([people, [*robot, *velocity, *goal, 0.0, 0.0]])
    now, out = seen.copy(), seen.copy()
    for _ in range(max(1, round(STEP / given.step))):
        walk(now, len(people), MODELS[given.people], given.step, lines, out)
        now, out = out, now.copy()
    return seen, now[: len(people)].copy()


def drivers(given: argparse.Namespace) -> Callable[[], Learned | Orca]:
    """Return what makes the robot under test, at its start."""
    if str(given.weights) == "orca":
        return Orca
    weights = read_weights(given.weights)
    network = (CadrlNetwork if "value_network.0.weight" in weights else SarlNetwork)(
        weights, str(given.weights)
    )
    spec = SarlSpec.model_validate(
        {"kind": "sarl", "weights": str(given.weights), "kinematics": given.kinematics}
    )
    return partial(Learned, LearnedPlanner(spec, network), given)


def main() -> None:
    """Run the cases and print success, hits, and mean time, with 95 % intervals (Wilson)."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("weights", type=Path, help=".pth, .npz, or the word orca")
    parser.add_argument("--people", choices=sorted(MODELS), default="orca")
    parser.add_argument("--humans", type=int, default=5)
    parser.add_argument("--radius", type=float, default=4.0, help="of the circle, m")
    parser.add_argument("--step", type=float, default=STEP, help="of people, s")
    parser.add_argument("--limit", type=float, default=25.0, help="s")
    parser.add_argument("--cases", type=int, default=500)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--visible", action="store_true", help="people see the robot")
    parser.add_argument("--truth", action="store_true", help="the robot knows their next step")
    parser.add_argument("--kinematics", choices=["holonomic", "unicycle"], default="holonomic")
    given = parser.parse_args()
    driver = drivers(given)
    ends = [
        case(driver(), np.random.default_rng([given.seed, n]), given) for n in range(given.cases)
    ]
    rates = {}
    for end in ("arrived", "hit", "late"):
        rates[end] = interval(sum(e[0] == end for e in ends), len(ends))
    times = [e[1] for e in ends if e[0] == "arrived"]
    values = {"weights": given.weights.name, "people": given.people, "visible": given.visible,
            "truth": given.truth, "radius": given.radius, "cases": len(ends), **rates,
            "time": round(float(np.mean(times)), 2) if times else None}  # fmt: skip
    print(json.dumps(values))


def interval(hits: int, count: int) -> list[float]:
    """Return a rate and its Wilson interval of 95 %."""
    z, rate = 1.96, hits / count
    middle = (rate + z * z / (2 * count)) / (1 + z * z / count)
    half = z / (1 + z * z / count) * math.sqrt(rate * (1 - rate) / count + z * z / (4 * count**2))
    return [round(v, 3) for v in (rate, max(0.0, middle - half), min(1.0, middle + half))]


if __name__ == "__main__":
    main()
