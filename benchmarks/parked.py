r"""Do people touch a robot that stands at its start?

Runs the crowds of suites at the real time steps, without Drake, beside the suite's own robots, and
prints each touch. Scenarios that share their people, or are further draws of one condition, are run
once: give ``--all`` for all of them.

    python benchmarks/parked.py
    python benchmarks/parked.py --suite challenge-2026 --seconds 60 --all
"""

from __future__ import annotations

import argparse
import math
import re

import numpy as np

from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.population.realise import realise
from crowdbot.core.realism.near_robots.clip import gap_at
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.robots.build import build_robot
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.support.ticks import TICKS_PER_SECOND
from crowdbot.dsl.scenario.scenario import Scenario

SUITES = (
    "challenge-2020", "challenge-2020-letter", "challenge-2020-literal", "challenge-2020-robots",
    "challenge-2021", "challenge-2021-2d", "challenge-2026", "social-guidelines", "shared-control",
    "assistance",
)  # fmt: skip
#: Labels of scenarios that are like another one of their suite, for a robot that stands.
ALIKE = re.compile(r"-c(?!20)\d\d|-r(?!05)\d\d|-n0[2-9]|^(delayed|biased|one_switch|fatigued)")
EVERY = 16  # ticks from one gap to the next


def stand(scenario: Scenario, registry: Registry, seconds: float) -> tuple[int, float]:
    """Touches of the first robot, and the least gap to it, m."""
    parts = build_environment(registry, scenario.environment)
    engine = build_crowd(scenario, realise(scenario), parts, registry)
    assert engine is not None
    assert scenario.crowd is not None
    robot = next(iter(scenario.robots.values()))
    footprint, pose = footprint_of_model(build_robot(registry, robot)), np.array(robot.task.start)
    seen = footprint.reach + scenario.crowd.robot_response.margin
    row = np.array([[*pose[:2], 0.0, 0.0, footprint.radius, seen, pose[2], 0.0]])
    outline = np.ascontiguousarray(footprint.corners)
    flat = engine.initial_state()
    (_, people), (felt, touches) = s.view(flat), s.contact_with(flat)
    least = math.inf
    for tick in range(round(seconds * TICKS_PER_SECOND)):
        engine.advance(flat, row, outline)
        if tick % EVERY == 0:
            here = people[:, s.WAITING] == s.PRESENT
            gap = gap_at(pose, footprint, people[here, s.X], people[here, s.Y])
            gap -= engine.agents.radius[here]
            least = min(least, float(np.min(gap, initial=math.inf)))
    return int(felt[s.CONTACTS] + np.sum(touches[:, s.TOUCHING])), least


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--suite", action="append", choices=SUITES)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--all", action="store_true", help="run those that are alike, too")
    given = parser.parse_args()
    registry, count, touched = discover(), 0, 0
    for suite in given.suite or SUITES:
        number, least = 0, math.inf
        for scenario in open_spec(suite, registry, []).scenarios:
            name = scenario.id.rpartition("/")[2]
            if scenario.crowd is None or not scenario.robots:
                continue
            if ALIKE.search(name) and not given.all:
                continue
            touches, gap = stand(scenario, registry, given.seconds)
            number, least = number + 1, min(least, gap)
            if touches:
                touched += 1
                print(f"touched: {suite} {name}, {touches} times", flush=True)
        count += number
        print(f"{suite:24} {number:4} scenarios, least gap {least:.3f} m", flush=True)
    print(f"{touched} of {count} robots were touched")


if __name__ == "__main__":
    main()
