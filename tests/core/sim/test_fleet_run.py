"""Several robots in one run: what each does, sees and leaves behind."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from crowdbot.cli import main
from crowdbot.core.realism.recordings import read_runs
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.registry.registry import discover
from crowdbot.core.runs.provenance import trajectory_hash
from crowdbot.core.scoring.scores_csv import read_scores_csv
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError
from tests.core.sim.fleets import PEOPLE, robot, run, scenario

REGISTRY = discover()


@pytest.mark.slow
def test_robots_that_do_not_meet_do_what_each_does_alone(tmp_path: Path) -> None:
    two = {
        "a": robot(-6.0, -1.5, 0.0, "east", 2.0),
        "b": robot(6.0, 1.5, 0.0, "west", 3.0, model="pepper", control="force"),
    }
    both = run(scenario(tmp_path, REGISTRY, two), REGISTRY, tmp_path / "both")
    assert set(both.robots) == {"a", "b"}
    for name, one in two.items():
        alone = run(scenario(tmp_path, REGISTRY, {name: one}), REGISTRY, tmp_path / name)
        mine, own = both.robots[name].robot, alone.trajectories.robot
        for column in ("x", "y", "theta", "v", "w"):
            assert np.array_equal(getattr(mine, column), getattr(own, column)), (name, column)
        assert trajectory_hash(both.robots[name]) == trajectory_hash(alone.trajectories)


@pytest.mark.slow
def test_a_run_says_of_each_robot_and_of_the_fleet(tmp_path: Path) -> None:
    two = {
        "a": robot(7.0, -1.5, 0.0, "east", 4.0, when_ended="leave"),
        "b": robot(-6.0, 1.5, 0.0, "east", 2.5),
    }
    made = scenario(tmp_path, REGISTRY, two, PEOPLE)
    one = run(made, REGISTRY, tmp_path / "one", planner="a=goal_seek,b=stand_still")
    again = run(made, REGISTRY, tmp_path / "again", planner="a=goal_seek,b=stand_still")
    record = one.record
    assert record.status == "timeout"
    assert record.robots["a"].status == "arrived"
    assert record.robots["b"].status == "timeout"
    assert record.robots["b"].planner.name == "stand_still"
    assert record.hashes == again.record.hashes
    assert one.robots["a"].t[-1] < one.robots["b"].t[-1] == 2.5
    rows = {(r.score.metric, r.score.variant): r.score for r in read_scores_csv(
        one.directory / "scores.csv")}  # fmt: skip
    assert rows["success", "corrected@a"].value == 1.0
    assert rows["success", "corrected@b"].value == 0.0
    assert rows["success", "corrected"].value == 0.5
    with pytest.raises(InputError, match="several robots: a, b"):
        Recording(one.directory / "run.mcap").trajectories()
    named = Trajectories.from_mcap(one.directory / "run.mcap", robot="a")
    assert trajectory_hash(named) == trajectory_hash(one.robots["a"])
    (compared,), _ = read_runs([one.directory / "run.mcap"])
    people = one.robots["b"].agents  # b ended last
    assert people is not None
    assert compared.way.shape[1] == people.x.shape[1]
    table = tmp_path / "b"
    order = ["export", str(one.directory), "--to", "csv", "--robot", "b", "--out", str(table)]
    assert main(order) == 0
    lines = (table / "robot.csv").read_text().splitlines()
    assert len(lines) == len(one.robots["b"].t) + 1
    agents = one.robots["b"].agents
    assert agents is not None
    assert np.isfinite(agents.x).all()


@pytest.mark.slow
def test_head_on_they_push_each_other_equally(tmp_path: Path) -> None:
    two = {"a": robot(-0.6, 0.0, 0.0, "east", 2.5), "b": robot(0.6, 0.05, 180.0, "west", 2.5)}
    done = run(scenario(tmp_path, REGISTRY, two), REGISTRY, tmp_path / "out")
    a, b = (done.robots[name].contacts for name in "ab")
    assert a is not None
    assert b is not None
    assert len(a.t0) >= 1
    assert a.agent.tolist() == [-3] * len(a.t0)
    assert b.agent.tolist() == [-2] * len(b.t0)
    assert np.array_equal(a.impulse, b.impulse)
    assert np.all(a.impulse > 0.0)
    assert np.all(np.abs(a.bearing) < 0.5)
    assert np.all(np.abs(b.bearing) < 0.5)
    first, second = done.robots["a"].robot, done.robots["b"].robot
    apart = np.hypot(first.x - second.x, first.y - second.y)
    assert apart.min() > 2 * 0.178 - 0.03  # they do not drive through each other


@pytest.mark.slow
def test_the_lidar_of_one_sees_the_other(tmp_path: Path) -> None:
    two = {"a": robot(0.0, 0.0, 0.0, "east", 0.5), "b": robot(2.0, 0.0, 0.0, "west", 0.5)}
    made = scenario(tmp_path, REGISTRY, two)
    done = run(made, REGISTRY, tmp_path / "out", planner="stand_still", record="all")
    recording = Recording(done.directory / "run.mcap")
    (ahead,), (behind,) = recording.scans(robot="a"), recording.scans(robot="b")
    front = np.argmin(np.abs(ahead.angles))
    assert abs(ahead.ranges[0, front] - (2.0 - 0.178)) < 0.02
    assert behind.ranges[0].max() > 2.0  # b looks away from a, along the hall


@pytest.mark.slow
@pytest.mark.parametrize("when_ended", ["stay", "leave"])
def test_a_robot_that_has_ended_stays_or_leaves(tmp_path: Path, when_ended: str) -> None:
    two = {
        "a": robot(0.0, 0.0, 0.0, "east", 4.0),
        "b": robot(1.0, 0.0, 0.0, "west", 0.5, when_ended=when_ended),
    }
    made = scenario(tmp_path, REGISTRY, two)
    done = run(made, REGISTRY, tmp_path / "out", planner="a=goal_seek,b=stand_still")
    assert done.record.robots["b"].sim_time == 0.5
    touched = len(done.robots["a"].contacts.t0) > 0
    assert touched == (when_ended == "stay")
    there = done.robots["a"].robot.x[-1]
    assert there > 1.3 or when_ended == "stay"


@pytest.mark.slow
def test_topics_and_frames_are_those_of_each_robot(tmp_path: Path) -> None:
    two = {"a": robot(-6.0, -1.5, 0.0, "east", 0.5), "b": robot(6.0, 1.5, 0.0, "west", 0.5)}
    made = scenario(tmp_path, REGISTRY, two, PEOPLE)
    done = run(made, REGISTRY, tmp_path / "out", record="all")
    frames: dict[str, set[str]] = {}
    with (done.directory / "run.mcap").open("rb") as file:
        for _, channel, message in make_reader(file).iter_messages():
            text = message.data.decode("ascii", "ignore")
            found = {f for f in ("a/lidar", "b/lidar", "a/base_footprint", "b/base_link", "map")
                     if f"{f}\0" in text}  # fmt: skip
            frames.setdefault(channel.topic, set()).update(found)
            assert "\x05\0\0\0odom\0" not in text  # a frame of nobody
    assert frames["/a/lidar/scan"] == {"a/lidar"}
    assert frames["/b/lidar/scan"] == {"b/lidar"}
    assert {"a/base_footprint", "map"} <= frames["/tf"]
    assert {"a/lidar", "b/lidar", "b/base_link"} <= frames["/tf_static"]
    assert frames["/pedestrians"] == {"map"}
    shared = {"/clock", "/pedestrians", "/walls_marker", "/map", "/crowdbot/state"}
    assert shared <= set(frames)
    assert "/a/clock" not in frames
    assert "/a/map" not in frames


def test_robots_that_would_start_in_each_other_are_refused(tmp_path: Path) -> None:
    two = {"a": robot(0.0, 0.0, 0.0, "east"), "b": robot(0.3, 0.0, 0.0, "west")}
    with pytest.raises(InputError, match="'a' and 'b' would start in each other"):
        run(scenario(tmp_path, REGISTRY, two), REGISTRY, tmp_path / "out")


def test_planners_are_for_the_robots_there_are(tmp_path: Path) -> None:
    two = {"a": robot(0.0, 0.0, 0.0, "east"), "b": robot(1.0, 0.0, 0.0, "west")}
    made = scenario(tmp_path, REGISTRY, two)
    with pytest.raises(InputError, match="'b' has no planner"):
        run(made, REGISTRY, tmp_path / "out", planner="a=dwa")
    with pytest.raises(InputError, match="unknown robot 'c'"):
        run(made, REGISTRY, tmp_path / "out", planner="a=dwa,b=dwa,c=dwa")


def test_when_ended_is_outside_the_hash_while_it_is_as_usual(tmp_path: Path) -> None:
    usual = scenario(tmp_path, REGISTRY, {"a": robot(0.0, 0.0, 0.0, "east")})
    leaves = scenario(tmp_path, REGISTRY, {"a": robot(0.0, 0.0, 0.0, "east", when_ended="leave")})
    dumps = [str(one.model_dump(mode="json")) for one in (usual, leaves)]
    assert ["when_ended" in text for text in dumps] == [False, True]
    assert hashlib.sha256(dumps[0].encode()) != hashlib.sha256(dumps[1].encode())


@pytest.mark.slow
def test_what_ends_is_recorded_at_its_tick(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One after the other: the first robot brushes past somebody, and three people arrive."""
    counts: dict[RunLog, list[tuple[int, int]]] = {}
    record = RunLog.record_events

    def recorded(log: RunLog, crowd: Array) -> None:
        record(log, crowd)
        seen = counts.setdefault(log, [])
        if (now := (log.trips, log.contacts)) != (seen[-1] if seen else (0, 0)):
            seen.append(now)

    monkeypatch.setattr(RunLog, "record_events", recorded)
    two = {n: robot(x, y, 180.0, "west", 8.0) for n, x, y in (("a", 2.0, 0.0), ("b", 4.0, 1.0))}
    run(scenario(tmp_path, REGISTRY, two, PEOPLE), REGISTRY, tmp_path)
    assert sorted(counts.values(), key=len) == [[], [(0, 1)], [(1, 0), (2, 0), (3, 0)]]
