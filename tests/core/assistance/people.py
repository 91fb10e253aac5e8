"""Scenarios about a person, for tests."""

from __future__ import annotations

from typing import Any

from crowdbot.core.registry.registry import discover
from crowdbot.core.sim.session import Session
from crowdbot.dsl.scenario.scenario import Scenario

REGISTRY = discover(allow=())
LIDAR = {
    "kind": "lidar2d",
    "mount": {"x": 0.245, "z": 0.37},
    "rate": 16.0,
    "angle_min": -2.0,
    "angle_max": 2.0,
    "angle_step": 0.01,
    "range_min": 0.2,
    "range_max": 10.0,
}


def about(goal: dict[str, Any], agents: list[dict[str, Any]], **changes: Any) -> Scenario:
    """Return a scenario of Pepper and some people on an open floor of 16 m by 8 m.

    Args:
        goal: of the robot.
        agents: explicit agents.
        changes: ``start``, ``time_limit``, ``sensors``, ``crowd`` (more of it).
    """
    sensors = {"odometry": {"kind": "holonomic_odometry"}, "lidar": LIDAR}
    document = {
        "id": "about",
        "environment": {
            "kind": "floor",
            "area": {"x": [0.0, 16.0], "y": [-4.0, 4.0]},
            "zones": {
                "floor": {"x": [0.0, 16.0], "y": [-4.0, 4.0]},
                "exit": {"x": [5.0, 8.0], "y": [-2.0, 2.0]},
            },
        },
        "crowd": {
            "agents": agents,
            "speed": {"mean": 0.5, "std": 0.0},
            "body": {"radius": 0.25},
            "policy": {"kind": "velocity_space"},
            "costs": {"avoid": {"kind": "ttca_dca", "weight": 20.0, "range": 5.0}},
            **changes.get("crowd", {}),
        },
        "robots": {
            "robot": {
                "model": {"kind": "pepper"},
                "sensors": changes.get("sensors", sensors),
                "task": {
                    "start": changes.get("start", (1.0, 0.0, 0.0)),
                    "goal": goal,
                    "time_limit": changes.get("time_limit", 20.0),
                },
            }
        },
    }
    return REGISTRY.scenario_model.model_validate(document)


def standing(number: int, x: float, y: float, heading: float, **more: Any) -> dict[str, Any]:
    """Return an agent who stands."""
    return {"id": number, "x": x, "y": y, "goals": [[x, y]], "heading": heading, **more}


def session(scenario: Scenario, **changes: Any) -> Session:
    """Return a session of a scenario."""
    return Session(scenario, registry=REGISTRY, **changes)
