r"""Measure how deep bodies are in solids, and how many people stand, in hard places.

Each packaged crowd walks through halls with a grid of pillars, both ways and crossing, doors of
0.8 m, corridors, thin walls at any angle, around a pocket and an island; without a robot, and with
one that is parked or drives among the people. One line for each crowd and place:

    python benchmarks/crowd_places.py
    python benchmarks/crowd_places.py --crowd van_toll --place pillars --seconds 60 --robot none

`solid` is how deep a body was in anything solid at most, m, at 16 Hz, and `inside` the share of
people who were ever in it with their centre, or on its wrong side; `bodies` how deep two bodies
overlapped, the 99th percentile of all overlaps, m. `still` is the share of people who stay
within half a metre in the last third of the time although they are on a trip, and `trips` the
number of finished trips per person. With --pictures FOLDER the people at the end are drawn.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]
from hard_places import DEEP, WIDE, places
from numpy.typing import NDArray

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.scenarios.named_crowds import crowd_parts
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.support.ticks import TICKS_PER_SECOND
from crowdbot.errors import InputError

Array = NDArray[np.float64]
#: Ticks between two looks.
EVERY = 8
#: People who move less than this in the last third of the time stand, m.
STAYS = 0.5
ROBOTS = ("none", "parked", "driving")
_SCENARIO = """\
crowdbot: 1
scenario:
  id: place
  extends: [usual.yaml, "builtin:parts/crowds/{crowd}.yaml"]
  robots: {{}}
  environment: {environment}
  crowd: {people}
"""
_USUAL = """\
crowd:
  speed: {mean: 1.34 m/s, std: 0.26 m/s}
  body: {radius: 0.2 m}
"""


@dataclass
class PlaceResult:
    """Numbers of one run; the head of this file says what they mean."""

    people: int
    solid: float
    inside: float
    bodies: float
    still: float
    trips: float

    def line(self) -> str:
        """Return it as columns."""
        return (
            f"{self.people:6} {self.solid:7.3f} {self.inside:7.3f} {self.bodies:7.3f} "
            f"{self.still:6.2f} {self.trips:6.2f}"
        )


def engine_in(place: tuple[str, str], crowd: str, registry: Registry) -> CrowdEngine:
    """Return the engine of a packaged crowd in a place."""
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        (folder / "usual.yaml").write_text(_USUAL, encoding="utf-8")
        text = _SCENARIO.format(crowd=crowd, environment=place[0], people=place[1])
        (folder / "place.yaml").write_text(text, encoding="utf-8")
        scenario = pick(open_spec(str(folder / "place.yaml"), registry), None)
    parts = build_environment(registry, scenario.environment)
    engine = build_crowd(scenario, realise(scenario, parts), parts, registry)
    assert engine is not None
    return engine


def robot_at(kind: str, now: float) -> Array:
    """Rows (R, 8) of the robot: none, or one in the middle, or one that goes there and back."""
    if kind == "none":
        return np.zeros((0, 8))
    x, vx = 0.5 * WIDE + 0.45, 0.0
    if kind == "driving":
        whole, span = 0.65 * now, WIDE - 3.0
        part = whole % (2.0 * span)
        x = 1.5 + (part if part < span else 2.0 * span - part)
        vx = 0.65 if part < span else -0.65
    return np.array([[x, 0.5 * DEEP, vx, 0.0, 0.178, 0.428, 0.0, 0.0]])


def depths(at: Array, radius: Array, engine: CrowdEngine) -> tuple[Array, NDArray[np.bool_]]:
    """Return the depth of each body in solids, m, and True where its centre is inside."""
    points, world = shapely.points(at), engine.world
    gap = np.full(len(at), np.inf)
    if len(world.walls):
        lines = shapely.MultiLineString(list(world.walls.reshape(-1, 2, 2)))
        gap = shapely.distance(points, lines)
    within = np.zeros(len(at), np.bool_)
    for x, y, r in world.pillars.tolist():
        own = np.hypot(at[:, 0] - x, at[:, 1] - y) - r
        gap, within = np.minimum(gap, own), within | (own < 0.0)
    for outline in world.solids:
        within |= shapely.contains(shapely.Polygon(outline), points)
    return np.where(within, radius + np.abs(gap), radius - gap), within


def overlaps(at: Array, radius: Array) -> Array:
    """Return the depths of all overlaps of two bodies, m."""
    gap = np.hypot(*(at[:, None] - at).transpose(2, 0, 1))
    deep = np.triu(radius[:, None] + radius - gap, 1)
    return np.asarray(deep[deep > 0.0])


def states(engine: CrowdEngine, seconds: float, robot: str) -> Iterator[Array]:
    """Yield the people's rows (N, C) at 16 Hz."""
    flat = engine.initial_state(1)
    _, rows = s.view(flat)
    for tick in range(round(seconds * TICKS_PER_SECOND)):
        engine.advance(flat, robot_at(robot, tick / TICKS_PER_SECOND))
        if tick % EVERY == EVERY - 1:
            yield rows


def measure(engine: CrowdEngine, seconds: float, robot: str) -> tuple[PlaceResult, Array]:
    """Simulate one run; return its numbers and the people's rows at its end."""
    count, radius = len(engine.agents), engine.agents.radius
    deepest, inside, bodies = 0.0, np.zeros(count, np.bool_), [np.zeros(1)]
    last, begin = list[Array](), 2.0 / 3.0 * seconds * TICKS_PER_SECOND / EVERY
    rows = np.zeros((0, 0))
    for k, rows in enumerate(states(engine, seconds, robot)):
        here = rows[:, s.WAITING] == s.PRESENT
        at = rows[here][:, [s.X, s.Y]]
        deep, within = depths(at, radius[here], engine)
        deepest = max(deepest, float(np.max(deep, initial=0.0)))
        inside[np.flatnonzero(here)[within]] = True
        if k % 8 == 0:
            bodies.append(overlaps(at, radius[here]))
        if k >= begin:
            on_way = here & (rows[:, s.ON_TRIP] == 1.0)
            last.append(np.where(on_way[:, None], rows[:, [s.X, s.Y]], np.nan))
    track = np.array(last)
    stays = np.hypot(*(np.ptp(track, axis=0)).T) < STAYS
    result = PlaceResult(
        count, deepest, float(inside.mean()), float(np.percentile(np.concatenate(bodies), 99.0)),
        float(stays.mean()), float(rows[:, s.ARRIVALS].sum()) / count,
    )  # fmt: skip
    return result, np.column_stack([rows, stays])


def draw(path: Path, engine: CrowdEngine, rows: Array) -> None:
    """Draw the people at the end with their directions; in red those who stand."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.patches import Circle

    figure, axes = plt.subplots(figsize=(9, 6))
    for x0, y0, x1, y1 in engine.world.walls:
        axes.plot([x0, x1], [y0, y1], "k-", lw=1)
    for x, y, r in engine.world.pillars:
        axes.add_patch(Circle((x, y), r, color="0.6"))
    for row, radius in zip(rows, engine.agents.radius, strict=True):
        if row[s.WAITING] != s.PRESENT:
            continue
        colour = "tab:red" if row[-1] else "tab:blue"
        axes.add_patch(Circle((row[s.X], row[s.Y]), radius, color=colour, alpha=0.5))
        way = np.array([row[engine.goal_column] - row[s.X], row[engine.goal_column + 1] - row[s.Y]])
        way *= 0.4 / max(float(np.hypot(*way)), 0.4)
        axes.plot([row[s.X], row[s.X] + way[0]], [row[s.Y], row[s.Y] + way[1]], color=colour)
    axes.set_aspect("equal")
    figure.tight_layout()
    figure.savefig(path, dpi=80)
    plt.close(figure)


def main() -> None:
    """Print a line for each run; places in which so many people have no room are left out."""
    registry, known = discover(allow=()), places()
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--crowd", action="append", help="all packaged ones")
    parser.add_argument("--place", action="append", help="beginning of a place's name; all")
    parser.add_argument("--seconds", type=float, default=45.0)
    parser.add_argument("--robot", action="append", choices=ROBOTS, help="all three")
    parser.add_argument("--pictures", type=Path, help="folder")
    given = parser.parse_args()
    print(f"{'crowd':24} {'place':32} {'robot':8} people   solid  inside  bodies  still  trips")
    for crowd in given.crowd or sorted(crowd_parts(registry)):
        for name, place in known.items():
            if not any(name.startswith(own) for own in given.place or [""]):
                continue
            for robot in given.robot or ROBOTS:
                try:
                    engine = engine_in(place, crowd, registry)
                except InputError as error:
                    print(f"{crowd:24} {name:32} {robot:8} {str(error).splitlines()[0][-60:]}")
                    continue
                result, rows = measure(engine, given.seconds, robot)
                print(f"{crowd:24} {name:32} {robot:8} {result.line()}", flush=True)
                if given.pictures:
                    given.pictures.mkdir(parents=True, exist_ok=True)
                    draw(given.pictures / f"{crowd}_{name}_{robot}.png", engine, rows)


if __name__ == "__main__":
    main()
