"""Planted faults each lower the part that names them; the calibrated crowd is human enough."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.realism.corridor import Corridor, simulate
from crowdbot.core.realism.measure import DIAGRAM, LANES, Realism, measure_met, measure_tracks
from crowdbot.core.realism.model import CrowdModel, ghosts, model_of
from crowdbot.core.realism.reference import shipped
from crowdbot.core.realism.tracks import CorridorTracks
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.named_crowds import open_crowd
from crowdbot.errors import InputError

pytestmark = pytest.mark.slow
PLACES = [
    Corridor(flow=f, density=d, warm_up=5.0, duration=6.0)
    for f in ("uni", "counter")
    for d in (0.45, 0.9, 1.4)
]


def measured(tracks: Sequence[CorridorTracks]) -> Realism:
    return measure_tracks("made up", [tracks], shipped())


@cache
def model() -> CrowdModel:
    registry = discover(allow=())
    return model_of(open_crowd("calibrated", registry), registry)


@cache
def usual() -> tuple[list[CorridorTracks], Realism]:
    tracks = [simulate(model(), place) for place in PLACES]
    return tracks, measured(tracks)


def changed(other: CrowdModel) -> Realism:
    return measured([simulate(other, place) for place in PLACES])


def test_people_who_are_a_fifth_too_fast() -> None:
    own = usual()[1].parts
    parts = model().steering.spec
    assert parts.time_gap is not None
    shorter = parts.time_gap.model_copy(update={"time": parts.time_gap.time / 1.2})
    hurried = replace(
        model(),
        speed=1.2 * model().speed,
        steering=Steering(parts.model_copy(update={"time_gap": shorter})),
    )
    found = changed(hurried).parts
    assert found["speed"] < own["speed"] - 0.05
    assert found[DIAGRAM] < own[DIAGRAM] - 0.05


def test_people_who_avoid_nobody() -> None:
    own, found = usual()[1].parts, changed(replace(model(), policy=ghosts)).parts
    alone = changed(CrowdModel(policy=ghosts)).parts
    for part in ("nearest", "time_to_collision"):
        assert alone[part] < own[part] - 0.1
        assert found[part] <= own[part]


def test_people_who_jitter() -> None:
    tracks, own = usual()
    rng = np.random.default_rng(1)
    shaken = [
        replace(t, position=t.position + d, way=t.way + d)
        for t in tracks
        for d in [rng.normal(0.0, 0.1, t.way.shape)]
    ]
    found = measured(shaken).parts
    assert found["acceleration"] < own.parts["acceleration"] - 0.05
    assert found["turning"] < own.parts["turning"] - 0.05


def test_lanes_that_are_destroyed() -> None:
    tracks, own = usual()
    rng = np.random.default_rng(2)
    mirrored = []
    for t in tracks:
        side = np.where(rng.random(t.way.shape[1]) < 0.5, -1.0, 1.0)
        flip = np.stack([np.ones_like(side), side], axis=-1)
        mirrored.append(replace(t, position=t.position * flip, way=t.way * flip))
    found = measured(mirrored)
    assert found.parts[LANES] < own.parts[LANES] - 0.05
    assert found.beside.lane_error > own.beside.lane_error + 0.05


def test_bodies_that_are_wider() -> None:
    own = usual()[1]
    found = changed(replace(model(), radius=0.3, avoided_radius=0.3))
    assert found.parts["nearest"] < own.parts["nearest"] - 0.03
    assert found.beside.nearest_error[0] > own.beside.nearest_error[0]


def test_two_draws_are_close_and_one_is_repeatable() -> None:
    tracks, own = usual()
    again = [simulate(model(), place) for place in PLACES[:1]]
    assert again[0].way.tobytes() == tracks[0].way.tobytes()
    other = measured([simulate(model(), replace(place, seed=7)) for place in PLACES])
    for place in PLACES:
        cell = place.flow, f"{place.density:g}"
        assert other.cells[cell] == pytest.approx(own.cells[cell], abs=0.08), cell
    assert own.parts["speed"] > 0.4


def test_runs_are_compared_in_the_densities_that_they_meet() -> None:
    tracks, _ = usual()
    sparse = [t for t, place in zip(tracks, PLACES, strict=True) if place.density < 1.0]
    found = measure_met("runs", [sparse], shipped())
    assert 0.5 < found.index < 1.2, "a density without people does not count"
    assert measured(sparse).index < found.index - 0.3
    assert found.coverage.startswith(f"{len(found.cells)} of 8 conditions")
    blind = [simulate(CrowdModel(policy=ghosts), place) for place in PLACES if place.density < 1.0]
    assert measure_met("runs", [blind], shipped()).index < found.index - 0.3


def test_runs_that_meet_too_little_have_no_index() -> None:
    thin = simulate(model(), replace(PLACES[0], density=0.1))
    with pytest.raises(InputError, match=r"too few people for an index: [01] of 8 conditions"):
        measure_met("runs", [[thin]], shipped())
