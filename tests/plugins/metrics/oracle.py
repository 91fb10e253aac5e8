"""The harder metrics once more, as plain loops that follow the text of the specification.

Slow, and independent of the package: nothing of it is imported but the arrays.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from crowdbot.core.trajectories.trajectories import Trajectories

H, TOL, SLOW, RELEASE, JUMP = 5.0, 1e-9, 1e-6, 0.05, 10.0
Point = tuple[float, float]


class World:
    """A run up to the arrival, evaluated point by point."""

    def __init__(self, run: Trajectories) -> None:
        assert run.robot is not None
        assert run.agents is not None
        self.run, self.robot, self.agents = run, run.robot, run.agents
        end = math.inf if self.robot.goal_time is None else self.robot.goal_time
        self.t = [float(s) for s in run.t if s <= end + 1e-9]
        self.n, self.m = len(self.t), len(self.agents.id)

    def at(self, k: int, i: int) -> Point | None:
        """Position of a body; -1 is the robot."""
        body, index = (self.robot, k) if i < 0 else (self.agents, (k, i))
        x, y = float(body.x[index]), float(body.y[index])
        return (x, y) if math.isfinite(x) and math.isfinite(y) else None

    def valid(self, k: int, i: int) -> bool:
        """Whether step k to k + 1 is continuous."""
        a, b = self.at(k, i), self.at(k + 1, i)
        if a is None or b is None:
            return False
        if i >= 0 and self.agents.jump is not None:
            return not bool(self.agents.jump[k, i])
        return math.dist(a, b) <= JUMP * (self.t[k + 1] - self.t[k]) + 1e-9

    def velocity(self, k: int, i: int) -> Point | None:
        here = self.at(k, i)
        if here is None:
            return None
        if i < 0:
            v, theta = float(self.robot.v[k]), float(self.robot.theta[k])
            given = v * math.cos(theta), v * math.sin(theta)
        else:
            given = float(self.agents.vx[k, i]), float(self.agents.vy[k, i])
        if all(map(math.isfinite, given)):
            return given
        first = k - 1 if k > 0 and self.valid(k - 1, i) else k
        last = k + 1 if k + 1 < self.n and self.valid(k, i) else k
        if first == last:
            return None
        a, b = self.at(first, i), self.at(last, i)
        assert a is not None
        assert b is not None
        dt = self.t[last] - self.t[first]
        return (b[0] - a[0]) / dt, (b[1] - a[1]) / dt

    def weight(self, k: int) -> float:
        before = (self.t[k] - self.t[k - 1]) / 2 if k > 0 else 0.0
        after = (self.t[k + 1] - self.t[k]) / 2 if k + 1 < self.n else 0.0
        return before + after

    def reach(self, i: int) -> float:
        return self.robot.radius + float(self.agents.radius[i])

    def relative(self, k: int, i: int) -> Point | None:
        a, b = self.at(k, -1), self.at(k, i)
        return None if a is None or b is None else (b[0] - a[0], b[1] - a[1])

    def relative_velocity(self, k: int, i: int) -> Point | None:
        a, b = self.velocity(k, -1), self.velocity(k, i)
        return None if a is None or b is None else (b[0] - a[0], b[1] - a[1])

    def gap(self, k: int, i: int) -> float | None:
        p = self.relative(k, i)
        return None if p is None else math.hypot(*p) - self.reach(i)


def time_to_contact(world: World, k: int, i: int) -> float:
    """The smaller root of the quadratic, by its textbook form."""
    p, v = world.relative(k, i), world.relative_velocity(k, i)
    if p is None:
        return math.inf
    reach = world.reach(i)
    if math.hypot(*p) <= reach + TOL:
        return 0.0
    if v is None or math.hypot(*v) <= SLOW:
        return math.inf
    a, b = v[0] ** 2 + v[1] ** 2, p[0] * v[0] + p[1] * v[1]
    if b >= 0:
        return math.inf
    if abs(p[0] * v[1] - p[1] * v[0]) / math.sqrt(a) > reach + TOL:
        return math.inf
    c = p[0] ** 2 + p[1] ** 2 - reach**2
    return (-b - math.sqrt(max(b * b - a * c, 0.0))) / a


def risk(
    world: World, contact: Callable[[World, int, int], float] = time_to_contact
) -> dict[str, float]:
    """Sums over samples; contact is when the robot and person i meet, from sample k on, s."""
    found = {"literal": 0.0, "corrected": 0.0, "exposed_time": 0.0}
    found |= {"severity_literal": 0.0, "severity_corrected": 0.0}
    for k in range(world.n):
        each = [(contact(world, k, i), i) for i in range(world.m)]
        tau = min((e[0] for e in each), default=math.inf)
        if tau == math.inf:
            continue
        speeds = [world.relative_velocity(k, i) for s, i in each if s <= tau + 1e-9]
        square = max((math.hypot(*v) ** 2 for v in speeds if v is not None), default=0.0)
        soon = max(0.0, 1 - tau / H)
        found["literal"] += tau
        found["corrected"] += soon * world.weight(k)
        found["exposed_time"] += world.weight(k) if tau < H else 0.0
        found["severity_literal"] += square * tau
        found["severity_corrected"] += square * soon * world.weight(k)
    return found


def collisions(world: World) -> dict[str, float]:
    """Events by a state machine that looks at each step in many small parts."""
    found = dict.fromkeys(
        ("literal", "corrected", "per_sample", "per_event", "energy", "impulse"), 0.0
    )
    for i in range(world.m):
        one, other = world.robot.mass, float(world.agents.mass[i])
        mu = one * other / (one + other)
        held = touched = False
        for k in range(world.n):
            gap = world.gap(k, i)
            joined = k > 0 and world.valid(k - 1, -1) and world.valid(k - 1, i)
            start = None
            if gap is None or not joined:
                held = False
            if gap is not None and joined and not held and _reaches(world, k - 1, i):
                held, start = True, k - 1
            if gap is not None and not joined and gap <= TOL:
                held, start = True, k
            if start is not None:
                v = world.relative_velocity(start, i)
                square = 0.0 if v is None else v[0] ** 2 + v[1] ** 2
                found["corrected"] += 1
                found["per_event"] += (one + other) / 2 * square
                found["energy"] += 0.5 * mu * square
                found["impulse"] += mu * math.sqrt(square)
            if gap is not None and gap > RELEASE + TOL:
                held = False
            touches = gap is not None and gap <= TOL
            if touches and not (touched and joined):
                found["literal"] += 1
            if touches:
                v = world.relative_velocity(k, i)
                found["per_sample"] += 0.0 if v is None else (one + other) / 2 * math.hypot(*v) ** 2
            touched = touches
    return found


def _reaches(world: World, k: int, i: int) -> bool:
    """Whether the discs touch anywhere on step k: golden search of the convex distance."""
    a, b = world.relative(k, i), world.relative(k + 1, i)
    assert a is not None
    assert b is not None

    def apart(s: float) -> float:
        return math.hypot(a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]))

    low, high = 0.0, 1.0
    for _ in range(100):
        third = (high - low) / 3
        if apart(low + third) < apart(high - third):
            high -= third
        else:
            low += third
    return apart((low + high) / 2) - world.reach(i) <= TOL


def overtakes(world: World) -> list[list[int]]:
    """Row over column; 0 is the robot."""
    bodies = range(-1, world.m)
    counts = [[0] * (world.m + 1) for _ in bodies]
    for a in bodies:
        for b in bodies:
            if a != b:
                counts[a + 1][b + 1] = _overtakes(world, a, b)
    return counts


def _overtakes(world: World, a: int, b: int) -> int:
    armed, count = False, 0
    for k in range(world.n - 1):
        va, vb = world.velocity(k, a), world.velocity(k, b)
        steady = world.valid(k, a) and world.valid(k, b)
        if va is None or math.hypot(*va) <= 0.1 or not steady:
            armed = False
            continue
        u = va[0] / math.hypot(*va), va[1] / math.hypot(*va)
        now, then = _along(world, k, a, b, u), _along(world, k + 1, a, b, u)
        if now[0] > 1e-6:
            armed = True
        if now[0] < -1e-6:
            armed = False
        if armed and then[0] < -1e-6:
            armed = False
            if vb is None or math.hypot(*vb) <= 0.1:
                continue
            angle = math.acos(max(-1.0, min(1.0, (u[0] * vb[0] + u[1] * vb[1]) / math.hypot(*vb))))
            if angle <= math.pi / 4 and abs(then[1]) <= 3:
                count += 1
    return count


def _along(world: World, k: int, a: int, b: int, u: Point) -> Point:
    p, q = world.at(k, a), world.at(k, b)
    assert p is not None
    assert q is not None
    dx, dy = q[0] - p[0], q[1] - p[1]
    return dx * u[0] + dy * u[1], dx * u[1] - dy * u[0]


def kaplan_meier(durations: list[float], reached: list[bool], limit: float) -> float:
    """Area under the curve, from event to event."""
    alive, area, before = 1.0, 0.0, 0.0
    for moment in sorted({d for d, r in zip(durations, reached, strict=True) if r and d <= limit}):
        area += alive * (moment - before)
        at_risk = sum(d >= moment for d in durations)
        ended = sum(d == moment and r for d, r in zip(durations, reached, strict=True))
        alive *= 1 - ended / at_risk
        before = moment
    return area + alive * (limit - before)


def proximity(world: World) -> dict[str, float | None]:
    literal = corrected = 0.0
    spread: list[tuple[float, float, int, float]] = []
    seen = False
    for k in range(world.n):
        relative = [p for i in range(world.m) if (p := world.relative(k, i)) is not None]
        if relative:
            seen = True
            least = min(math.hypot(*p) for p in relative)
            literal += 1 / least
            corrected += world.weight(k) / max(least, 0.1)
        near = [p for p in relative if math.hypot(*p) <= 3 + 1e-9]
        if near:
            distance = [math.hypot(*p) for p in near]
            mean = sum(distance) / len(near)
            deviation = math.sqrt(sum((d - mean) ** 2 for d in distance) / len(near))
            off = math.hypot(sum(p[0] for p in near), sum(p[1] for p in near)) / len(near)
            spread.append((deviation / mean, off / mean, len(near), world.weight(k)))
    total = world.t[-1] - world.t[0]
    pairs = [s for s in spread if s[2] > 1]
    return {
        "literal": literal if seen else None,
        "corrected": corrected / total if seen else None,
        "cv_literal": sum(s[0] for s in spread) / len(spread) if spread else None,
        "cv_corrected": _weighted([(s[0], s[3]) for s in pairs]),
        "barycentre": _weighted([(s[1], s[3]) for s in spread]),
    }


def _weighted(rows: list[tuple[float, float]]) -> float | None:
    return sum(v * w for v, w in rows) / sum(w for _, w in rows) if rows else None


def heading_similarity(world: World) -> dict[str, float | None]:
    ratios, above, below, some = [], 0.0, 0.0, False
    for k in range(world.n - 1):
        dt = world.t[k + 1] - world.t[k]
        rates = []
        for i in range(world.m):
            a, b = world.velocity(k, i), world.velocity(k + 1, i)
            if not world.valid(k, i) or a is None or b is None:
                continue
            if math.hypot(*a) > 0.1 and math.hypot(*b) > 0.1:
                rates.append(_turn(math.atan2(b[1], b[0]) - math.atan2(a[1], a[0])) / dt)
        if not rates or not world.valid(k, -1):
            continue
        some = True
        robot = _turn(float(world.robot.theta[k + 1]) - float(world.robot.theta[k])) / dt
        mean = sum(rates) / len(rates)
        if abs(mean) > 1e-9:
            ratios.append(robot / mean)
        above += dt * abs(robot)
        below += dt * sum(map(abs, rates)) / len(rates)
    return {
        "literal": sum(ratios) / len(ratios) if ratios else None,
        "corrected": above / below if some and below > 1e-9 else None,
    }


def _turn(angle: float) -> float:
    while angle > math.pi:
        angle -= 2 * math.pi
    while angle <= -math.pi:
        angle += 2 * math.pi
    return angle


def velocity_similarity(world: World, radius: float) -> dict[str, float | None]:
    ratios, above, below = [], 0.0, 0.0
    for k in range(world.n):
        robot = world.velocity(k, -1)
        speeds = []
        for i in range(world.m):
            v, p = world.velocity(k, i), world.relative(k, i)
            if v is not None and p is not None and math.hypot(*p) <= radius + 1e-9:
                speeds.append(math.hypot(*v))
        if robot is None or not speeds or sum(speeds) / len(speeds) <= 1e-9:
            continue
        mean = sum(speeds) / len(speeds)
        ratios.append(math.hypot(*robot) / mean)
        above += world.weight(k) * math.hypot(*robot)
        below += world.weight(k) * mean
    return {
        "literal": sum(ratios) / len(ratios) if ratios else None,
        "corrected": above / below if below > 0 else None,
    }
