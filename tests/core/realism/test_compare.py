"""The comparison itself, by hand-computed cases and by what holds for all histograms."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.realism.bins import FEATURES
from crowdbot.core.realism.compare import beside, compared_cells, score, similarity
from crowdbot.core.realism.corridor import Corridor, simulate
from crowdbot.core.realism.features import NEAREST, SPEED, features
from crowdbot.core.realism.model import CrowdModel, ghosts
from crowdbot.core.realism.reference import RealismReference, reference_of, shipped
from crowdbot.core.realism.statistics import Statistics, statistics_of
from crowdbot.core.realism.tables import real_beside
from crowdbot.core.realism.tracks import CorridorTracks, tracks_of
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

COUNTS = st.lists(st.integers(0, 500), min_size=5, max_size=5).filter(lambda v: sum(v) > 0)


@settings(max_examples=60)
@given(COUNTS, COUNTS)
def test_similarity_is_symmetric_within_0_and_1_and_of_shares(a: list[int], b: list[int]) -> None:
    p, q = np.array(a, np.float64), np.array(b, np.float64)
    found = similarity(p, q)
    assert 0.0 <= found <= 1.0
    assert found == pytest.approx(similarity(q, p))
    assert found == pytest.approx(similarity(7.0 * p, q))
    assert similarity(p, p) == pytest.approx(1.0)


def test_similarity_by_hand() -> None:
    apart = similarity(np.array([1.0, 0.0]), np.array([0.0, 1.0]))
    assert apart == pytest.approx(0.0, abs=0.01)
    # Shares 1/2, 1/2 and 1, 0: JSD = 0.311 bit.
    assert similarity(np.array([1.0, 1.0]), np.array([1.0, 0.0])) == pytest.approx(
        1.0 - 0.3113**0.5, abs=0.002
    )


def people(velocities: Array, places: Array, frames: int = 60) -> CorridorTracks:
    t = np.arange(frames) * 0.25
    at = places[np.newaxis] + t[:, np.newaxis, np.newaxis] * velocities[np.newaxis]
    run = Trajectories.from_arrays(
        t=t, agent_x=at[..., 0], agent_y=at[..., 1], agent_radius=0.2, agent_mass=75.0
    )
    return tracks_of(run, "made up", width=2.0)


def test_features_of_two_who_meet() -> None:
    places = np.array([[-4.0, 0.0], [4.0, 0.6], [-4.0, 0.6]])
    tracks = people(np.array([[1.0, 0.0], [-1.0, 0.0], [1.0, 0.0]]), places, 34)
    assert tracks.flow == "counter"
    rows, windows = features(tracks)
    assert np.allclose(rows[:, SPEED], 1.0)
    # The two who walk side by side are 0.6 m apart, all the time; the third meets one of them.
    beside = rows[np.isclose(rows[:, NEAREST], 0.6, atol=1e-6)]
    assert len(beside) >= 0.6 * len(rows)
    assert rows[:, NEAREST].max() == pytest.approx(3.5)
    assert len(windows)


def test_lane_order_by_hand() -> None:
    # Two lanes 1 m apart, each one-way: order 1. Both ways in one lane: less.
    x = np.linspace(-5.0, 5.0, 11)
    ordered = np.array([(v, 0.5) for v in x] + [(v, -0.5) for v in x])
    way = np.array([[0.05, 0.0]] * 11 + [[-0.05, 0.0]] * 11)
    mixed = np.where(np.arange(22)[:, None] % 2 == 0, way, -way)
    one = features(people(way, ordered))[1][:, 3]
    other = features(people(mixed, ordered))[1][:, 3]
    assert np.nanmean(one) == pytest.approx(1.0)
    assert np.nanmean(other) < 0.5


def crowd(seed: int = 0, turn: float = 0.0, rate: float = 4.0) -> Trajectories:
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 24.0, 1.0 / rate)
    places = np.column_stack([rng.uniform(-6.0, 6.0, 30), rng.uniform(-1.2, 1.2, 30)])
    v = rng.normal(0.2, 0.05, 30)
    at = np.zeros((len(t), 30, 2))
    at[..., 0] = places[:, 0] + v * (t[:, np.newaxis] - 12.0)
    at[..., 1] = places[:, 1] + 0.05 * np.sin(t[:, np.newaxis] + places[:, 0])
    c, s = np.cos(turn), np.sin(turn)
    at = at @ np.array([[c, s], [-s, c]])
    return Trajectories.from_arrays(
        t=t, agent_x=at[..., 0], agent_y=at[..., 1], agent_radius=0.2, agent_mass=75.0
    )


def test_direction_and_rate_of_a_recording_do_not_matter() -> None:
    plain = statistics_of([tracks_of(crowd(), "a")])
    for other in (crowd(turn=0.7), crowd(rate=16.0)):
        found = statistics_of([tracks_of(other, "b")])
        for cell in compared_cells(plain):
            for name in FEATURES:
                near = similarity(found.histograms[cell][name], plain.histograms[cell][name])
                assert near > 0.75, (cell, name)


def test_what_cannot_be_compared_is_refused() -> None:
    nobody = Trajectories.from_arrays(
        t=[0.0, 1.0], robot_x=[0, 0], robot_y=[0, 0], robot_theta=[0, 0], robot_radius=0.2,
        robot_mass=1.0,
    )  # fmt: skip
    with pytest.raises(InputError, match=r"alone\.csv: there are no people"):
        tracks_of(nobody, "alone.csv")
    short = Trajectories.from_arrays(
        t=[0.0, 0.25], agent_x=[[0.0], [1.0]], agent_y=[[0.0], [0.0]], agent_radius=0.2,
        agent_mass=70.0,
    )  # fmt: skip
    with pytest.raises(InputError, match="too short"):
        tracks_of(short, "short.csv")


def test_shipped_reference() -> None:
    reference = shipped()
    assert 0.8 < reference.ceiling.score < 0.95
    assert 0.5 < reference.floor.score < 0.6
    assert reference.index(reference.ceiling.score) == pytest.approx(1.0)
    assert reference.index(reference.floor.score) == pytest.approx(0.0)
    assert len(compared_cells(reference.whole)) == 8
    assert reference.sources
    near = real_beside(reference)
    assert near.lane_error < 0.1
    again = RealismReference.from_json(json.loads(json.dumps(reference.as_json())))
    assert again.ceiling.score == pytest.approx(reference.ceiling.score, abs=0.002)


def test_recorded_people_are_as_recorded_people() -> None:
    whole = shipped().whole
    assert score(whole, whole).score == pytest.approx(1.0)
    assert beside(whole, whole).diagram_error == pytest.approx(0.0)
    nothing = Statistics(histograms={}, diagram={}, lanes={}, nearest={}, pairs={})
    assert score(nothing, whole).score == 0.0


def of_one_kind(count: int, flow: str = "uni") -> list[CorridorTracks]:
    """Short recordings of people who are alike."""
    places = (Corridor(flow=flow, density=0.9, seed=k, duration=5.0) for k in range(count))
    return [simulate(CrowdModel(policy=ghosts), place) for place in places]


def test_few_recordings_of_the_same_people_are_about_as_good_as_people() -> None:
    """Halves of few recordings are less alike than each is with the rest, so the index rises."""
    runs = of_one_kind(8)
    reference = reference_of(runs[:5], ["five runs"], floors={"none": statistics_of([])})
    same = statistics_of(runs[5:])
    halves = replace(reference, folds=(reference.halves, reference.halves[::-1]))
    assert len(reference.folds) == 5
    assert reference.ceiling.score > halves.ceiling.score
    assert reference.score(same).score <= reference.ceiling.score + 0.03


def test_recordings_without_a_density_in_common_are_refused() -> None:
    runs = [*of_one_kind(1), *of_one_kind(1, "counter")]
    with pytest.raises(InputError, match="no two parts have people at the same density"):
        reference_of(runs, ["a.csv", "b.csv"])
