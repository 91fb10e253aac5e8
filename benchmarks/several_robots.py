"""What 1, 2, 5 and 10 robots cost, and whether two that meet in a corridor get past each other.

    .venv/bin/python benchmarks/several_robots.py            # cost
    .venv/bin/python benchmarks/several_robots.py --head-on  # two in a corridor, ten seeds

Cost is processor time of the simulation alone, without scores. Numbers in docs/reference/
performance.md were measured with it.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.recording.recording import Recording
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.scenarios.lock import population
from crowdbot.core.sim.built_run import build_run
from crowdbot.core.sim.record import record_robots
from crowdbot.core.sim.run_setup import RunSetup

_DOCUMENT = """\
crowdbot: 1
scenario:
  id: fleet
  environment:
    kind: floor
    area: {{x: [-{half} m, {half} m], y: [-{side} m, {side} m]}}
    zones:
      east: {{x: [{goal} m, {half} m], y: [-{side} m, {side} m]}}
      west: {{x: [-{half} m, -{goal} m], y: [-{side} m, {side} m]}}
  robots:
"""
_ROBOT = """\
    r{name}:
      model: {{kind: turtlebot2}}
      sensors:
        lidar: {{kind: lidar2d, mount: {{z: 0.2 m}}, noise: 1 mm}}
        odometry: {{kind: wheel_odometry}}
      task: {{start: [{x} m, {y} m, {yaw} deg], goal: {{zone: {goal}}}, time_limit: {limit} s}}
"""


def document(
    starts: list[tuple[float, float, float]], half: float, side: float, limit: float
) -> str:
    """A hall; who looks to the west drives there."""
    text = _DOCUMENT.format(half=half, side=side, goal=half - 2.0)
    for k, (x, y, yaw) in enumerate(starts):
        goal = "west" if abs(yaw) > 90.0 else "east"
        text += _ROBOT.format(name=k, x=x, y=y, yaw=yaw, goal=goal, limit=limit)
    return text


def simulate(text: str, registry: Registry, seed: int = 0) -> tuple[Any, float, dict[str, Any]]:
    """Outcome, processor time (s) and trajectories by robot of one run with dwa."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "fleet.yaml"
        file.write_text(text)
        scenario = open_spec(str(file), registry, ()).scenarios[0]
        choice = resolve_planner("dwa", registry)
        setup = RunSetup(
            scenario=scenario, agents=population(scenario, registry).agents, registry=registry,
            choice=choice, seed=seed, recording=Path(folder) / "run.mcap",
            options=RunOptions(record="none"), stage="run",
            progress=None, stop=lambda: False, on_hang=None,
        )  # fmt: skip
        robots = tuple(scenario.robots)
        builts = {n: build_run(scenario, registry, choice, "none", n) for n in robots}
        begin = time.process_time()
        outcome = record_robots(setup, builts)
        cost = time.process_time() - begin
        path = Path(folder) / "run.mcap"
        with Recording(path) as recording:
            if len(robots) == 1:
                return outcome, cost, {robots[0]: recording.trajectories()}
            return outcome, cost, {n: recording.trajectories(n) for n in recording.robots}


def cost(registry: Registry) -> None:
    """Processor time of fleets: the least of three rounds, taken in turns."""
    counts, seconds = (1, 2, 5, 10), 8.0
    texts = []
    for count in counts:
        rows = [(-7.0 + 0.5 * (k % 2), 1.6 * (k - 0.5 * (count - 1)), 0.0) for k in range(count)]
        texts.append(document(rows, 10.0, 10.0, seconds))
    simulate(texts[1], registry)  # compiles
    rounds = [[simulate(text, registry)[1] for text in texts] for _ in range(3)]
    least = [min(used) for used in zip(*rounds, strict=True)]
    for count, used in zip(counts, least, strict=True):
        each = used / count
        print(
            f"{count:2d} robots: {used:6.2f} s, {each:5.2f} s each, "
            f"{each / least[0]:.2f} of one alone"
        )


def head_on(registry: Registry) -> None:
    """Two TurtleBot2 towards each other in a corridor 2 m wide, dwa on both."""
    free = 0
    for seed in range(10):
        side = np.random.default_rng(seed).uniform(-0.1, 0.1, 2)
        rows = [(-5.0, float(side[0]), 0.0), (5.0, float(side[1]), 180.0)]
        outcome, _, runs = simulate(document(rows, 8.0, 1.0, 60.0), registry, seed)
        longest, touched = 0.0, 0
        for run in runs.values():
            moved = np.hypot(np.diff(run.robot.x), np.diff(run.robot.y)) / np.diff(run.t) > 0.02
            at = np.flatnonzero(np.concatenate([[True], moved, [True]]))
            longest = max(longest, float(np.max(np.diff(at)) - 1) * float(np.diff(run.t)[0]))
            touched += len(run.contacts.t0)
        free += longest <= 20.0 and outcome.status == "arrived"
        print(
            f"seed {seed}: {outcome.status}, last arrival {outcome.goal_time}, "
            f"longest stop {longest:.1f} s, contacts {touched}",
            flush=True,
        )
    print(f"{free} of 10 got past each other without a stop beyond 20 s")


def main() -> None:
    """Measure what the options say."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--head-on", action="store_true")
    registry = discover()
    (head_on if parser.parse_args().head_on else cost)(registry)


if __name__ == "__main__":
    main()
