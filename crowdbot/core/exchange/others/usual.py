"""Default policies for imported scenes that name no pedestrian model."""

from __future__ import annotations

from crowdbot.core.exchange.scene import Data


def social_forces() -> Data:
    """Return the policy that replaces social force models."""
    return {
        "policy": {"kind": "velocity_space", "method": "gradient", "relaxation_time": 0.5},
        "costs": {
            "away": {"kind": "social_forces_avoidance",
                     "range": {"value": 6.0, "measure": "centre"}},
            "drive": {"kind": "goal_reaching_force"},
        },
    }  # fmt: skip


def vision() -> Data:
    """Return the policy that replaces models without a counterpart in crowdbot."""
    return {
        "policy": {"kind": "velocity_space"},
        "costs": {
            "mid_term": {"kind": "ttca_dca", "weight": 20.0, "range": 5.0},
            "reflex": {"kind": "rvo", "range": {"value": 0.3, "measure": "surface"}},
        },
    }


def standing_robot(zone: str, start: tuple[float, float, float]) -> Data:
    """Return a TurtleBot2 with two lidars and odometry, that drives to a zone."""
    lidar = {"kind": "lidar2d", "rate": 16.0, "angle_min": -3.14159, "angle_max": 3.14159,
             "angle_step": 0.0174533, "range_min": 0.2, "range_max": 10.0,
             "mount": {"z": 0.3}}  # fmt: skip
    return {
        "model": {"kind": "turtlebot2"},
        "sensors": {"lidar": lidar, "odometry": {"kind": "wheel_odometry", "rate": 64.0}},
        "task": {"start": list(start), "goal": {"zone": zone}},
    }
