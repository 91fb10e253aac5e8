"""navground: passes the scene to a behaviour of the library, and drives its command."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from crowdbot.plugin import (
    Array,
    Command,
    InputError,
    Observation,
    RobotLimits,
    did_you_mean,
    nearest,
)
from crowdbot.plugins.planners.navground.navground import NavgroundSpec
from crowdbot.plugins.planners.shared.driver_build import VelocityPlanner, velocity_of
from crowdbot.plugins.planners.shared.optional_build import library
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene, in_base

#: Radius of a lidar point, m; time step that the library is told, s.
_POINT, _STEP = 0.03, 1.0 / 16.0
#: Yaw rate per angle to the goal of robots that go sideways, 1/s.
_GAIN = 2.5


class Navground(VelocityPlanner):
    """Planner that calls the library's behaviour; remembers only its last command."""

    def __init__(self, spec: NavgroundSpec, core: Any) -> None:
        super().__init__(spec)
        self._spec, self._core = spec, core
        self._behavior = made(core, spec)

    def forget(self) -> None:
        """Create the behaviour for the robot."""
        self._behavior = made(self._core, self._spec)
        self._behavior.kinematics = _kinematics(self._core, self.limits)
        self._behavior.radius = self.radius

    def pursue(self, obs: Observation, scene: PlannerScene, wish: Array, error: float) -> Command:
        """Return the command of the behaviour, within the robot's limits."""
        limits = self.limits
        chosen = self.velocity(obs, scene, wish)
        obs.log("navground/change", math.hypot(chosen[0] - wish[0], chosen[1] - wish[1]))
        obs.draw("velocity", lambda: in_base(scene.pose, _arrow(scene, chosen)))
        twist = self._behavior.actuated_twist
        v, vy = np.asarray(twist.velocity, dtype=np.float64).tolist()
        # Behaviours of the library leave the heading of robots that go sideways alone.
        w = _GAIN * error if limits.vy_max > 0.0 else twist.angular_speed
        return Command(
            min(max(v, limits.v_min), limits.v_max),
            min(max(w, -limits.w_max), limits.w_max),
            min(max(vy, -limits.vy_max), limits.vy_max),
        )

    def velocity(self, obs: Observation, scene: PlannerScene, wish: Array) -> tuple[float, float]:
        """Return the velocity that the behaviour wants, m/s."""
        del obs
        behavior, core = self._behavior, self._core
        show(core, behavior, scene, self._spec.view)
        speed = float(np.hypot(*wish))
        behavior.optimal_speed = speed
        behavior.target = core.Target(direction=tuple(wish / max(speed, 1e-9)), speed=speed)
        behavior.actuated_twist = behavior.compute_cmd(_STEP, core.Frame.relative)
        u, v = behavior.desired_velocity.tolist()
        return u, v


def _arrow(scene: PlannerScene, chosen: tuple[float, float]) -> Array:
    here = np.array([scene.pose.x, scene.pose.y])
    return np.array([here, here + chosen])


def made(core: Any, spec: NavgroundSpec) -> Any:
    """Return a behaviour with its settings.

    Raises:
        InputError: the behaviour has no such property.
    """
    behavior = core.Behavior.make_type(spec.behavior)
    behavior.horizon, behavior.safety_margin = spec.view, spec.safety_margin
    _set(behavior, spec.behavior, spec.settings)
    if spec.behavior == "ORCA" and "time_horizon" not in spec.settings:
        behavior.time_horizon = spec.time_horizon
    return behavior


def _set(behavior: Any, name: str, settings: Mapping[str, bool | int | float]) -> None:
    known = sorted(behavior.properties)
    for key, value in settings.items():
        if key not in known:
            near = did_you_mean(nearest(key, known))
            raise InputError(f"unknown property of navground's {name}: '{key}'{near}")
        behavior.set(key, value)


def show(core: Any, behavior: Any, scene: PlannerScene, view: float) -> None:
    """Pass the robot's state, people and static obstacles to a behaviour.

    Args:
        core: the library.
        behavior: of the library.
        scene: the surroundings.
        view: people and points farther than this are left out, m.
    """
    pose, (_, w, _) = scene.pose, scene.twist
    behavior.position, behavior.orientation = (pose.x, pose.y), pose.yaw
    behavior.velocity, behavior.angular_speed = velocity_of(scene), w
    state = behavior.environment_state
    if state is None:  # Dummy looks at nothing
        return
    state.neighbors = [
        core.Neighbor((x, y), r, (vx, vy), number)
        for number, (x, y, vx, vy, r) in enumerate(_within(scene, scene.people, view), 1)
    ]
    state.static_obstacles = [
        core.Disc((x, y), _POINT) for x, y in _within(scene, scene.points, view)
    ]


def _within(scene: PlannerScene, rows: Array, view: float) -> Sequence[Sequence[float]]:
    away = np.hypot(rows[:, 0] - scene.pose.x, rows[:, 1] - scene.pose.y)
    found: Sequence[Sequence[float]] = rows[away < view].tolist()
    return found


def _kinematics(core: Any, limits: RobotLimits) -> Any:
    """Return what the library knows of the drive: any direction, or ahead and turns."""
    if limits.vy_max > 0.0:
        return core.kinematics.OmnidirectionalKinematics(
            min(limits.v_max, limits.vy_max), limits.w_max
        )
    return core.kinematics.AheadKinematics(limits.v_max, limits.w_max)


def build(spec: NavgroundSpec) -> Navground:
    """Build a planner from its spec.

    Raises:
        PluginError: navground is not installed.
        InputError: the behaviour has no such property.
    """
    return Navground(spec, library("navground", "navground.core", "navground"))
