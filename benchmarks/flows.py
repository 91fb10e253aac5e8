"""Two-dimensional flow and crossing streams at 0.5 people per m², beside a corridor.

Prints, for each flow and stiffness of contacts, over all draws: the longest time that somebody on a
trip was slower than 5 cm/s, and the deepest overlap of two people. In the corridor all walk one
way, as in the challenge, or half of them each way; everybody is drawn and avoids alike.

    python benchmarks/flows.py
    python benchmarks/flows.py --stiffness 250 --seconds 60 --only torus,walls
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np
from corridor import EVERY, overlap_of

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


def measure(engine: CrowdEngine, seconds: float) -> tuple[float, float]:
    """Longest standstill on a trip, s; deepest overlap, m."""
    flat = engine.initial_state()
    radius, (_, people) = engine.agents.radius, s.view(flat)
    standing, longest, deepest = np.zeros(len(engine.agents)), 0.0, 0.0
    for _ in range(round(seconds * TICKS_PER_SECOND / EVERY)):
        left = EVERY
        while left:
            left -= engine.advance_alone(flat, left)
        here = people[:, s.WAITING] == s.PRESENT
        slow = np.hypot(people[:, s.VX], people[:, s.VY]) < STANDING
        counts = here & slow & (people[:, s.ON_TRIP] == 1.0)
        standing = np.where(counts, standing + EVERY / TICKS_PER_SECOND, 0.0)
        longest = max(longest, float(standing.max()))
        deepest = max(deepest, overlap_of(people[here, s.X : s.Y + 1], radius[here]))
    return longest, deepest


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--draws", type=int, default=3)
    parser.add_argument("--radius", type=float, default=0.25, help="of a body, m")
    parser.add_argument("--stiffness", default="62.5,250", help="of contacts, 1/s^2")
    parser.add_argument("--only", default="one_way,both_ways,torus,walls,crossing")
    given = parser.parse_args()
    registry, found = discover(allow=()), dict[tuple[str, str], list[tuple[float, float]]]()
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
            stuck, deepest = (max(column) for column in zip(*rows, strict=True))
            stiffness = axes["stiffness"][1:].replace("_", ".")
            print(
                f"{axes['flow']:10} {stiffness:>6} {len(rows):5} {stuck:8.1f} {deepest:10.3f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
