"""What a recording says about choices comes back, and changes no number that was recorded."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.recording.header import AgentsHeader, RecordingHeader
from crowdbot.core.recording.motion.candidates import (
    MOST_CANDIDATES,
    CandidateGroup,
    GoalChanges,
    GoalsReader,
    candidate_table,
)
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.runs.provenance import trajectory_hash
from crowdbot.core.sim.crowd_only import run_crowd
from crowdbot.core.sim.run_setup import agents, choosers, ids
from crowdbot.core.types.candidates import VelocityCandidates
from crowdbot.dsl.scenario.steering import SteeringSpec
from crowdbot.errors import InputError
from crowdbot.plugins.crowd.policies.velocity_space import VelocitySpaceSpec
from crowdbot.plugins.crowd.policies.velocity_space_build import candidates_of
from tests.core.crowd.crowd_worlds import challenge

UNIT = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])


def group(rows: list[int], unit: Any = UNIT) -> CandidateGroup:
    """People who choose among a few velocities."""
    count = len(rows)
    return CandidateGroup(
        candidates=VelocityCandidates(np.asarray(unit, np.float64), 0.5),
        rows=np.array(rows, np.int64),
        preferred_speed=np.full(count, 1.2),
        radius=np.full(count, 0.33),
        max_acceleration=np.full(count, 5.0),
    )


def recorded(path: Path, engine: CrowdEngine, known: list[CandidateGroup]) -> Path:
    """People alone for some seconds."""
    header = RecordingHeader(scenario="test/one", agents=agents(engine))
    writer = RecordingWriter(path, header, record="none", choosers=known)
    run_crowd(engine, RunLog(writer, ids(engine), goal_column=engine.goal_column), 6.0, 16.0)
    writer.close(None, True, "timeout")
    return path


@pytest.mark.slow
def test_known_choices_make_a_crowd_small_and_change_nothing(tmp_path: Path) -> None:
    engine = challenge("counter-d0250-dispersed-c20-r05")
    known = choosers(engine)
    assert [len(one.rows) for one in known] == [len(engine.agents)]
    small = recorded(tmp_path / "known.mcap", engine, known)
    large = recorded(tmp_path / "unknown.mcap", engine, [])
    assert trajectory_hash(Recording(small).trajectories()) == trajectory_hash(
        Recording(large).trajectories()
    )
    assert small.stat().st_size < 0.5 * large.stat().st_size


def test_candidates_that_steering_changes_are_left_out(tmp_path: Path) -> None:
    plain = challenge("counter-d0125-slow-c20-r05")
    wander = SteeringSpec.model_validate({"wander": {"deviation": "0.2 m/s^2", "time": "0.6 s"}})
    world = replace(plain.world, steering=Steering(wander, key=7))
    steered = CrowdEngine(plain.agents, world, list(plain.policies))
    assert choosers(steered) == []
    with_candidates = recorded(tmp_path / "with.mcap", steered, choosers(plain))
    without = recorded(tmp_path / "without.mcap", steered, [])
    assert without.stat().st_size < with_candidates.stat().st_size
    assert trajectory_hash(Recording(without).trajectories()) == trajectory_hash(
        Recording(with_candidates).trajectories()
    )


def test_groups_come_back() -> None:
    one = group([4, 1])
    back = CandidateGroup.from_message(one.to_message(), 5)
    assert np.array_equal(back.candidates.unit, UNIT)
    assert back.candidates.relaxation_time == 0.5
    assert back.rows.tolist() == [4, 1]
    assert back.max_acceleration.tolist() == [5.0, 5.0]
    table = candidate_table(5, [group([0], UNIT[:1]), back])
    assert table.choices.tolist() == [1, 3, 0, 0, 3]
    assert table.first.tolist() == [0, 1, 0, 0, 1]


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"person": np.array([7], np.uint32)}, "person 7 of 5"),
        ({"radius": np.zeros(2)}, "do not fit each other"),
        ({"relaxation_time": 0.0}, "relaxation time"),
        ({"unit": SimpleNamespace(shape=np.array([0, 2]), data=np.zeros(0))}, "0 candidates"),
        ({"unit": SimpleNamespace(shape=np.array([1, 2]), data=np.full(2, np.nan))}, "finite"),
    ],
)
def test_groups_that_contradict_themselves_are_refused(
    changes: dict[str, Any], reason: str
) -> None:
    message = group([1]).to_message()
    for name, value in changes.items():
        setattr(message, name, value)
    with pytest.raises(ValueError, match=reason):
        CandidateGroup.from_message(message, 5)


def test_too_many_candidates_are_not_used(tmp_path: Path) -> None:
    many = group([0], np.zeros((MOST_CANDIDATES + 1, 2)))
    assert not many.fits
    path, position = tmp_path / "run.mcap", np.zeros((4, 1))
    numbers = np.zeros(1)
    header = RecordingHeader(
        scenario="test/one",
        agents=AgentsHeader(id=np.zeros(1, np.int64), radius=numbers + 0.3, mass=numbers + 75.0),
    )
    writer = RecordingWriter(path, header, record="none", choosers=[many])
    writer.state(0.0, None, position)
    writer.close(None, True, "timeout")
    assert Recording(path).trajectories().agents is not None


@settings(max_examples=50)
@given(
    goals=arrays(np.float64, (9, 2, 3), elements=st.sampled_from([0.0, -0.0, 1.5, np.nan, 40.25])),
    block=st.integers(1, 9),
)
def test_goals_come_back_from_their_changes(goals: np.ndarray[Any, Any], block: int) -> None:
    writes = GoalChanges(3)
    starts = range(0, len(goals), block)
    messages = [writes.message(k, goals[k : k + block].copy()) for k in starts]
    reads = GoalsReader(3, [m for m in messages if m is not None])
    back = np.concatenate([reads.goals(k, len(goals[k : k + block])) for k in starts])
    assert back.tobytes() == goals.tobytes()


@pytest.mark.parametrize(
    "message",
    [
        {"sample": [0, 1], "person": [0], "x": [0.0, 0.0], "y": [0.0, 0.0]},
        {"sample": [1, 0], "person": [0, 0], "x": [0.0, 0.0], "y": [0.0, 0.0]},
        {"sample": [0], "person": [2], "x": [0.0], "y": [0.0]},
    ],
)
def test_changes_that_contradict_themselves_are_refused(message: dict[str, list[float]]) -> None:
    columns = SimpleNamespace(**{name: np.array(column) for name, column in message.items()})
    with pytest.raises(InputError, match="changes of goals"):
        GoalsReader(2, [columns])


@pytest.mark.parametrize(
    "changes",
    [
        {"method": "gradient"},
        {"samples": "random"},
        {"base": "current_velocity"},
        {"direction": "unit"},
        {"radius": "maximum_speed"},
    ],
)
def test_only_fixed_candidates_around_the_way_to_the_goal_are_listed(
    changes: dict[str, str],
) -> None:
    assert candidates_of(VelocitySpaceSpec()) is not None
    assert candidates_of(VelocitySpaceSpec(**changes)) is None  # type: ignore[arg-type]
