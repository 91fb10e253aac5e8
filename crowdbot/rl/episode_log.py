"""EpisodeLog: samples of one episode of the first world, as trajectories."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact.robot_contact import R_W, R_YAW, RVX, RVY
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.ending import Ending
from crowdbot.rl.rollout import Rollout

_PERSON = [s.X, s.Y, s.VX, s.VY, s.JUMPS]
#: Columns of a finished contact, by the argument of `Trajectories.from_arrays`.
_TOUCH = {
    "t0": s.TOUCH_START,
    "t1": s.TOUCH_END,
    "impulse": s.TOUCH_IMPULSE,
    "peak_force": s.TOUCH_PEAK,
    "relative_speed": s.TOUCH_SPEED,
    "bearing": s.TOUCH_SIDE,
}


class EpisodeLog:
    """The samples of an episode, one for each step.

    Args:
        rollout: its first world has just begun the episode.

    Attributes:
        goal_time: when the robot entered its goal zone, s; None while it has not.
    """

    def __init__(self, rollout: Rollout) -> None:
        self._world = rollout.world(0)
        self._t: list[float] = []
        self._robot: list[Array] = []
        self._people: list[Array] = []
        self._contacts: list[dict[str, float]] = []
        self._touches = np.zeros(self._world.people)
        self.goal_time: float | None = None
        self._sample(rollout)

    def add(self, rollout: Rollout) -> None:
        """Add the sample after a step."""
        entered = float(rollout.batches.drive("arrived")[0, 0])
        if self.goal_time is None and entered >= 0.0:
            self.goal_time = self._t[-1] + entered
        self._sample(rollout)
        self._end_contacts()

    def ending(self) -> str:
        """Return the ending of the episode, or that it is running."""
        if self.goal_time is not None:
            return Ending.ARRIVED
        late = self._t[-1] >= self._world.tasks[0].time_limit
        return Ending.TIMEOUT if late else Ending.INTERRUPTED

    def trajectories(self) -> Trajectories:
        """Return the episode so far."""
        plan, task = self._world.blueprint, self._world.tasks[0]
        model, rows = plan.models[0], np.array(self._robot)
        x, y, yaw, vx, vy, w = rows.T
        low = plan.parts.wall_heights[:, 0] < model.height
        fastest = math.hypot(model.limits.v_max, model.limits.vy_max)
        return Trajectories.from_arrays(
            t=self._t,
            robot_x=x,
            robot_y=y,
            robot_theta=yaw,
            robot_v=vx * np.cos(yaw) + vy * np.sin(yaw),
            robot_w=w,
            **({"robot_vx": vx, "robot_vy": vy} if model.limits.vy_max > 0.0 else {}),
            robot_radius=model.footprint_radius,
            robot_mass=model.mass,
            robot_goal_time=self.goal_time,
            robot_goal=task.goal,
            robot_speed_limit=fastest if fastest > 0.0 else None,
            robot_footprint=model.footprint,
            goal_zone=task.goal_zone,
            walls=plan.parts.walls[low],
            contacts=self._all_contacts(),
            **self._tracks(),
        )

    def _sample(self, rollout: Rollout) -> None:
        self._t.append(float(rollout.time[0]))
        self._robot.append(rollout.rows[0, 0, [0, 1, R_YAW, RVX, RVY, R_W]].copy())
        rows = self._world.rows()
        sample = rows[:, _PERSON].copy()
        sample[rows[:, s.WAITING] != s.PRESENT, :4] = np.nan
        self._people.append(sample)

    def _end_contacts(self) -> None:
        """Store contacts that ended since the last step; of each person only the last one."""
        _, touches = s.contact_with(self._world.flat)
        for i in np.flatnonzero(touches[:, s.TOUCHES] != self._touches).tolist():
            self._contacts.append(self._contact(touches, i))
        self._touches = touches[:, s.TOUCHES].copy()

    def _contact(self, touches: Array, i: int) -> dict[str, float]:
        found = {name: float(touches[i, column]) for name, column in _TOUCH.items()}
        engine = self._world.engine
        return {**found, "agent": float(engine.agents.id[i]) if engine else -1.0}

    def _all_contacts(self) -> dict[str, list[float]]:
        """Return column -> values of the episode's contacts; ongoing ones end at present."""
        _, touches = s.contact_with(self._world.flat)
        going_on = np.flatnonzero(touches[:, s.TOUCHING] != 0.0).tolist()
        rows = [*self._contacts, *(self._contact(touches, i) for i in going_on)]
        return {name: [row[name] for row in rows] for name in (*_TOUCH, "agent")}

    def _tracks(self) -> Mapping[str, Any]:
        engine = self._world.engine
        if engine is None:
            return {}
        people, agents = np.array(self._people), engine.agents
        jumps = np.diff(people[:, :, 4], axis=0) != 0.0
        names = ("agent_x", "agent_y", "agent_vx", "agent_vy")
        return {
            **{name: people[:, :, k] for k, name in enumerate(names)},
            "agent_id": agents.id,
            "agent_radius": agents.radius,
            "agent_mass": agents.mass,
            "agent_jump": jumps if jumps.any() else None,
        }
