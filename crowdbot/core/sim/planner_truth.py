"""The ground truth that a privileged planner gets."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd import state as crowd_state
from crowdbot.core.crowd.response.notice import notice_time
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.planning.planner import Truth
from crowdbot.core.sim.crowd_system import CrowdSystem
from crowdbot.core.sim.foresight import Foresight
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotModel, RobotState


@dataclass(frozen=True, slots=True)
class TruthSource:
    """All people who may be met, with number and radius, including those not present yet.

    Attributes:
        notice: (N,) time to contact from which they respond to a robot that moves, s.
        robots: (R,) how far the other robots reach, m; they stand among the people,
            numbered -2, -3, ….
        foresight: predicts them; None: not available.
    """

    id: NDArray[np.int64]
    radius: Array
    notice: Array = field(default_factory=lambda: np.zeros(0))
    robots: Array = field(default_factory=lambda: np.zeros(0))
    foresight: Foresight | None = None

    def truth(
        self, robot: RobotState, crowd: Array, others: Sequence[RobotState | None] = ()
    ) -> Truth:
        """Return the ground truth: the robot and all people present.

        Args:
            crowd: the flat state of the crowd, or empty.
            others: states of the other robots; None for one that has left.
        """
        rows = np.zeros((0, 4))
        there = np.zeros(len(self.id), dtype=bool)
        if len(self.id):
            _, people = crowd_state.view(crowd)
            there = people[:, crowd_state.WAITING] == crowd_state.PRESENT
            rows = people[there, crowd_state.X : crowd_state.VY + 1]
        radius, ids, notice = self.radius[there], self.id[there], self.notice[there]
        here = [k for k, other in enumerate(others) if other is not None]
        if here:
            met = [(o.x, o.y, o.vx, o.vy) for o in others if o is not None]
            rows = np.concatenate([rows, np.array(met)])
            radius = np.concatenate([radius, self.robots[here]])
            ids = np.concatenate([ids, -2 - np.array(here, np.int64)])
            notice = np.concatenate([notice, np.zeros(len(here))])
        return Truth(
            pose=Pose(robot.x, robot.y, robot.yaw),
            velocity=(robot.vx, robot.vy, robot.w),
            people=rows[:, :2],
            people_velocity=rows[:, 2:],
            people_radius=radius,
            people_id=ids,
            people_notice=notice,
            foresee=self._foresee(crowd, there),
        )

    def _foresee(
        self, crowd: Array, there: NDArray[np.bool_]
    ) -> Callable[[int, float, Array | None], Array] | None:
        """Return the predictor of the people who are present, starting from a crowd state."""
        seer = self.foresight
        if seer is None:
            return None

        def foresee(steps: int, step: float, path: Array | None = None) -> Array:
            return seer.places(crowd, steps, step, path)[:, there]

        return foresee


def truth_source(crowd: CrowdSystem | None, others: Sequence[RobotModel]) -> TruthSource:
    """Return the source of the truth about people and other robots, if there are any."""
    reach = np.array([footprint_of_model(model).reach for model in others])
    if crowd is None:
        return TruthSource(np.zeros(0, np.int64), np.zeros(0), np.zeros(0), reach)
    agents = crowd.engine.agents
    notice = notice_time(agents, crowd.engine.world.response)
    return TruthSource(agents.id, agents.radius, notice, reach, crowd.foresight)
