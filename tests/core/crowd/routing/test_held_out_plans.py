"""Plans that no code of ours has made: 100 people find their way, as short as another planner's.

The plan, its files and the planner know nothing of crowdbot: shapely makes the floor and shrinks it
with round corners, a visibility graph and scipy's Dijkstra give the shortest ways.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra
from shapely import affinity

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.scenarios.lock import population
from crowdbot.core.sim.build_crowd import build_crowd

Array = NDArray[np.float64]
REGISTRY = discover(allow=())
SIZE, PEOPLE, RADIUS, CELL = (46.0, 38.0), 100, 0.25, 0.05
#: Shapes of what stands about, before they are turned; two are concave.
SHAPES = (
    [(0, 0), (6, 0), (6, 1), (0, 1)],
    [(0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4)],
    [(0, 0), (5, 0), (5, 3), (4, 3), (4, 1), (1, 1), (1, 3), (0, 3)],
    [(0, 0), (2.5, 0.5), (1, 2.5)],
)


def floor_of(rng: np.random.Generator) -> Any:
    """A hall with a bite out of each of two corners, and some thirty things in it."""
    (w, h), bite = SIZE, rng.uniform(8.0, 14.0, 4)
    hall = shapely.box(0, 0, w, h) - shapely.box(0, 0, bite[0], bite[1])
    hall -= shapely.box(w - bite[2], h - bite[3], w, h)
    room, taken = hall.buffer(-1.0), shapely.Polygon()
    for k in range(220):
        thing = affinity.rotate(shapely.Polygon(SHAPES[k % 4]), rng.uniform(0, 360), origin=(0, 0))
        thing = affinity.translate(thing, rng.uniform(0, w), rng.uniform(0, h))
        if room.contains(thing) and taken.distance(thing) > 1.0:
            taken |= thing
    return hall - taken


def points_on(free: Any, count: int, rng: np.random.Generator) -> Array:
    """So many random points, each 0.7 m from the others."""
    found = np.zeros((0, 2))
    while len(found) < count:
        point = rng.uniform(0.0, SIZE)
        apart = len(found) == 0 or np.hypot(*(found - point).T).min() > 0.7
        if apart and shapely.intersects_xy(free, *point):
            found = np.concatenate([found, point[None]])
    return found


def shortest(floor: Any, starts: Array, goals: Array) -> Array:
    """(N,) lengths of the shortest ways for the centres of bodies, m."""
    free = floor.buffer(-RADIUS, quad_segs=3)
    rings = (free.exterior, *free.interiors)
    corners = np.concatenate([np.asarray(r.coords)[:-1] for r in rings])
    points = np.concatenate([starts, goals, corners])
    room = free.buffer(1e-3)
    shapely.prepare(room)
    table = np.full((len(points), len(points)), np.inf)
    for k in range(len(points) - 1):
        others = points[k + 1 :]
        lines = shapely.linestrings(np.stack([np.broadcast_to(points[k], others.shape), others], 1))
        sees = shapely.contains(room, lines)
        table[k, k + 1 :][sees] = np.hypot(*(others - points[k]).T)[sees]
    n = len(starts)
    return np.asarray(dijkstra(table, directed=False, indices=np.arange(n)))[
        range(n), range(n, 2 * n)
    ]


def write_geojson(floor: Any, folder: Path) -> str:
    """In centimetres, from another origin."""
    scaled = affinity.affine_transform(floor, [100, 0, 0, 100, 500, -300])
    feature = {
        "type": "Feature",
        "properties": {},
        "geometry": json.loads(shapely.to_geojson(scaled)),
    }
    (folder / "plan.geojson").write_text(json.dumps(feature))
    return "file: plan.geojson\n    unit: cm\n    origin: [-5 m, 3 m]"


def write_ros_map(floor: Any, folder: Path) -> str:
    """An occupancy grid, its first row the topmost."""
    columns, rows = (round((side + 1.0) / CELL) for side in SIZE)
    x = -0.5 + CELL * (np.arange(columns) + 0.5)
    y = -0.5 + CELL * (np.arange(rows) + 0.5)
    shapely.prepare(floor)
    free = shapely.intersects_xy(floor, *np.meshgrid(x, y[::-1]))
    head = f"P5\n{columns} {rows}\n255\n".encode()
    (folder / "map.pgm").write_bytes(head + np.where(free, 254, 0).astype(np.uint8).tobytes())
    (folder / "map.yaml").write_text(
        f"image: map.pgm\nresolution: {CELL}\norigin: [-0.5, -0.5, 0.0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    return "file: map.yaml"


def engine_of(folder: Path, plan: str, starts: Array, goals: Array) -> CrowdEngine:
    """The crowd of a document that names the plan."""
    agents = "".join(
        f"      - {{id: {k}, x: {a[0]:.4f}, y: {a[1]:.4f}, goals: [[{b[0]:.4f}, {b[1]:.4f}]], "
        "at_goal: remove}\n"
        for k, (a, b) in enumerate(zip(starts, goals, strict=True))
    )
    (folder / "plan.yaml").write_text(
        f"""crowdbot: 1
scenario:
  id: plan
  environment:
    kind: floor_plan
    {plan}
  robots: {{}}
  crowd:
    body.radius: {RADIUS} m
    speed: {{mean: 1.3 m/s, std: 0.2 m/s}}
    routing: {{kind: mesh}}
    policy: {{kind: velocity_space, contact_stiffness: 250 1/s^2}}
    costs:
      avoid: {{kind: ttca_dca, weight: 20, range: 5 m}}
      reflex: {{kind: rvo, range: {{value: 0.3 m, measure: surface}}}}
    agents:
{agents}"""
    )
    (scenario,) = open_spec(str(folder / "plan.yaml"), REGISTRY).scenarios
    parts = build_environment(REGISTRY, scenario.environment)
    engine = build_crowd(scenario, population(scenario, REGISTRY).agents, parts, REGISTRY)
    assert engine is not None
    return engine


@pytest.mark.slow
@pytest.mark.parametrize(("write", "seed"), [(write_geojson, 41), (write_ros_map, 42)])
def test_a_hundred_people(write: Any, seed: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(seed)
    floor = floor_of(rng)
    free = floor.buffer(-RADIUS - 2.0 * CELL)
    assert free.geom_type == "Polygon"  # so that everybody can get everywhere
    starts, goals = points_on(free, PEOPLE, rng), points_on(free, PEOPLE, rng)
    expected = shortest(floor, starts, goals)
    assert np.all(np.isfinite(expected))
    engine = engine_of(tmp_path, write(floor, tmp_path), starts, goals)
    flat = engine.initial_state()
    _, rows = s.view(flat)
    inside = floor.buffer(2.0 * CELL)
    shapely.prepare(inside)
    for tick in range(0, 120 * 128, 8):
        left = 8
        while left:
            left -= engine.advance_alone(flat, left)
        here = rows[:, s.WAITING] == s.PRESENT
        x, y = rows[here][:, [s.X, s.Y]].T
        assert np.all(shapely.intersects_xy(inside, x, y)), f"in a wall at {tick / 128} s"
        if not here.any():
            break
    assert np.all(rows[:, s.WAITING] == s.GONE)  # everybody has arrived
    walked, shortest_sum = rows[:, s.WALKED].sum(), (expected - RADIUS).sum()
    print(f"walked {walked:.1f} m, shortest {shortest_sum:.1f} m, {walked / shortest_sum:.4f}")
    assert walked == pytest.approx(shortest_sum, rel=0.05)
