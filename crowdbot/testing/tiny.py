"""Tiny scenarios (one room, one robot, no people), and short runs of them."""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.testing.around import with_zone

#: Start of the robot in the room, and its goal zone, m.
START = (1.0, 0.0, 0.0)
ROOM: Mapping[str, Any] = {
    "kind": "corridor",
    "length": 12.0,
    "width": 6.0,
    "zones": {"goal": {"x": [10.0, 12.0], "y": [-3.0, 3.0]}},
}


def tiny_scenario(registry: Registry, **changes: Any) -> Scenario:
    """Return a scenario of a robot that has to cross a room of 12 m x 6 m, without people.

    Args:
        registry: the installed components.
        changes: ``environment``, ``robot`` (the model), ``sensors``, ``control``, ``start``,
            ``zone``, ``time_limit``, ``crowd`` or ``rates`` as in a document.
    """
    control = {"control": changes["control"]} if "control" in changes else {}
    robot = {
        **control,
        "model": changes.get("robot", {"kind": "turtlebot2"}),
        "sensors": changes.get("sensors", {"odometry": {"kind": "wheel_odometry"}}),
        "task": {
            "start": changes.get("start", START),
            "goal": {"zone": changes.get("zone", "goal")},
            "time_limit": changes.get("time_limit", 1.0),
        },
    }
    document = {
        "id": "tiny",
        "environment": changes.get("environment", ROOM),
        "crowd": changes.get("crowd"),
        "rates": changes.get("rates", {}),
        "robots": {"robot": robot},
    }
    return registry.scenario_model.model_validate(document)


def scenario_in(registry: Registry, spec: ComponentSpec, at: tuple[float, float]) -> Scenario:
    """Return a scenario whose robot starts at a point, with a goal zone behind it."""
    words = with_zone(registry, spec, at).model_dump(mode="json")
    return tiny_scenario(registry, environment=words, start=(*at, 0.0), zone="kit")


def run_of(scenario: Scenario, registry: Registry, planner: str = "goal_seek") -> Trajectories:
    """Simulate without references; Drake's warnings are errors.

    Raises:
        UserWarning: the simulator issued a warning.
    """
    from crowdbot.core.sim.simulate import simulate

    with tempfile.TemporaryDirectory(prefix="crowdbot-kit-") as folder, warnings.catch_warnings():
        warnings.simplefilter("error")
        run = simulate(
            scenario,
            registry,
            planner=planner,
            out=Path(folder),
            options=RunOptions(references=False, metrics=()),
        )
        assert not run.failed, run.record.reason
        return run.trajectories


def assert_runs(scenario: Scenario, registry: Registry) -> None:
    """Simulate twice and check that the robot's state is finite and equal."""
    one, two = (run_of(scenario, registry).robot for _ in range(2))
    assert one is not None
    assert two is not None
    for name in ("x", "y", "theta", "v", "w"):
        a, b = getattr(one, name), getattr(two, name)
        assert np.all(np.isfinite(a)), f"{name} of the robot is not finite"
        assert np.array_equal(a, b), f"{name} of the robot differs between two runs"
