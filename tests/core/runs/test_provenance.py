from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.runs import provenance
from crowdbot.core.support.json_digest import digest
from crowdbot.core.trajectories.trajectories import Trajectories

BASE: dict[str, Any] = {
    "t": [0.0, 0.1, 0.2],
    "robot_x": [0.0, 0.1, 0.2], "robot_y": [0.0] * 3, "robot_theta": [0.0] * 3,
    "robot_v": [1.0] * 3, "robot_w": [0.0] * 3, "robot_radius": 0.2, "robot_mass": 6.0,
    "robot_goal_time": None, "robot_goal": (1.0, 0.0), "robot_goal_radius": 0.5,
    "agent_id": [0, 1], "agent_x": np.zeros((3, 2)), "agent_y": np.ones((3, 2)),
    "agent_vx": np.zeros((3, 2)), "agent_vy": np.zeros((3, 2)), "agent_radius": 0.3,
    "agent_mass": 75.0, "agent_jump": np.zeros((2, 2), bool),
    "trip_agent": [0], "trip_t0": [0.0], "trip_t1": [0.2], "trip_reached": [False],
    "contacts": {"t0": [0.1], "t1": [0.15], "agent": [0], "impulse": [1.0], "peak_force": [5.0],
                 "relative_speed": [0.3]},
    "signals": {"gap": [[0.0, 1.0], [0.1, 2.0]]},
}  # fmt: skip


def _hash(**changes: Any) -> str:
    return provenance.trajectory_hash(Trajectories.from_arrays(**{**BASE, **changes}))


def test_equal_runs_have_equal_hashes() -> None:
    assert _hash() == _hash()
    assert _hash().startswith("cb1-sha256:")
    assert len(_hash()) == len("cb1-sha256:") + 64
    assert _hash(planner_step_time=[0.1, 0.2]) == _hash()  # wall time is not a result


@pytest.mark.parametrize(
    "change",
    [
        {"t": [0.0, 0.1, 0.2 + 1e-16 * 2]},
        {"robot_x": [0.0, 0.1, np.nextafter(0.2, 1.0)]},
        {"robot_y": [0.0, 0.0, -0.0]},
        {"robot_goal_time": 0.2},
        {"robot_radius": 0.3},
        {"agent_x": np.full((3, 2), 1e-300)},
        {"agent_vx": np.array([[0, 0], [0, 0], [0, np.nan]])},
        {"agent_id": [1, 0]},
        {"agent_jump": np.array([[False, True], [False, False]])},
        {"trip_reached": [True]},
        {"trip_t1": [0.19]},
        {"contacts": None},
        {"signals": {"gap": [[0.0, 1.0], [0.1, 2.5]]}},
        {"signals": {"gaps": [[0.0, 1.0], [0.1, 2.0]]}},
    ],
)
def test_every_bit_counts(change: dict[str, Any]) -> None:
    assert _hash(**change) != _hash()


def test_digest_does_not_depend_on_order() -> None:
    one = digest({"a": 1, "b": {"c": [1, 2], "d": "é"}})
    assert one == digest({"b": {"d": "é", "c": [1, 2]}, "a": 1})
    assert one != digest({"a": 1, "b": {"c": [2, 1], "d": "é"}})


def test_golden_digest() -> None:
    """`cb1` never changes its meaning."""
    assert digest({"b": [1.5, None, True], "a": "é"}) == GOLDEN


def test_versions_and_plugins() -> None:
    versions = provenance.versions()
    assert {"python", "crowdbot", "drake", "numpy", "numba"} <= set(versions)
    assert all(versions.values())
    (builtin,) = provenance.plugins(discover(entry_points=False))
    assert builtin["name"] == "builtin"
    assert builtin["pinned"] is True
    machine = provenance.machine()
    assert set(machine) == {"system", "machine", "processor", "rounding"}
    assert all(machine.values())


GOLDEN = "cb1-sha256:5c0f553610a1d665c1647faca2482c1e5b466e03e91cb37c5470dca4a4ecb9a4"


def test_a_plugin_is_the_same_however_its_path_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A campaign's workers get absolute paths; what they make must be what was planned."""
    (tmp_path / "here").mkdir()
    (tmp_path / "loose.py").write_text(
        "from crowdbot.plugin import hookimpl\n\n\n@hookimpl\ndef crowdbot_components():\n"
        "    return {}\n"
    )
    monkeypatch.chdir(tmp_path / "here")
    entries = [
        provenance.plugins(discover(extra=[path], entry_points=False))
        for path in (Path("../loose.py"), tmp_path / "loose.py")
    ]
    assert entries[0] == entries[1]
    (mine,) = [p for p in entries[0] if p["name"] == "loose"]
    assert mine["distribution"] == "loose.py"
