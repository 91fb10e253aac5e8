"""How much more does a building with many walls cost than an empty hall?

One process measures both in turn: a decision of 200 people, a tick, the rays of a lidar and of a
layered one, a depth image, and the search for ways. The building has rooms of 3.5 m x 5 m with
doors along corridors, as many segments as asked for; both floors have the same size and people.
The sensors' empty hall is of 8 m x 6 m, so that its rays hit walls, too.

With `--crowds` the people of each packaged crowd, with its steering, first walk through the
building for some seconds on ways that routing finds. Then the same people at the same places, with
the same velocities and next points of their ways, decide in the building and in the empty hall.
With `--straight` they are in their rooms instead, just started straight to goals behind walls.

    python benchmarks/buildings.py --segments 2000
    python benchmarks/buildings.py --segments 2000 --crowds
"""

from __future__ import annotations

import argparse
import json
import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld, policy_of
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.routing.parameters import WayFinding
from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.sensing.depth_renderer import DepthRenderer
from crowdbot.core.sensing.ray_grid import RayGrid
from crowdbot.core.sensing.scene import Scene
from crowdbot.dsl.scenario.steering import SteeringSpec
from crowdbot.plugin import Pinhole, PolicyFactory

Array = NDArray[np.float64]
ROOM, DEPTH, AISLE, DOOR, WALL = 3.5, 5.0, 2.5, 1.0, 0.1  # m
POLICY = {"kind": "velocity_space", "relaxation_time": 0.5}
COSTS: dict[str, dict[str, object]] = {
    "mid_term": {"kind": "ttca_dca", "weight": 20.0, "range": 5.0},
    "reflex": {"kind": "rvo", "range": {"value": 0.3, "measure": "surface"}},
}


def building(segments: int) -> tuple[Array, Array, float]:
    """Walls (S, 4) of rooms, the middles (R, 2) of these, and the side of the hall, m."""
    rows = max(1, round(math.sqrt(segments / 14 * ROOM / (DEPTH + AISLE))))
    columns = math.ceil(segments / 14 / rows)
    walls, middles = list[list[float]](), list[tuple[float, float]]()
    for row in range(rows):
        for column in range(columns):
            x, y = column * ROOM, row * (DEPTH + AISLE)
            a, b = x + 0.5 * (ROOM - DOOR), x + 0.5 * (ROOM + DOOR)
            top = y + DEPTH
            for x0, x1 in ((x, a), (b, x + ROOM)):  # the front, left and right of the door
                box = [(x0, top), (x1, top), (x1, top + WALL), (x0, top + WALL)]
                walls += [[*p, *q] for p, q in zip(box, [*box[1:], box[0]], strict=True)]
            walls += [[x, y, x + ROOM, y], [x, y, x, top], [x + ROOM, y, x + ROOM, top]]
            walls += [[x + 1.0, y + 1.0, x + 1.6, y + 1.0], [x + 1.6, y + 1.0, x + 1.6, y + 1.4]]
            walls += [[x + 1.0, y + 1.0, x + 1.0, y + 1.4]]
            middles.append((x + 0.5 * ROOM, y + 0.6 * DEPTH))
    side = max(columns * ROOM, rows * (DEPTH + AISLE))
    return np.array(walls[:segments]), np.array(middles), side


def hall(side: float) -> Array:
    """The four walls around."""
    corners = [(-1.0, -1.0), (side + 1.0, -1.0), (side + 1.0, side + 3.0), (-1.0, side + 3.0)]
    return np.array([[*a, *b] for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)])


def people(middles: Array, count: int) -> Agents:
    """People in rooms, each on the way to another one."""
    rng = np.random.default_rng(1)
    start = middles[np.arange(count) % len(middles)] + rng.uniform(-0.4, 0.4, (count, 2))
    end = middles[rng.permutation(np.arange(count) % len(middles))]
    routes = [[(float(x), float(y))] for x, y in end]
    return Agents.of(x=start[:, 0], y=start[:, 1], radius=0.2, preferred_speed=1.3, routes=routes)


def least(function: Callable[[], object], rounds: int) -> float:
    """The least processor time of several calls, us."""
    times = []
    for _ in range(rounds):
        begin = time.process_time_ns()
        function()
        times.append(time.process_time_ns() - begin)
    return min(times) / 1000.0


def crowd(
    walls: Array,
    agents: Agents,
    routing: WayFinding | None,
    policy: PolicyFactory | None = None,
    velocity: Array | None = None,
    **world: Any,
) -> dict[str, Callable[[], object]]:
    """What to measure of a crowd: whole steps with and without a decision.

    Args:
        velocity: (N, 2) with which people walk, m/s; None: as after 0.25 s.
        world: further fields of `CrowdWorld`.
    """
    place = CrowdWorld(walls=walls, routing=routing, **world)
    engine = CrowdEngine(agents, place, policy or policy_of(POLICY, COSTS))
    first = engine.initial_state()
    if velocity is None:
        for _ in range(32):
            engine.advance(first)
    else:
        s.view(first)[1][:, s.VX : s.VY + 1] = velocity
    flat = first.copy()

    def step(tick: int) -> Callable[[], object]:
        def run() -> None:
            flat[:] = first
            flat[s.TICK] = tick
            engine.advance(flat)

        return run

    begin = int(first[s.TICK])
    return {"with": step(begin), "without": step(begin + 1)}


def rays(walls: Array, middles: Array) -> dict[str, Callable[[], object]]:
    """What to measure of sensors: one reading in each of several rooms."""
    scene = Scene(walls, (0.0, 2.5), np.zeros(0), 1.7)
    lidar = RayGrid(np.linspace(-math.pi, math.pi, 720, endpoint=False), [0.0])
    layered = RayGrid(
        np.linspace(-math.pi, math.pi, 360, endpoint=False), np.linspace(-0.3, 0.3, 8)
    )
    camera = DepthRenderer(Pinhole(width=160, height=120, focal=138.0), 0.4, 8.0)
    spots = [(float(x), float(y), 0.6) for x, y in middles[:: max(1, len(middles) // 10)]]
    return {
        "lidar, 720 rays, 10 m": lambda: [scene.cast_grid(lidar, at, 0.0, 10.0) for at in spots],
        "lidar, 8 layers": lambda: [scene.cast_grid(layered, at, 0.0, 10.0) for at in spots],
        "depth image": lambda: [scene.render_depth(camera, at, 0.0) for at in spots],
    }


def room(middles: Array) -> tuple[Array, Array]:
    """Walls (4, 4) of a small hall, and as many times its middle (R, 2) as there are rooms."""
    walls = [[-4.0, -3.0, 4.0, -3.0], [4.0, -3.0, 4.0, 3.0], [4.0, 3.0, -4.0, 3.0]]
    return np.array([*walls, [-4.0, 3.0, -4.0, -3.0]]), np.zeros_like(middles)


def measured(
    walls: Array, middles: Array, seen: tuple[Array, Array], count: int, rounds: int
) -> dict[str, float]:
    """Microseconds of each thing."""
    agents = people(middles, count)
    straight, routed = crowd(walls, agents, None), crowd(walls, agents, WayFinding())
    tick = least(straight["without"], rounds)
    decision = least(straight["with"], rounds) - tick
    found = {
        "tick": tick,
        f"decision of {count} people": decision,
        "ways, one decision": least(routed["with"], rounds) - tick - decision,
    }
    return found | {name: least(run, rounds) for name, run in rays(*seen).items()}


def packaged() -> dict[str, tuple[PolicyFactory, dict[str, Any]]]:
    """The policies and steering of the crowds that come along, by name."""
    parts = sorted((Path(__file__).parent.parent / "scenario_specs/parts/crowds").glob("*.yaml"))
    read = {part.stem: yaml.safe_load(part.read_text("utf-8"))["crowd"] for part in parts}
    return {
        name: (
            policy_of(crowd["policy"], crowd["costs"]),
            {
                "steering": Steering(SteeringSpec.model_validate(crowd.get("steering", {}))),
                "firm": crowd.get("solids") == "firm",
            },
        )
        for name, crowd in read.items()
    }


def walking(
    walls: Array, agents: Agents, policy: PolicyFactory, seconds: float, **world: Any
) -> tuple[Agents, Array]:
    """The people and their velocities (N, 2) after some seconds on ways around walls.

    Each of them then goes to the next point of its way.
    """
    place = CrowdWorld(walls=walls, routing=WayFinding(), **world)
    engine = CrowdEngine(agents, place, policy)
    flat = engine.initial_state()
    for _ in range(round(seconds * 128)):
        engine.advance(flat)
    _, rows = s.view(flat)
    next_points = rows[:, engine.goal_column : engine.goal_column + 2]
    routes = [[(float(x), float(y))] for x, y in next_points]
    found = Agents.of(
        x=rows[:, s.X], y=rows[:, s.Y], radius=agents.radius, routes=routes,
        preferred_speed=agents.preferred_speed,
    )  # fmt: skip
    return found, rows[:, s.VX : s.VY + 1].copy()


def in_turns(runs: list[Callable[[], object]], rounds: int) -> list[float]:
    """The least processor time of each of several things that are called in turns, us."""
    times = [[least(run, 1) for run in runs] for _ in range(rounds)]
    return [min(column) for column in zip(*times, strict=True)]


def ten_times(walls: Array, side: float) -> Array:
    """The building and nine others like it beside it."""
    shift = (side + 10.0) * np.array([1.0, 0.0, 1.0, 0.0])
    return np.concatenate([walls + k * shift for k in range(10)])


def print_crowds(
    walls: Array, middles: Array, side: float, count: int, rounds: int, seconds: float
) -> None:
    """Print what each packaged crowd costs in both places and in a building ten times as large.

    A second of a crowd is 16 decisions and 128 ticks. In the larger building the same people are
    at the same places.

    Args:
        seconds: how long people walk before; 0: see `--straight`.
    """
    places = [hall(side), walls, ten_times(walls, side)]
    print(
        f"{'us':26}{'decision: empty':>16}{len(walls):>8} walls{'ratio':>7}{'tick: ratio':>13}"
        f"{'second: ratio':>15}{'10 times the walls':>20}"
    )
    for name, (policy, world) in packaged().items():
        agents, velocity = people(middles, count), None
        if seconds > 0.0:
            agents, velocity = walking(walls, agents, policy, seconds, **world)
        steps = [crowd(at, agents, None, policy, velocity, **world) for at in places]
        runs = [each[kind] for each in steps for kind in ("with", "without")]
        found = in_turns(runs, rounds)
        ticks = found[1::2]
        decisions = [whole - tick for whole, tick in zip(found[::2], ticks, strict=True)]
        seconds_of = [16 * d + 128 * tick for d, tick in zip(decisions, ticks, strict=True)]
        print(
            f"{name:26}{decisions[0]:16.1f}{decisions[1]:14.1f}{decisions[1] / decisions[0]:7.2f}"
            f"{ticks[1] / ticks[0]:13.2f}{seconds_of[1] / seconds_of[0]:15.2f}"
            f"{decisions[2] / decisions[1]:20.2f}"
        )


def main() -> None:
    """Print microseconds and ratios."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--segments", type=int, default=2000)
    parser.add_argument("--people", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=30)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--crowds", action="store_true", help="decisions of all packaged crowds")
    parser.add_argument("--straight", action="store_true", help="with crowds: people just started")
    given = parser.parse_args()
    walls, middles, side = building(given.segments)
    if given.crowds:
        seconds = 0.0 if given.straight else 6.0
        print_crowds(walls, middles, side, given.people, given.rounds, seconds)
        return
    empty = measured(hall(side), middles, room(middles), given.people, given.rounds)
    full = measured(walls, middles, (walls, middles), given.people, given.rounds)
    if given.json:
        print(json.dumps({"empty": empty, "full": full}, indent=1))
        return
    print(f"{'':26}{'empty':>10}{len(walls):>10} segments   ratio")
    for name, one in empty.items():
        print(f"{name:26}{one:10.1f}{full[name]:10.1f} us {full[name] / one:15.2f}")


if __name__ == "__main__":
    main()
