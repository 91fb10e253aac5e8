"""What finding ways costs beside avoiding people, and worlds beside a corridor.

Decisions: the densest crowds of challenge-2021, one of each place, and 100 people who stroll
through an office of 24 rooms, all without a robot. The processor time of each decision is split as
it is made: aims (`Router.find`) and velocities (the crowd policy), so that both meet the same
machine at the same moment; of each decision the least of several rounds counts.

Runs (``--runs``): the same scenarios with robot and dwa, each beside a plain corridor with as
many people at the same density, who avoid each other likewise and walk both ways; they
take turns, a simulated second each, and of each second the least of several counts is taken
(`turns.py`).

    python benchmarks/routing.py
    python benchmarks/routing.py --runs --only plaza,shed --seconds 10
"""

from __future__ import annotations

import argparse
import tempfile
import time
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from turns import WARM_UP, in_turns

from crowdbot.core.crowd import engine as engine_module
from crowdbot.core.crowd.engine import CrowdEngine
from crowdbot.core.crowd.routing.router import Router
from crowdbot.core.environments.build import build_environment
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.scenarios.lock import population
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.sim.built_run import build_runs
from crowdbot.core.sim.record import record_robots
from crowdbot.core.sim.run_setup import RunSetup
from crowdbot.dsl.scenario.scenario import Scenario

PLACES = ("pillars", "crossing", "corner", "junction", "bottleneck", "shed", "street", "plaza")
DENSITY, WIDTH = 0.4, 6.0  # people per m^2 of challenge-2021's densest cells; m
#: A corridor is narrower rather than shorter: else the robot arrives within the seconds counted.
LEAST_LENGTH = 15.0  # m
SIDE, DOOR, ROOMS = 5.0, 1.4, (6, 4)  # of the office, m
_CROWD = """\
  crowd:
    body: {radius: 0.25 m}
    speed: {mean: 1.34 m/s, std: 0.26 m/s}
    policy: {kind: velocity_space, contact_stiffness: 250 1/s^2}
    costs:
      avoid: {kind: ttca_dca, weight: 20, range: 5 m}
      reflex: {kind: rvo, range: {value: 0.3 m, measure: surface}}
"""
_CORRIDOR = """\
crowdbot: 1
scenario:
  id: corridor
  extends: ["builtin:parts/turtlebot2.yaml"]
  environment:
    kind: corridor
    length: %(length)s m
    width: %(width)s m
    zones:
      all: {x: [0 m, %(length)s m], y: [-%(half)s m, %(half)s m]}
      goal: {x: [%(last)s m, %(length)s m], y: [-%(half)s m, %(half)s m]}
    portals:
      a: {x: [-1 m, 0 m], y: [-%(half)s m, %(half)s m]}
      b: {x: [%(length)s m, %(beyond)s m], y: [-%(half)s m, %(half)s m]}
  robots.robot.task: {start: [2 m, 0 m, 0 deg], goal: {zone: goal}, time_limit: 90 s}
%(crowd)s    streams:
      one: {kind: through, count: %(one)s, origin: a, destination: b, start: all}
      two: {kind: through, count: %(two)s, origin: b, destination: a, start: all}
"""
_OFFICE = """\
crowdbot: 1
scenario:
  id: office
  environment:
    kind: floor
    area: {x: [0 m, %(x)s m], y: [0 m, %(y)s m]}
    walls:
%(walls)s    zones:
      all: {x: [0.3 m, %(right)s m], y: [0.3 m, %(top)s m]}
%(zones)s  robots: {}
%(crowd)s    routing: {kind: mesh}
    goal_areas:
%(areas)s    streams:
      strollers: {kind: wandering, area: all, areas: [%(names)s], count: %(count)s}
"""


@cache
def registry() -> Registry:
    """The plugins that come with crowdbot."""
    return discover(allow=())


def place(name: str) -> Scenario:
    """The densest scenario of a place, with people both ways."""
    return pick(open_spec("challenge-2021", registry()), f"{name}_both-d040-usual")


def _opened(text: str) -> Scenario:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scenario.yaml"
        path.write_text(text, encoding="utf-8")
        return open_spec(str(path), registry()).scenarios[0]


def corridor(people: int) -> Scenario:
    """A plain corridor with so many people, half of them in each direction."""
    width = round(min(WIDTH, people / (DENSITY * LEAST_LENGTH)), 3)
    length = round(people / (DENSITY * width), 3)
    one = people // 2
    return _opened(
        _CORRIDOR % {
            "length": length, "last": length - 2.0, "beyond": length + 1.0, "width": width,
            "half": 0.5 * width, "crowd": _CROWD, "one": one, "two": people - one,
        }
    )  # fmt: skip


def office(people: int) -> Scenario:
    """Rooms with a door in each wall between two, and people who stroll from room to room."""
    rng, (columns, rows) = np.random.default_rng(7), ROOMS
    walls, zones = [], []
    for i in range(columns):
        for j in range(rows):
            x, y = i * SIDE, j * SIDE
            box = f"x: [{x + 0.5} m, {x + SIDE - 0.5} m], y: [{y + 0.5} m, {y + SIDE - 0.5} m]"
            zones.append(f"      r{i}{j}: {{{box}}}\n")
            for upright, inner in ((True, i > 0), (False, j > 0)):
                at = rng.uniform(0.6, SIDE - DOOR - 0.6)
                for k, (low, high) in enumerate(((0.0, at), (at + DOOR, SIDE)) if inner else ()):
                    ends = (
                        [(x, y + low), (x, y + high)] if upright else [(x + low, y), (x + high, y)]
                    )
                    (ax, ay), (bx, by) = ends
                    name = f"w{i}{j}{'xy'[upright]}{k}"
                    line = f"start: [{ax:.3f} m, {ay:.3f} m], end: [{bx:.3f} m, {by:.3f} m]"
                    walls.append(f"      {name}: {{{line}, thickness: 0.2 m}}\n")
    names = [z.split(":")[0].strip() for z in zones]
    areas = "".join(f"      {n}: {{area: {n}}}\n" for n in names)
    return _opened(
        _OFFICE % {
            "x": columns * SIDE, "y": rows * SIDE, "right": columns * SIDE - 0.3,
            "top": rows * SIDE - 0.3, "walls": "".join(walls), "zones": "".join(zones),
            "crowd": _CROWD, "areas": areas, "names": ", ".join(names), "count": people,
        }
    )  # fmt: skip


def engine_of(scenario: Scenario) -> CrowdEngine:
    """The crowd of a scenario, without its robot."""
    parts = build_environment(registry(), scenario.environment)
    found = build_crowd(scenario, population(scenario, registry()).agents, parts, registry())
    assert found is not None
    return found


# ------------------------------------------------------------------------------- decisions
ROUTER: Any = Router
ENGINE: Any = engine_module
FIND, DESIRED = ROUTER.find, ENGINE.desired_acceleration


class Stopwatch:
    """Processor time of the calls of a function, one after the other, s."""

    def __init__(self, function: Any) -> None:
        self.function, self.spent = function, list[float]()

    def __call__(self, *args: Any) -> Any:
        """Call it and note what it took."""
        begin = time.thread_time_ns()
        answer = self.function(*args)
        self.spent.append(1e-9 * (time.thread_time_ns() - begin))
        return answer


def decisions(scenario: Scenario, seconds: float, rounds: int) -> tuple[int, float, float]:
    """People, and µs of each one's decision: for the aim, for the velocity."""
    found: list[tuple[list[float], list[float]]] = []
    engine = engine_of(scenario)
    for _ in range(rounds + 1):  # the first one loads compiled code
        aims, velocities = Stopwatch(FIND), Stopwatch(DESIRED)
        ROUTER.find, ENGINE.desired_acceleration = (lambda *a, watch=aims: watch(*a)), velocities
        flat, left = engine.initial_state(), round(seconds * 128)
        aims.spent.clear()  # where everybody begins
        while left:
            left -= engine.advance_alone(flat, left)
        ROUTER.find, ENGINE.desired_acceleration = FIND, DESIRED
        found.append((aims.spent, velocities.spent))
    least = [sum(map(min, zip(*rows, strict=True))) for rows in zip(*found[1:], strict=True)]
    people = len(engine.agents)
    each = 1e6 / (people * len(found[0][1]))
    return people, each * least[0], each * least[1]


# ------------------------------------------------------------------------------------ runs
def run(world: str | int, seconds: float) -> None:
    """Simulate and record a place by its name, or a corridor by its people, with dwa."""
    scenario = _timed(place(world) if isinstance(world, str) else corridor(world), seconds)
    choice = resolve_planner("dwa", registry())
    with tempfile.TemporaryDirectory() as folder:
        setup = RunSetup(
            scenario=scenario,
            agents=population(scenario, registry()).agents,
            registry=registry(),
            choice=choice,
            seed=0,
            recording=Path(folder) / "run.mcap",
            stage="benchmark",
            progress=None,
            stop=lambda: False,
            on_hang=None,
        )
        record_robots(setup, build_runs(scenario, registry(), choice, "used"))


def _timed(scenario: Scenario, seconds: float) -> Scenario:
    """The same, ended after some seconds."""
    robots = {
        name: robot.model_copy(
            update={"task": robot.task.model_copy(update={"time_limit": seconds})}
        )
        for name, robot in scenario.robots.items()
    }
    return scenario.model_copy(update={"robots": robots})


def runs(name: str, seconds: float, rounds: int) -> tuple[int, float, float]:
    """People, and CPU ms for each simulated second: in a place, in a corridor."""
    people = len(population(place(name), registry()).agents)
    jobs = {"world": partial(run, name, seconds), "corridor": partial(run, people, seconds)}
    spent = in_turns(jobs, rounds)
    each = 1e3 / (seconds - WARM_UP)
    return people, each * spent["world"], each * spent["corridor"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--runs", action="store_true", help="whole runs beside a corridor")
    parser.add_argument("--only", help=f"some of {','.join((*PLACES, 'office'))}")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--rounds", type=int, default=3, help="the least of so many counts")
    given = parser.parse_args()
    names = (
        given.only.split(",")
        if given.only
        else [*PLACES, "office"][: None if not given.runs else -1]
    )
    if given.runs:
        print(f"{'place':12} {'people':>6} {'ms/s':>8} {'corridor':>8} {'speed, %':>8}")
        for name in names:
            people, here, plain = runs(name, given.seconds, given.rounds)
            print(
                f"{name:12} {people:6} {here:8.1f} {plain:8.1f} {100 * plain / here:8.0f}",
                flush=True,
            )
        return
    print(f"{'place':12} {'people':>6} {'way, µs':>8} {'avoid, µs':>9} {'way, %':>7}")
    for name in names:
        scenario = office(100) if name == "office" else place(name)
        people, way, avoid = decisions(scenario, given.seconds, given.rounds)
        print(f"{name:12} {people:6} {way:8.3f} {avoid:9.3f} {100 * way / avoid:7.1f}", flush=True)


if __name__ == "__main__":
    main()
