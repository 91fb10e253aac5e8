"""Two minutes in the corridor for every crowd of the challenge: does it flow, is it whole?

Prints, for the first three labels of the ids: mean speed over preferred speed (smallest and largest
of the runs), people per m² of the zone in which they start (the same, mean over time), largest
overlap of two people, people through a wall, smallest speed of one person over the last half (a
deadlock would be near 0), people lost.

    python benchmarks/corridor.py --seconds 120
    python benchmarks/corridor.py --seconds 120 --suite challenge-2026 --only '*-attentive-n0[123]'
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from dataclasses import dataclass
from fnmatch import fnmatch

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.support.ticks import TICKS_PER_SECOND

HALF_WIDTH = 5.0  # of the corridor, m
ZONE = (5.0, 45.0)  # of the crowd along the corridor, m
EVERY = 8  # ticks between samples


@dataclass(frozen=True)
class Flow:
    """One run, measured."""

    pace: float
    density: float
    overlap: float
    through: int
    slowest: float
    lost: int


def measure(engine: CrowdEngine, seconds: float) -> Flow:
    flat = engine.initial_state()
    a, (_, people) = engine.agents, s.view(flat)
    pace, inside, moved, seen = [], [], np.zeros(len(a)), np.zeros(len(a))
    overlap, through, last = 0.0, 0, round(seconds * TICKS_PER_SECOND)
    for tick in range(last):
        engine.advance(flat)
        if tick % EVERY:
            continue
        if not np.all(np.isfinite(flat)):
            raise SystemExit(f"not finite at t = {tick / TICKS_PER_SECOND:g} s")
        here = people[:, s.WAITING] == s.PRESENT
        share = np.hypot(people[:, s.VX], people[:, s.VY]) / a.preferred_speed
        pace.append(float(np.mean(share[here])))
        x = people[here, s.X]
        inside.append(int(np.sum((ZONE[0] < x) & (x < ZONE[1]))))
        through += int(np.sum(np.abs(people[here, s.Y]) >= HALF_WIDTH))
        overlap = max(overlap, overlap_of(people[here, s.X : s.Y + 1], a.radius[here]))
        if tick > last // 2:
            moved += np.where(here, share, 0.0)
            seen += here
    gone = int(np.sum(people[:, s.WAITING] == s.GONE))
    density = float(np.mean(inside)) / ((ZONE[1] - ZONE[0]) * 2.0 * HALF_WIDTH)
    return Flow(float(np.mean(pace)), density, overlap, through, float(np.min(moved / seen)), gone)


def overlap_of(at: NDArray[np.float64], radius: NDArray[np.float64]) -> float:
    """Depth of the deepest overlap of two discs, m."""
    order = np.argsort(at[:, 0])
    at, radius, deepest = at[order], radius[order], 0.0
    for k in range(1, len(at)):
        if np.all(at[k:, 0] - at[:-k, 0] > 2.0 * radius.max()):
            break
        gap = np.hypot(*(at[k:] - at[:-k]).T) - radius[k:] - radius[:-k]
        deepest = max(deepest, -float(np.min(gap)))
    return deepest


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--seconds", type=float, default=120.0)
    parser.add_argument("--only", default="in-*", help="pattern of scenario ids")
    parser.add_argument("--suite", default="challenge-2020")
    given = parser.parse_args()
    registry, found = discover(), defaultdict[str, list[Flow]](list)
    for scenario in open_spec(given.suite, registry).scenarios:
        name = scenario.id.rpartition("/")[2]
        if fnmatch(name, given.only):
            parts = build_environment(registry, scenario.environment)
            engine = build_crowd(scenario, realise(scenario), parts, registry)
            assert engine is not None
            found["-".join(name.split("-")[:3])].append(measure(engine, given.seconds))
    print(
        "cell                    runs  pace least  pace most  density least  density most  "
        "overlap, m  through  slowest  lost"
    )
    for cell, rows in found.items():
        print(
            f"{cell:23} {len(rows):4} {min(r.pace for r in rows):11.4f} "
            f"{max(r.pace for r in rows):10.4f} {min(r.density for r in rows):14.4f} "
            f"{max(r.density for r in rows):13.4f} {max(r.overlap for r in rows):11.3f} "
            f"{sum(r.through for r in rows):8} {min(r.slowest for r in rows):8.3f} "
            f"{sum(r.lost for r in rows):5}",
            flush=True,
        )


if __name__ == "__main__":
    main()
