"""No one is ever inside anything solid: every packaged crowd in every place that comes along."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact.solid import MOST_OVERLAP
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.scenarios.named_crowds import crowd_parts, open_crowd
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError
from crowdbot.plugin import EnvironmentParts
from tests.paths import ROOT

EXAMPLES = ROOT / "scenario_specs" / "examples"
PLACES = sorted(path.stem for path in EXAMPLES.glob("world_*.yaml"))
REGISTRY: Registry = discover(allow=())
NAMES = sorted(crowd_parts(REGISTRY))
#: What a named crowd decides by; its speeds and bodies stay those of the place.
MODEL = ("policy", "costs", "solids", "contact_dissipation", "steering")
TICKS = 128


class Place(NamedTuple):
    """A scenario, its floor, and its people at the start."""

    scenario: Scenario
    parts: EnvironmentParts
    people: Realisation


@cache
def _place(name: str, times: int) -> Place:
    """An example with several times as many people in each spawn, or as many as fit."""
    scenario = pick(open_spec(str(EXAMPLES / f"{name}.yaml"), REGISTRY), None)
    parts = build_environment(REGISTRY, scenario.environment)
    while True:
        more = _with_people(scenario, times)
        try:
            return Place(more, parts, realise(more, parts))
        except InputError:
            times -= 1


def _with_people(scenario: Scenario, times: int) -> Scenario:
    crowd = scenario.crowd
    assert crowd is not None
    assert times > 0
    spawns = {
        name: spawn.model_copy(update={"count": times * spawn.count}) if spawn.count else spawn
        for name, spawn in crowd.spawns.items()
    }
    return scenario.model_copy(update={"crowd": crowd.model_copy(update={"spawns": spawns})})


@cache
def _named(name: str) -> Crowd:
    return open_crowd(name, REGISTRY)


def _engine(place: Place, name: str, *, straight: bool) -> CrowdEngine:
    own, named = place.scenario.crowd, _named(name)
    assert own is not None
    model = {field: getattr(named, field) for field in MODEL}
    crowd = own.model_copy(update=model | ({"routing": None} if straight else {}))
    scenario = place.scenario.model_copy(update={"crowd": crowd})
    engine = build_crowd(scenario, place.people, place.parts, REGISTRY)
    assert engine is not None
    assert engine.world.firm
    return engine


def _throw_at_walls(rows: Array, engine: CrowdEngine) -> None:
    """Put people beside walls and pillars, where there is room, on their way into these."""
    rng, world, radius = np.random.default_rng(1), engine.world, engine.agents.radius
    faces = world.walls[rng.integers(0, len(world.walls), len(rows))]
    along = faces[:, 2:] - faces[:, :2]
    along /= np.hypot(*along.T)[:, np.newaxis]
    left = np.column_stack([-along[:, 1], along[:, 0]])  # the free side
    share = rng.uniform(0.0, 1.0, (len(rows), 1))
    at = faces[:, :2] * (1.0 - share) + faces[:, 2:] * share + left * 1.1 * radius[:, np.newaxis]
    if len(world.pillars):
        x, y, size = world.pillars[rng.integers(0, len(world.pillars), len(rows))].T
        angle, half = rng.uniform(0.0, 6.3, len(rows)), rng.random(len(rows)) < 0.5
        out = np.column_stack([np.cos(angle), np.sin(angle)])
        beside = np.column_stack([x, y]) + out * (size + 1.1 * radius)[:, np.newaxis]
        at[half], left[half] = beside[half], out[half]
    free = _gap(at, engine) >= radius
    rows[free, s.X : s.Y + 1], rows[free, s.VX : s.VY + 1] = at[free], -2.0 * left[free]


def _gap(at: Array, engine: CrowdEngine) -> Array:
    """Return distances of points from walls and pillars, m; 0 in solids."""
    points = shapely.points(at)
    gap = shapely.distance(
        points, shapely.MultiLineString(list(engine.world.walls.reshape(-1, 2, 2)))
    )
    for x, y, radius in engine.world.pillars.tolist():
        gap = np.minimum(gap, np.hypot(at[:, 0] - x, at[:, 1] - y) - radius)
    for outline in engine.world.solids:
        gap[shapely.contains(shapely.Polygon(outline), points)] = 0.0
    return np.asarray(gap)


def _walk(place: Place, name: str, seconds: float, *, straight: bool = False) -> None:
    """Assert at each sixteenth of a second that all are out of walls, pillars and solids.

    Nobody is fast enough to get through a wall in between.
    """
    engine = _engine(place, name, straight=straight)
    radius = engine.agents.radius
    flat = engine.initial_state()
    _, rows = s.view(flat)
    if straight:
        _throw_at_walls(rows, engine)
    for tick in range(int(seconds * TICKS)):
        engine.advance(flat)
        if tick % 8 != 7:
            continue
        here = rows[:, s.WAITING] == s.PRESENT
        at = rows[here][:, [s.X, s.Y]]
        assert np.isfinite(at).all()
        assert np.all(_gap(at, engine) >= radius[here] - MOST_OVERLAP - 1e-6), (tick, at)


@pytest.mark.parametrize("place", PLACES)
def test_all_crowds_stay_out_of_what_is_solid(place: str) -> None:
    """For half a second, straight into walls and pillars, if they could."""
    for name in NAMES:
        _walk(_place(place, 1), name, 0.5, straight=True)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("place", PLACES)
def test_crushes_stay_out_of_what_is_solid(place: str, name: str) -> None:
    """For ten seconds, with four times as many people, or as many as fit."""
    _walk(_place(place, 4), name, 10.0)
