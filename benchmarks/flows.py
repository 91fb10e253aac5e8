"""Two-dimensional flow and crossing streams at 0.5 people per m², beside a corridor.

Prints, for each flow and stiffness of contacts, over all draws: the longest time that somebody on a
trip was slower than 5 cm/s, and the deepest overlap of two people. In the corridor all walk one
way, as in the challenge, or half of them each way; everybody is drawn and avoids alike.

With ``--depths`` also how deep all encounters were in which two people overlapped, and by the angle
between the ways to their goals.

    python benchmarks/flows.py
    python benchmarks/flows.py --stiffness 250 --draws 4 --seconds 40 --depths
    python benchmarks/flows.py --stiffness 250 --seconds 60 --only torus,walls
"""

from __future__ import annotations

import argparse
import math
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from corridor import EVERY
from numpy.typing import NDArray

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.support.ticks import TICKS_PER_SECOND

STANDING = 0.05  # m/s
_SUITE = """\
crowdbot: 1
suite: {id: flows, title: Flows, seed: 18}
base:
  environment:
    kind: floor
    area: {x: [-20 m, 20 m], y: [-20 m, 20 m]}
    border: open
    zones: {all: {x: [-20 m, 20 m], y: [-20 m, 20 m]}}
  robots: {}
  crowd:
    speed: {mean: 1.34 m/s, std: 0.26 m/s}
    body: {radius: %(radius)s m, mass: 75 kg, max_speed: 3 m/s, max_acceleration: 5 m/s^2}
    costs:
      avoid: {kind: ttca_dca, weight: 20, range: 5 m}
      reflex: {kind: rvo, range: {value: 0.3 m, measure: surface}}
matrix:
  stiffness:
%(policies)s  flow:
    one_way: {environment: %(corridor)s, crowd.streams: {a: %(east)s}}
    both_ways: {environment: %(corridor)s, crowd.streams: {a: %(half_east)s, b: %(half_west)s}}
    torus: {environment: %(torus)s, crowd.streams: {a: %(any)s}}
    walls: {environment: %(walls)s, crowd.streams: {a: %(any)s}}
    crossing: {crowd.streams: {a: %(cross_east)s, b: %(cross_north)s}}
draws: %(draws)s
"""


def _floor(half_x: int, half_y: int, border: str) -> str:
    area = f"{{x: [-{half_x} m, {half_x} m], y: [-{half_y} m, {half_y} m]}}"
    return f"{{area: {area}, border: {border}, zones: {{all: {area}}}}}"


def _box(x: float, y: float, wide: float, deep: float) -> str:
    return f"{{centre: [{x} m, {y} m], size: [{wide} m, {deep} m]}}"


def _through(begin: str, end: str, start: str, density: float) -> str:
    return (
        f"{{kind: through, origin: {begin}, destination: {end}, start: {start}, "
        f"density: {density} 1/m^2}}"
    )


def document(stiffnesses: list[float], radius: float, draws: int) -> str:
    """The suite: every flow with every stiffness."""
    west, east, hall = _box(-19, 0, 2, 8), _box(19, 0, 2, 8), _box(0, 0, 36, 10)
    south, north = _box(0, -19, 8, 2), _box(0, 19, 8, 2)
    policy = "{crowd.policy: {kind: velocity_space, contact_stiffness: %g 1/s^2}}"
    return _SUITE % {
        "radius": radius,
        "draws": draws,
        "policies": "".join(
            f"    k{str(k).replace('.', '_')}: {policy % k}\n" for k in stiffnesses
        ),
        "corridor": _floor(20, 5, "walls"),
        "torus": _floor(8, 8, "torus"),
        "walls": _floor(8, 8, "walls"),
        "east": _through(west, east, hall, 0.5),
        "half_east": _through(west, east, hall, 0.25),
        "half_west": _through(east, west, hall, 0.25),
        "any": "{kind: directions, area: all, density: 0.5 1/m^2}",
        "cross_east": _through(west, east, _box(0, 0, 36, 8), 0.25),
        "cross_north": _through(south, north, _box(0, 0, 8, 36), 0.25),
    }


@dataclass
class Measured:
    """One draw: longest standstill on a trip, s; seconds of all people together; encounters.

    An encounter of two people who overlap has its depth, m, and the angle between the ways to their
    goals, degrees, where it was deepest.
    """

    standstill: float = 0.0
    person_seconds: float = 0.0
    encounters: list[tuple[float, float]] = field(default_factory=list)

    @property
    def deepest(self) -> float:
        """Of all encounters, m."""
        return max((depth for depth, _ in self.encounters), default=0.0)


def measure(engine: CrowdEngine, seconds: float) -> Measured:
    flat, step = engine.initial_state(), EVERY / TICKS_PER_SECOND
    radius, (_, people) = engine.agents.radius, s.view(flat)
    standing, found = np.zeros(len(engine.agents)), Measured()
    open_: dict[tuple[int, int], tuple[float, float]] = {}
    for _ in range(round(seconds / step)):
        left = EVERY
        while left:
            left -= engine.advance_alone(flat, left)
        here = people[:, s.WAITING] == s.PRESENT
        slow = np.hypot(people[:, s.VX], people[:, s.VY]) < STANDING
        counts = here & slow & (people[:, s.ON_TRIP] == 1.0)
        standing = np.where(counts, standing + step, 0.0)
        found.standstill = max(found.standstill, float(standing.max()))
        found.person_seconds += float(here.sum()) * step
        now = _overlaps(people, radius, np.flatnonzero(here))
        found.encounters += [open_.pop(pair) for pair in list(open_) if pair not in now]
        open_ |= {pair: max(one, open_.get(pair, one)) for pair, one in now.items()}
    found.encounters += open_.values()
    return found


def _overlaps(
    people: NDArray[np.float64], radius: NDArray[np.float64], rows: NDArray[np.int64]
) -> dict[tuple[int, int], tuple[float, float]]:
    """Rows of two who overlap -> how deep, m, and the angle between their ways, degrees."""
    at, way = people[rows, s.X : s.Y + 1], people[rows, s.GOAL_X : s.GOAL_Y + 1]
    bearing = np.arctan2(*(way - at).T[::-1])
    gap = np.hypot(*(at[:, None] - at).transpose(2, 0, 1))
    depth = np.triu(radius[rows][:, None] + radius[rows] - gap, 1)
    found = {}
    for i, j in np.argwhere(depth > 0.0).tolist():
        turned = abs(math.remainder(bearing[i] - bearing[j], math.tau))
        found[int(rows[i]), int(rows[j])] = float(depth[i, j]), math.degrees(turned)
    return found


def _print_depths(rows: list[Measured]) -> None:
    """Distribution of all encounters, and the deepest for each range of angles."""
    listed = np.array([one for row in rows for one in row.encounters]).reshape(-1, 2)
    depth, angle = listed.T
    often = 100.0 * len(listed) / sum(row.person_seconds for row in rows)
    shares = " ".join(f"{q:.3f}" for q in np.quantile(depth, (0.5, 0.9, 0.99)))
    print(f"    {often:.1f} per 100 s and person; depth of 50, 90, 99 %: {shares} m")
    for low, high in ((0, 30), (30, 60), (60, 120), (120, 150), (150, 181)):
        own = depth[(low <= angle) & (angle < high)]
        if len(own):
            print(f"    {low:3} to {min(high, 180):3} deg: {len(own):5}, deepest {own.max():.3f} m")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--draws", type=int, default=3)
    parser.add_argument("--radius", type=float, default=0.25, help="of a body, m")
    parser.add_argument("--stiffness", default="62.5,250", help="of contacts, 1/s^2")
    parser.add_argument("--only", default="one_way,both_ways,torus,walls,crossing")
    parser.add_argument("--depths", action="store_true", help="of all encounters, too")
    given = parser.parse_args()
    registry, found = discover(allow=()), dict[tuple[str, str], list[Measured]]()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "flows.yaml"
        stiffnesses = [float(k) for k in given.stiffness.split(",")]
        path.write_text(document(stiffnesses, given.radius, given.draws), encoding="utf-8")
        expansion = open_spec(str(path), registry)
    print(f"{'flow':10} {'1/s^2':>6} {'draws':>5} {'stuck, s':>8} {'overlap, m':>10}")
    for scenario in expansion.scenarios:
        axes = expansion.axes[scenario.id]
        if axes["flow"] not in given.only.split(","):
            continue
        parts = build_environment(registry, scenario.environment)
        engine = build_crowd(scenario, realise(scenario, parts), parts, registry)
        assert engine is not None
        rows = found.setdefault((axes["flow"], axes["stiffness"]), [])
        rows.append(measure(engine, given.seconds))
        if len(rows) == given.draws:
            stuck, deepest = max(r.standstill for r in rows), max(r.deepest for r in rows)
            stiffness = axes["stiffness"][1:].replace("_", ".")
            print(
                f"{axes['flow']:10} {stiffness:>6} {len(rows):5} {stuck:8.1f} {deepest:10.3f}",
                flush=True,
            )
            if given.depths:
                _print_depths(rows)


if __name__ == "__main__":
    main()
