"""A planner in each world of a batch, told the truth: what a policy can imitate."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.api import registry
from crowdbot.core.batch.step_change import write_motion
from crowdbot.core.learning.actions import actions_of
from crowdbot.plugin import Observation, Planner, Pose, Reading, Truth

Array = NDArray[np.float64]


class Teachers:
    """One planner for each world of a `NavVectorEnv`.

    Args:
        env: its worlds.
        kind: of the planner.
        settings: its fields.
        reach: people farther away are not shown, m.
    """

    def __init__(self, env: Any, kind: str, reach: float = 6.0, **settings: Any) -> None:
        self._rollout, (self._actor,) = env.rollout, env.rollout.actors
        known = registry()
        spec = known.components("planner")[kind].spec.model_validate({"kind": kind, **settings})
        self._planners = [known.build(spec, _as_built) for _ in range(env.num_envs)]
        self._reach = reach

    def begin(self, which: NDArray[np.bool_]) -> None:
        """Reset the planners of worlds whose episode has begun."""
        context = self._actor.context
        for w in np.flatnonzero(which).tolist():
            task = self._rollout.world(w).tasks[0]
            self._planners[w].reset(task, context.limits, context.sensors, w)

    def actions(self) -> Array:
        """Return what each would do now, (W, N) from -1 to 1."""
        rollout, limits = self._rollout, self._actor.context.limits
        count = len(self._planners)
        pose, twist = np.empty((2, count, 3))
        write_motion(rollout.rows, 0, pose, twist)
        people, times = rollout.people(), rollout.time
        readings = self._actor.readings(rollout.batches)
        given = np.zeros((count, 3))
        for w, planner in enumerate(self._planners):
            command = planner.step(self._shown(w, pose[w], twist[w], people[w], times[w], readings))
            given[w] = command.v, command.w, command.vy
        return actions_of(given, limits)

    def _shown(
        self, w: int, pose: Array, twist: Array, people: Array, t: float, readings: Any
    ) -> Observation:
        """Return what the planner of a world is shown."""
        away = np.hypot(people[:, 0] - pose[0], people[:, 1] - pose[1])
        near = people[away <= self._reach]  # NaN: absent
        task, here = self._rollout.world(w).tasks[0], Pose(*pose.tolist())
        v, turn, vy = twist.tolist()
        c, s = np.cos(here.yaw), np.sin(here.yaw)
        return Observation(
            t=float(t), pose=here, twist=(v, turn), vy=vy,
            goal=task.goal, goal_zone=task.goal_zone,
            readings={name: Reading(float(t), rows[w]) for name, rows in readings.items()},
            truth=Truth(
                pose=here, velocity=(c * v - s * vy, s * v + c * vy, turn),
                people=np.ascontiguousarray(near[:, :2]),
                people_velocity=np.ascontiguousarray(near[:, 2:4]),
                people_radius=np.ascontiguousarray(near[:, 4]),
                people_id=np.arange(len(near)),
            ),
        )  # fmt: skip


def _as_built(made: Any) -> Planner:
    planner: Planner = made
    return planner
