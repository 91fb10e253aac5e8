from __future__ import annotations

import gc
import pickle
import weakref
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import crowdbot
from crowdbot.core.recording.container.records import Records
from crowdbot.core.recording.header import RecordingHeader, RobotHeader
from crowdbot.core.recording.reading.scans import REPLAY_RATE, Thinning
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.viewers import PEOPLE_RATE
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.replay.page import write_replay
from crowdbot.core.replay.shown_run import ShownRun
from crowdbot.core.runs.provenance import trajectory_hash
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import InputError, UnknownNameError
from tests.core.recording.recording_cases import (
    ANGLES,
    LIDAR,
    LIMITS,
    WALLS,
    ZONE,
    Run,
    bits,
    header_of,
    random_run,
    write_run,
    write_samples,
)
from tests.paths import ROOT

FORMAT_3_HASH = "cb1-sha256:631329dff0e4aa992272ebf4401e8db39c110dcde3377500d4bf29a5c41e5705"


def as_given(run: Run) -> Trajectories:
    """The trajectories that `write_run` ought to leave behind, built without a recording."""
    parts: dict[str, Any] = {"t": run.t, "walls": WALLS, "goal_zone": ZONE}
    if run.robot is not None:
        names = ("robot_x", "robot_y", "robot_theta", "robot_v", "robot_w")
        parts |= dict(zip(names, run.robot.T, strict=True))
        parts |= {"robot_radius": 0.2, "robot_mass": 6.3, "robot_goal_time": 2.25}
        parts |= {"robot_goal": (46.5, 0.0), "robot_goal_radius": 0.5}
        parts["robot_speed_limit"] = LIMITS.v_max
        parts["planner_step_time"] = 0.01 + run.t
        parts["signals"] = {"doubt": np.column_stack((run.t, np.full(len(run.t), -0.0)))}
        parts["contacts"] = {
            "t0": [0.3, 1.0],
            "t1": [0.40625, 1.1],
            "agent": [103, -1],
            "impulse": [1.5, 0.1],
            "peak_force": [20.0, 2.0],
            "relative_speed": [0.7, 0.2],
        }
    if run.agents is not None:
        header = header_of(run).agents
        assert header is not None
        columns = ("agent_x", "agent_y", "agent_vx", "agent_vy")
        parts |= {name: run.agents[:, i] for i, name in enumerate(columns)}
        parts |= {"agent_id": header.id, "agent_radius": header.radius, "agent_mass": header.mass}
        parts["agent_jump"] = None if run.jump is None else run.jump[1:]
        some = run.agents.shape[2] > 0
        parts |= {
            "trip_agent": [100, 103] if some else [],
            "trip_t0": [0.0, 0.5] if some else [],
            "trip_t1": [1.1, 2.0] if some else [],
            "trip_reached": [True, False] if some else [],
        }
    return Trajectories.from_arrays(**parts)


FULL = random_run()
RUNS = {
    "full": FULL,
    "robot alone": Run(FULL.t, FULL.robot, None, None),
    "crowd alone": Run(FULL.t, None, FULL.agents, FULL.jump),
    "jumps unknown": Run(FULL.t, FULL.robot, FULL.agents, None),
    "nobody": random_run(m=0),
    "one sample": random_run(n=1),
}


@pytest.mark.parametrize("record", ["all", "none"])
@pytest.mark.parametrize("run", RUNS.values(), ids=RUNS.keys())
def test_trajectories_come_back_bit_by_bit(run: Run, record: Any, tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    write_run(path, run, record=record)
    assert bits(Recording(path).trajectories()) == bits(as_given(run))
    assert bits(crowdbot.Trajectories.from_mcap(str(path))) == bits(as_given(run))


def test_a_closed_recording_is_freed_without_garbage_collection(tmp_path: Path) -> None:
    write_run(tmp_path / "run.mcap", FULL)
    gc.disable()
    try:
        with Recording(tmp_path / "run.mcap") as recording:
            times = weakref.ref(recording.trajectories().t)
        del recording
        assert times() is None
    finally:
        gc.enable()


FLOATS = st.floats(width=64, allow_nan=True, allow_infinity=True, allow_subnormal=True)


@pytest.mark.slow
@settings(max_examples=40)
@given(data=st.data(), n=st.integers(1, 4), m=st.integers(0, 3))
def test_any_numbers_come_back_bit_by_bit(
    data: st.DataObject, n: int, m: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    robot = data.draw(arrays(np.float64, (n, 5), elements=FLOATS))
    agents = data.draw(arrays(np.float64, (n, 4, m), elements=FLOATS))
    jump = data.draw(arrays(np.bool_, (n, m)))
    run = Run(np.arange(n) / 16.0, robot, agents, jump)
    path = tmp_path_factory.mktemp("any") / "run.mcap"
    writer = RecordingWriter(path, header_of(run), record="none")
    write_samples(writer, run)
    writer.close(None, True, "timeout")
    read = Recording(path).trajectories()
    assert read.robot is not None
    assert read.agents is not None
    assert read.agents.jump is not None
    got = np.column_stack([getattr(read.robot, k) for k in ("x", "y", "theta", "v", "w")])
    assert got.tobytes() == robot.tobytes()
    for i, k in enumerate(("x", "y", "vx", "vy")):
        assert getattr(read.agents, k).tobytes() == agents[:, i].tobytes()
    assert np.array_equal(read.agents.jump, jump[1:])


def test_header_comes_back(tmp_path: Path) -> None:
    footprint = np.arange(12.0).reshape(2, 3, 2)
    robot = RobotHeader(radius=0.1, mass=1.0, footprint=footprint)
    header = header_of(FULL, robot=robot, walls=None)
    path = tmp_path / "run.mcap"
    RecordingWriter(path, header).close(None, False, "interrupted")
    assert bits(Recording(path).info.header) == bits(header)
    assert bits(header_of(FULL)) == bits(RecordingHeader.from_message(header_of(FULL).to_message()))


def test_a_header_of_another_format_is_refused() -> None:
    message = header_of(FULL).to_message()
    message.version = 99
    with pytest.raises(InputError, match="format 99"):
        RecordingHeader.from_message(message)


def test_info_tells_how_the_run_ended(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    write_run(path, FULL)
    info = Recording(path).info
    assert (info.complete, info.status, info.goal_time) == (True, "arrived", 2.25)
    assert info.duration == FULL.t[-1]
    assert info.topics["/front/scan"] == ("sensor_msgs/msg/LaserScan", 40)
    assert info.topics["/odom"] == ("nav_msgs/msg/Odometry", 160)
    write_run(path, FULL, goal_time=None)
    info = Recording(path).info
    assert (info.status, info.goal_time) == ("timeout", None)


def test_equal_runs_give_equal_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_run(tmp_path / name, random_run())
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_record_none_keeps_only_what_scores_need(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    write_run(path, FULL, record="none")
    topics = set(Recording(path).info.topics)
    assert topics == {
        "/contacts",
        "/crowdbot/end",
        "/crowdbot/header",
        "/crowdbot/planner_time",
        "/crowdbot/signal",
        "/crowdbot/state",
        "/crowdbot/trip",
    }


def test_record_used_keeps_what_the_replay_shows_too(tmp_path: Path) -> None:
    write_run(tmp_path / "all", FULL, record="all")
    write_run(tmp_path / "used", FULL, record="used")
    write_run(tmp_path / "none", FULL, record="none")
    topics = {n: set(Recording(tmp_path / n).info.topics) for n in ("all", "used", "none")}
    assert topics["used"] - topics["none"] == {
        "/front/scan", "/odom", "/cmd_vel", "/tf", "/tf_static", "/robot_description",
        "/pedestrians_marker", "/contact_markers", "/walls_marker", "/map", "/goal_zone",
        "/goal_pose",
    }  # fmt: skip
    assert topics["used"] < topics["all"]
    pages = []
    for name in ("all", "used"):
        recording = Recording(tmp_path / name, max_rate=REPLAY_RATE)
        run, scans = recording.trajectories(), recording.scans()
        write_replay(tmp_path / f"{name}.html", ShownRun(run=run, scans=scans, title="run"))
        pages.append((tmp_path / f"{name}.html").read_bytes())
    assert pages[0] == pages[1]


def test_record_used_says_what_all_says_less_often(tmp_path: Path) -> None:
    """But for scans, whose distances are rounded."""
    messages: dict[str, dict[str, list[tuple[int, bytes]]]] = {"all": {}, "used": {}}
    for record, found in messages.items():
        write_run(tmp_path / record, FULL, record=record)  # type: ignore[arg-type]
        for message in Records(tmp_path / record):
            found.setdefault(message.topic, []).append((message.ns, message.data))
    for topic in messages["used"].keys() - {"/front/scan"}:
        assert set(messages["used"][topic]) <= set(messages["all"][topic]), topic
    for topic, rate in (("/tf", REPLAY_RATE), ("/pedestrians_marker", PEOPLE_RATE)):
        stamps = [ns for ns, _ in messages["used"][topic]]
        assert len(stamps) < len(messages["all"][topic])
        assert min(b - a for a, b in pairwise(stamps)) >= 1e9 / rate


@given(stamps=st.lists(st.integers(0, 10**10)), rate=st.sampled_from([None, 0.3, 8.0, 15.0]))
def test_thinning_twice_is_thinning_once(stamps: list[int], rate: float | None) -> None:
    once, again = Thinning(rate), Thinning(rate)
    kept = [ns for ns in sorted(stamps) if once.keeps(ns)]
    assert [ns for ns in kept if again.keeps(ns)] == kept
    assert len(kept) == len(stamps) if rate is None else set(kept) <= set(stamps)


def test_recordings_of_format_3_are_read() -> None:
    """Written by the release before choices of people were recorded; people alone, packed."""
    path = ROOT / "tests" / "data" / "recordings" / "format_3.mcap"
    assert trajectory_hash(Recording(path).trajectories()) == FORMAT_3_HASH
    assert Recording(path).info.complete


def test_scans_come_back_and_can_be_thinned(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    write_run(path, FULL)
    (scan,) = Recording(path).scans()
    assert (scan.sensor, scan.mount, scan.range_max) == ("front", LIDAR.mount, 10.0)
    assert np.array_equal(scan.angles, ANGLES)
    assert np.array_equal(scan.t, FULL.t)
    expected = np.where(ANGLES > 0.0, 1.0 + FULL.t[:, None], np.inf).astype(np.float32)
    assert np.array_equal(scan.ranges, expected)
    (thin,) = Recording(path, max_rate=4.0).scans("front")
    assert np.array_equal(thin.t, FULL.t[::4])
    with pytest.raises(UnknownNameError, match="front"):
        Recording(path).scans("frnt")


def test_a_folder_that_does_not_exist_is_an_input_error(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be written"):
        RecordingWriter(tmp_path / "no" / "run.mcap", header_of(FULL))


def test_closing_twice_changes_nothing(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    writer = RecordingWriter(path, header_of(FULL))
    write_samples(writer, FULL)
    writer.close(None, True, "timeout")
    before = path.read_bytes()
    writer.close(1.0, True, "arrived")
    assert path.read_bytes() == before


def test_another_process_reads_the_file_itself(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    write_run(path, random_run())
    with Recording(path, max_rate=5.0) as given:
        assert given.info.complete
        found = pickle.loads(pickle.dumps(given))  # noqa: S301
        assert found.info.duration == given.info.duration
        assert bits(found.trajectories()) == bits(given.trajectories())
