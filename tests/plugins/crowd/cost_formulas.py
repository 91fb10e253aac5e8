"""Eleven cost functions again, in plain Python, straight from their formulas.

Plane vectors are complex numbers. Nothing is shared with the compiled functions, nothing is
culled, tabulated or stopped early. ``parity`` turns on the quirks of the original engine.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

INF = math.inf
LARGEST = 3.4028234663852886e38  # of float32: "forbidden" in the original


@dataclass(frozen=True, kw_only=True)
class Other:
    """A neighbour; ``fixed`` for pillars."""

    p: complex
    v: complex
    r: float
    v_pref: complex = 0j
    fixed: bool = False


@dataclass(frozen=True, kw_only=True)
class Scene:
    """What one agent knows; outlines run counter-clockwise around solids."""

    p: complex = 0j
    v: complex = 0j
    r: float = 0.3
    s: float = 1.3
    s_max: float = 1.8
    goal: complex = 10 + 0j
    dt: float = 0.1
    tau: float = 0.5
    mass: float = 1.0
    others: list[Other] = field(default_factory=list)
    walls: list[tuple[complex, complex]] = field(default_factory=list)
    parity: bool = False

    @property
    def v_pref(self) -> complex:
        away = self.goal - self.p
        return 0j if abs(away) <= self.r else self.s * away / abs(away)

    def near(self, spec: Any) -> list[Other]:
        """Neighbours within the range of a cost function."""
        surface = spec.range.measure == "surface"
        return [
            o for o in self.others
            if abs(o.p - self.p) < spec.range.value + (self.r + o.r if surface else 0.0)
        ]  # fmt: skip

    def near_walls(self, spec: Any) -> list[tuple[complex, complex]]:
        """Walls within the range of a cost function."""
        limit = spec.range.value + (self.r if spec.range.measure == "surface" else 0.0)
        return [w for w in self.walls if abs(nearest(self.p, *w) - self.p) <= limit]

    def wall_points(self, spec: Any) -> list[complex]:
        """Nearest points of walls, each point once."""
        points: list[complex] = []
        for n in (nearest(self.p, a, b) for a, b in self.near_walls(spec)):
            if all(abs(n - m) > 1e-9 for m in points):
                points.append(n)
        return points


def dot(a: complex, b: complex) -> float:
    return (a.conjugate() * b).real


def cross(a: complex, b: complex) -> float:
    return (a.conjugate() * b).imag


def unit(a: complex) -> complex:
    return a / abs(a) if a != 0 else 0j


def angle(a: complex, b: complex) -> float:
    """Unsigned; 0 when either is zero."""
    return math.atan2(abs(cross(a, b)), dot(a, b)) if a != 0 and b != 0 else 0.0


def cosine(a: complex, b: complex) -> float:
    return dot(a, b) / (abs(a) * abs(b)) if a != 0 and b != 0 else 0.0


def nearest(p: complex, a: complex, b: complex) -> complex:
    """Point of segment a-b nearest to p."""
    along = dot(p - a, b - a) / abs(b - a) ** 2 if a != b else 0.0
    return b if along >= 1.0 else a + max(0.0, along) * (b - a)


def ratio(a: float, b: float) -> float:
    return a / b if b != 0.0 else (0.0 if a == 0.0 else math.copysign(INF, a))


# --- times to collision (section 5) ---------------------------------------------------------


def disc_time(away: complex, v: complex, reach: float, parity: bool = False) -> float:
    """Until a point at 0 with velocity v is ``reach`` from a point ``away``."""
    if abs(away) <= reach:
        return 0.0
    a, b, c = abs(v) ** 2, -2.0 * dot(away, v), abs(away) ** 2 - reach**2
    if a == 0.0:
        return 0.0 if parity else INF
    d = b * b - 4.0 * a * c
    if d <= 0.0 or b >= 0.0:
        return INF
    return (-b - math.sqrt(d)) / (2.0 * a)


def wall_time(a: complex, b: complex, v: complex, r: float, parity: bool = False) -> float:
    """Until a disc at 0 with velocity v touches segment a-b."""
    if abs(nearest(0j, a, b)) <= r:
        return 0.0
    ends = min(disc_time(a, v, r, parity), disc_time(b, v, r, parity))
    along, d = unit(b - a), cross(unit(b - a), a)  # the wall is |d| away, sideways
    closing = cross(along, v) * (1.0 if d > 0.0 else -1.0)
    if abs(cross(v, b - a)) < 1e-5 or closing <= 0.0:
        return ends
    touch = (abs(d) - r) / closing
    # Of the centre in the original; of the point that is touched in ours.
    at = dot(v * (abs(d) / closing if parity else max(touch, 0.0)) - a, along)
    return min(ends, max(0.0, touch)) if 0.0 <= at <= abs(b - a) else ends


def first_collision(s: Scene, spec: Any, u: complex, ignore: bool) -> float:
    """TTC1; ``ignore`` leaves out what is touched already."""
    times = [disc_time(o.p - s.p, u - o.v, s.r + o.r, s.parity) for o in s.near(spec)]
    times += [wall_time(a - s.p, b - s.p, u, s.r, s.parity) for a, b in s.near_walls(spec)]
    return min((t for t in times if t > 0.0 or not ignore), default=INF)


# --- costs that look for the first collision --------------------------------------------------


def karamouzas(k: Any, s: Scene, u: complex) -> float:
    t = first_collision(s, k, s.v_pref, True)
    if t >= 8.0:
        turn = 0.05
    elif t <= 0.0:
        turn = math.pi / 2
    elif t < 2.5:
        turn = math.pi / 6 + ((2.5 - t) / 2.5) ** 2 * math.pi / 3
    elif t < 6.0:
        turn = math.pi / 6
    else:  # the original jumps here, and below zero; ours is continuous
        fixed = 0.05 + (math.pi / 6 - 0.05) * (8.0 - t) / 2.0
        turn = 0.05 + math.pi / 6 - (8.0 - t) / 2.0 if s.parity else fixed
    speed, spread = abs(u), abs(s.s_max - s.s) + 0.05
    if t <= 0.0 or t >= 8.0:
        low, high = s.s - 0.05, s.s + 0.05
    elif t < 2.5:
        low, high = 0.0, s.s_max + 0.05
    else:
        low, high = s.s - spread, s.s + spread
    if angle(u, s.v_pref) > turn or not low <= speed <= high:
        return INF
    deviation = k.alpha * (1.0 - 0.5 * cosine(u, s.v_pref))
    deviation += k.beta * abs(speed - abs(s.v)) / s.s_max
    left = max(0.0, k.t_max - first_collision(s, k, u, True)) / k.t_max
    return float(deviation + k.gamma * abs(u - s.v_pref) / (2.0 * s.s_max) + k.delta * left)


def moussaid(k: Any, s: Scene, u: complex) -> float:
    t = first_collision(s, k, s.s * unit(u), False)
    free = min(k.d_max, t * s.s) if s.s > 0.0 else k.d_max
    course = k.d_max**2 + free**2 - 2.0 * k.d_max * free * cosine(u, s.v_pref) + 1.0
    safe = s.s if free >= s.s * s.tau else free / s.tau
    if safe <= 0.0:
        return INF if abs(u) > 0.0 else course
    return float(course * (1.0 + ((safe - abs(u)) / safe) ** 2))


def pledestrians(k: Any, s: Scene, u: complex) -> float:
    if first_collision(s, k, u, True) < k.t_min:
        return INF
    effort = k.t_max * (k.w_a + k.w_b * abs(u) ** 2)
    return float(effort + 2.0 * math.sqrt(k.w_a * k.w_b) * abs(s.goal - s.p - k.t_max * u))


def van_toll(k: Any, s: Scene, u: complex) -> float:
    speed = abs(u)
    free = min(k.max_distance, first_collision(s, k, u, False) * speed) if speed else 0.0
    pace = ratio(abs(speed - s.s), s.s)
    return float(k.max_distance - free + angle(u, s.v_pref) + pace + angle(u, s.v))


# --- ORCA -------------------------------------------------------------------------------------

Plane = tuple[complex, complex]  # a point and a normal: allowed is dot(u - point, normal) >= 0
BRAKING = 0.5  # s


def orca_plane(
    away: complex, w: complex, reach: float, horizon: float, dt: float, parity: bool
) -> tuple[complex, complex] | None:
    """The least change of the relative velocity w that avoids a disc, and its direction."""
    d2, gap2 = abs(away) ** 2, abs(away) ** 2 - reach**2
    if gap2 <= 0.0:
        out = w - away / dt
        if out == 0 and away == 0:
            return None
        n = unit(out) if out != 0 else -unit(away)
        if parity:
            n = out / abs(out) ** 2
            return (reach / dt - abs(out) ** 2) * n, n
        return (reach / dt - abs(out)) * n, n
    out = w - away / horizon
    if dot(out, away) < 0.0 and dot(out, away) ** 2 > reach**2 * abs(out) ** 2:
        n = unit(out)
        return (reach / horizon - abs(out)) * n, n
    # A leg of the cone: half the opening is asin(reach / distance).
    side = 1.0 if cross(away, out) > 0.0 else -1.0
    leg = away * complex(math.sqrt(gap2), side * reach) / d2
    n = leg * 1j * side
    return -dot(w, n) * n, n


def orca_planes(k: Any, s: Scene) -> list[Plane]:
    planes = []
    for o in s.near(k):
        change = orca_plane(o.p - s.p, s.v - o.v, s.r + o.r, k.time_horizon, s.dt, s.parity)
        if change:
            planes.append((s.v + (1.0 if o.fixed else 0.5) * change[0], change[1]))
    for a, b in [] if s.parity else s.near_walls(k):
        away = nearest(s.p, a, b) - s.p
        if away == 0:
            continue
        n = -unit(away)
        planes.append(((s.r - abs(away)) / BRAKING * n, n))
        if abs(away) > s.r:
            change = orca_plane(away, s.v, s.r, k.time_horizon, s.dt, False)
            assert change is not None
            planes.append((s.v + change[0], change[1]))
    return planes


def orca(k: Any, s: Scene, u: complex) -> float:
    worst = max((dot(point - u, n) for point, n in orca_planes(k, s)), default=0.0)
    return abs(u - s.v_pref) if worst <= 0.0 else worst + 2.0 * s.s_max


# --- optical flow -----------------------------------------------------------------------------


def foe_terms(k: Any, s: Scene, u: complex) -> Iterator[tuple[float, ...]]:
    """Focus f, bearing g, their difference, spread, importance and closing speed of each."""
    if u == 0:
        return
    heading = unit(u)
    seen = [(o.p - s.p, o.v - u, s.r + o.r) for o in s.near(k)]
    for a, b in [] if s.parity else s.near_walls(k):
        t = wall_time(a - s.p, b - s.p, u, s.r)
        if 0.0 < t < INF:
            seen.append((nearest(s.p + t * u, a, b) - s.p, -u, s.r))
    for away, w, reach in seen:
        x, y = -cross(heading, away), dot(heading, away)
        dx, dy = -cross(heading, w), dot(heading, w)
        if y < 0.1 or dy > -0.01:
            continue
        t = -y / dy
        importance = min(10.0, max(0.1, 10.0 - 2.0 * t)) if t <= 10.0 else 0.0
        f, g = dx / dy, x / y
        yield f, g, g - f, reach / y / math.log(10.0), importance, dy


def foe_avoidance(k: Any, s: Scene, u: complex) -> float:
    return sum(i * math.exp(-abs(d) / sigma) for _, _, d, sigma, i, _ in foe_terms(k, s, u))


def foe_gradient(k: Any, s: Scene, u: complex) -> complex:
    turn = pace = 0.0
    for f, g, d, sigma, importance, dy in foe_terms(k, s, u):
        side = 1.0 if d >= 0.0 else -1.0
        if s.parity and abs(d) <= 1e-7:  # on collision course the original does not turn
            side = 0.0
        e = importance * math.exp(-abs(d) / sigma) * side
        turn += e * (f * f - g * g + abs(u) / dy) / sigma
        pace += e * f / (dy * sigma)
    turn = min(0.1, max(-0.1, turn))
    right, heading = -1j * unit(u), unit(u)
    return -(right * abs(u) * math.sin(turn) + heading * (abs(u) * (1.0 - math.cos(turn)) + pace))


# --- forces -----------------------------------------------------------------------------------


def goal_force(_: Any, s: Scene) -> complex:
    return (s.v_pref - s.v) / max(s.tau, s.dt)


def social_force(k: Any, s: Scene) -> complex:
    force = 0j
    aways = [(s.p - o.p) * (1.0 - ratio(o.r, abs(s.p - o.p))) for o in s.near(k) if o.fixed
             and abs(s.p - o.p) > o.r]  # fmt: skip
    for o in s.near(k):
        if o.fixed:
            continue
        x = s.p - o.p
        step = abs(o.v) * k.dt
        y = step * unit(o.v_pref)
        if abs(x) <= s.r + o.r or x == y:
            continue
        around = abs(x) + abs(x - y)
        b2 = around**2 - (step if s.parity else abs(y)) ** 2
        if b2 <= 0.0 or math.sqrt(b2) / 2.0 < 0.001:
            continue
        b = math.sqrt(b2) / 2.0
        slope = (2.0 * abs(x) - 2.0 * abs(y) * cosine(x, y)) / (2.0 * abs(x - y))
        growth = 2.0 * around * (1.0 + slope) / (8.0 * b)
        push = (x if s.parity else unit(x)) * k.v0 / k.sigma * math.exp(-b / k.sigma) * growth
        force += push * (0.5 if angle(s.v, -x) >= math.radians(100.0) else 1.0)
    if not s.parity:
        aways += [s.p - n for n in s.wall_points(k)]
    else:
        aways += [
            s.p - nearest(s.p, a, b) for a, b in s.near_walls(k)
            if cross(b - a, s.p - a) <= 0.0 and nearest(s.p, a, b) != b
        ]  # fmt: skip
    for y in aways:
        if abs(y) >= 0.001:
            force += (y if s.parity else unit(y)) * k.u0 / k.r * math.exp(-abs(y) / k.r)
    return force


def power_law_force(k: Any, s: Scene) -> complex:
    seen = [(s.p - o.p, s.v - o.v, s.r + o.r) for o in s.near(k)]
    seen += [] if s.parity else [(s.p - n, s.v, s.r) for n in s.wall_points(k)]
    force = 0j
    for x, w, reach in seen:
        a, b, c = abs(w) ** 2, -dot(x, w), abs(x) ** 2 - reach**2
        d = b * b - a * c
        if c <= 0.0 or d <= 0.0 or not 0.001 <= (b - math.sqrt(d)) / a <= k.tau0:
            continue
        t = (b - math.sqrt(d)) / a
        size = k.k * math.exp(-t / k.tau0) * (2.0 / t + 1.0 / k.tau0) / (a * t * t)
        force -= size * (w - (a * x + b * w) / math.sqrt(d))
    return force


Force = Callable[[Any, Scene], complex]


def force_target(force: Force, k: Any, s: Scene) -> complex:
    return s.v + force(k, s) * s.dt / (s.mass if s.parity else 1.0)


def force_cost(force: Force, k: Any, s: Scene, u: complex) -> float:
    return 0.5 * abs(u - force_target(force, k, s)) ** 2 / s.dt


# --- Paris ------------------------------------------------------------------------------------


def paris_window(k: Any, s: Scene, e: complex, o: Other) -> tuple[float, ...]:
    """When a neighbour reaches and leaves the crossing (t1, t2), the speeds s1, s2 for it."""
    reach, away = s.r + o.r, o.p - s.p
    safe, blocked = (k.t_max, 0.0, 0.0, INF), (0.0, k.t_max, LARGEST if s.parity else INF, 0.0)
    if abs(cross(e, o.v)) < 1e-5:  # parallel
        return safe if disc_time(away, e - o.v, reach, s.parity) > k.t_max else blocked
    at = e * cross(away, o.v) / cross(e, o.v)  # the crossing, seen from p
    if disc_time(at, s.v, reach, s.parity) >= k.t_max:
        return safe
    t1 = min(k.t_max, disc_time(at - away, o.v, reach, s.parity))
    t2 = t1 + reach / abs(o.v)
    t2 = t2 if t2 <= k.t_max else 0.0
    return t1, t2, ratio(abs(at), t1), ratio(abs(at), t2)


def paris(k: Any, s: Scene, u: complex) -> float:
    e = unit(u)
    risks, misfit = [], 0.0
    free = []  # ways to pillars and walls, m: times at unit speed
    for o in s.near(k) if u != 0 else []:
        if o.fixed:
            free.append(disc_time(o.p - s.p, e, s.r + o.r))
            continue
        t1, _, s1, s2 = paris_window(k, s, e, o)
        choice = min(max(0.0, 1.0 - ratio(s1, s.s)), max(0.0, ratio(s2 - s.s, s.s)))
        soon = 1.0 - t1 / (k.t_max + k.w_b)
        risks.append(0.0 if soon == 0.0 or choice == 0.0 else choice * soon)
        misfit += max(0.0, ratio(s1 - abs(u), s.s), ratio(abs(u) - s2, s.s))
    if not s.parity and u != 0:
        free += [wall_time(a - s.p, b - s.p, e, s.r) for a, b in s.near_walls(k)]
    for way in free:
        risks.append(max(0.0, 1.0 - ratio(way, s.s * k.t_max)))
        misfit += max(0.0, ratio(abs(u) - way / BRAKING, s.s))
    if misfit > LARGEST:
        return INF
    risk = sum(risks) / len(risks) if risks else 0.0
    course = (1.0 - k.w_a) * (1.0 - cosine(e, s.v_pref)) / 2.0
    return float(1000.0 * (k.w_a * risk + course) + misfit + 0.001 * abs(u - s.v_pref))


FORCES: dict[str, Force] = {
    "goal_reaching_force": goal_force,
    "social_forces_avoidance": social_force,
    "power_law": power_law_force,
}
COSTS: dict[str, Callable[[Any, Scene, complex], float]] = {
    "karamouzas": karamouzas,
    "moussaid": moussaid,
    "pledestrians": pledestrians,
    "van_toll": van_toll,
    "orca": orca,
    "foe_avoidance": foe_avoidance,
    "paris": paris,
}


def cost(k: Any, s: Scene, u: complex) -> float:
    """Cost of a candidate, without weight."""
    if k.kind in FORCES:
        return force_cost(FORCES[k.kind], k, s, u)
    return COSTS[k.kind](k, s, u)
