"""Crowd model: a person's decision among the nearest people, kept out of walls."""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Array, ImaginedCrowd, Observation
from crowdbot.plugins.planners.crowd_model.crowd_model import CrowdModelSpec
from crowdbot.plugins.planners.orca.orca_build import half_planes
from crowdbot.plugins.planners.shared.driver_build import VelocityPlanner, velocity_of
from crowdbot.plugins.planners.shared.half_planes_build import best_velocity
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene, people_near

#: People within what they and the robot walk in this time count, s; the nearest 40.
_HORIZON, _PEOPLE = 4.0, 40
#: Time over which the decided acceleration acts, s, and for which no wall is touched, s.
_STEP, _WALLS = 0.25, 1.0
_MOST_LINES = 400
_NOBODY = np.zeros((0, 5))


class CrowdModelPlanner(VelocityPlanner):
    """Planner whose robot is person 0 of a predicted crowd, among the nearest people."""

    def __init__(self, spec: CrowdModelSpec) -> None:
        super().__init__(spec)
        self._spec = spec
        self._crowd: ImaginedCrowd | None = None
        self._lines, self._scratch = np.zeros((_MOST_LINES, 4)), np.zeros((_MOST_LINES, 4))

    def forget(self) -> None:
        """Create the crowd, with the robot's size and speed; compile its kernels."""
        speed = np.full(_PEOPLE + 1, 1.4)
        speed[0] = self._spec.speed * self.limits.v_max
        radius = np.full(_PEOPLE + 1, max(self._spec.person_radius, 0.05))
        radius[0] = self.radius
        self._crowd = ImaginedCrowd(self._spec.crowd, speed, radius)
        self._decided(np.ones((1, 5)), np.zeros(2), np.zeros(2), np.ones(2))
        self._clear_of_walls(np.ones((1, 2)), np.zeros(2), np.zeros(2), (1.0, 0.0))

    def velocity(self, obs: Observation, scene: PlannerScene, wish: Array) -> tuple[float, float]:
        """Return the velocity that a person would choose, m/s."""
        here, own = np.array([scene.pose.x, scene.pose.y]), np.array(velocity_of(scene))
        people = people_near(scene, self.limits.v_max, _HORIZON, _PEOPLE)
        desired = self._decided(people, here, own, wish)
        speed, top = float(np.hypot(*desired)), float(np.hypot(*wish))
        desired *= min(1.0, top / max(speed, 1e-9))
        obs.log("crowd_model/change", float(np.hypot(*(desired - wish))))
        return self._clear_of_walls(scene.points, here, own, (desired[0], desired[1]))

    def _decided(self, people: Array, here: Array, own: Array, wish: Array) -> Array:
        """Return the velocity (2,) of person 0 after one decision, m/s."""
        assert self._crowd is not None
        position, velocity = np.full((_PEOPLE + 1, 2), 1e6), np.zeros((_PEOPLE + 1, 2))
        present = np.arange(_PEOPLE + 1) <= len(people)
        position[0], velocity[0] = here, own
        position[1 : len(people) + 1] = people[:, :2]
        velocity[1 : len(people) + 1] = people[:, 2:4]
        goal = position + velocity + 1e-6
        goal[0] = here + 10.0 * wish / max(float(np.hypot(*wish)), 1e-9)
        pull = self._crowd.accelerations(position, velocity, goal, present)
        return np.asarray(own + _STEP * pull[0])

    def _clear_of_walls(
        self, points: Array, here: Array, own: Array, desired: tuple[float, float]
    ) -> tuple[float, float]:
        """Return the velocity nearest to a wanted one that touches nothing that stands, m/s."""
        hard, count = half_planes(
            points, _NOBODY, (here[0], here[1]), (own[0], own[1]), (_WALLS, _WALLS, 1.0),
            self.radius, self._lines,
        )  # fmt: skip
        top = float(np.hypot(*desired))
        return best_velocity(self._lines, count, hard, top, desired, self._scratch)


build = CrowdModelPlanner
