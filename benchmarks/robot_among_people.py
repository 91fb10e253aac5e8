"""Is a parked robot ever touched, and a blind moving one now and then?

Runs the challenge's crowds at the real time steps, without Drake, with one robot that people see
and that is moved as told: parked, or driving against the flow at constant speed, from one end of
the corridor to the other and again.

    python benchmarks/robot_among_people.py --seconds 60 --at 2.5,0 --at 25,0
    python benchmarks/robot_among_people.py --seconds 60 --speed 0.5 --only 'counter-*' --at 2.5,-2

One lane (the y of ``--at``) is one sample: the nine mixes of a cell share the places of people.
Touches of one person within 2 s are one encounter.
"""

from __future__ import annotations

import argparse
import math
from collections import defaultdict
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
from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND
from crowdbot.dsl.scenario import Scenario

Array = NDArray[np.float64]
BODY = 0.178  # radius of the challenge's robot, m
BOUNCE = 2.0  # s within which touches of one person are one encounter
FIRST, LAST = 2.5, 47.5  # where a driving robot starts and turns, m


def engine_of(scenario: Scenario) -> CrowdEngine:
    registry = discover()
    parts = build_environment(registry, scenario.environment)
    engine = build_crowd(scenario, realise(scenario), parts, registry)
    assert engine is not None
    return engine


def contacts(
    engine: CrowdEngine, at: tuple[float, float], speed: float, seconds: float, margin: float
) -> tuple[int, int, float]:
    """How often the robot was touched, in how many encounters, and the smallest surface gap (m).

    A robot is put where nobody stands: people within 1 m of it are moved out of its way first.
    """
    flat = engine.initial_state()
    _, people = s.view(flat)
    x, y = at
    near = np.hypot(people[:, s.X] - x, people[:, s.Y] - y) < 1.0
    people[near, s.WAITING] = s.AT_PORTAL
    robot = np.array([[x, y, speed, 0.0, BODY, BODY + margin]])
    least, encounters, latest = math.inf, 0, np.full(len(people), -math.inf)
    for tick in range(round(seconds * TICKS_PER_SECOND)):
        engine.advance(flat, robot)
        robot[0, 0] += robot[0, 2] * TICK
        if not FIRST <= robot[0, 0] <= LAST and speed:
            robot[0, 0] = FIRST  # another crossing, after the contacts of this one have ended
            flat[s.HEADER_SIZE :].reshape(-1, s.AGENT_COLUMNS)[:, s.TOUCHING] = 0.0
        here = people[:, s.WAITING] == s.PRESENT
        away = np.hypot(people[here, s.X] - robot[0, 0], people[here, s.Y] - robot[0, 1])
        touching = people[:, s.TOUCHING] != 0.0
        encounters += int(np.sum(touching & (latest < (tick * TICK) - BOUNCE)))
        latest[touching] = tick * TICK
        least = min(least, float(np.min(away - engine.agents.radius[here] - BODY)))
    return int(flat[s.CONTACTS] + np.sum(people[:, s.TOUCHING])), encounters, least


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--speed", type=float, default=0.0, help="of the robot along +x, m/s")
    parser.add_argument("--at", action="append", help="x,y of the robot, m; default 2.5,0")
    parser.add_argument("--only", default="*", help="pattern of scenario ids")
    parser.add_argument("--every", action="store_true", help="a line for each run")
    given = parser.parse_args()
    places = [tuple(map(float, text.split(","))) for text in given.at or ["2.5,0"]]

    found: dict[str, list[tuple[int, int, float]]] = defaultdict(list)
    for scenario in open_spec("challenge-2020", discover()).scenarios:
        name = scenario.id.rpartition("/")[2]
        if not fnmatch(name, given.only):
            continue
        assert scenario.crowd is not None
        engine, margin = engine_of(scenario), scenario.crowd.robot_response.margin
        for x, y in places:
            count, met, gap = contacts(engine, (x, y), given.speed, given.seconds, margin)
            found[name.split("-")[1]].append((count, met, gap))
            if given.every:
                print(f"{name:40} at ({x:g}, {y:g}): {count} contacts, least gap {gap:.3f} m")

    print(
        f"{'density':>8} {'runs':>5} {'touched':>8} {'contacts/min':>13} {'encounters/min':>14} "
        f"{'least gap, m':>13}"
    )
    for density, rows in sorted(found.items()):
        counts, met_all, gaps = zip(*rows, strict=True)
        minutes = len(rows) * given.seconds / 60.0
        touched = sum(c > 0 for c in counts)
        print(
            f"{density:>8} {len(rows):5} {touched:8} {sum(counts) / minutes:13.2f} "
            f"{sum(met_all) / minutes:14.2f} {min(gaps):13.3f}"
        )


if __name__ == "__main__":
    main()
