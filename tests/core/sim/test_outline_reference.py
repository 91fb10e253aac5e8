"""Each robot's outline against a person: head-on, glancing and from the rear, and the equations.

The reference is integrated by scipy with geometry of its own. Impulses agree within 1 % at 1/256 s,
as those of a disc do (tests/core/sim/test_contact_reference.py); what one gains the other loses to
rounding.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact.robot_contact import ROBOT, robot_contact
from crowdbot.core.crowd.traits import TRAITS
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.registry.registry import discover
from crowdbot.core.robots.build import build_model
from crowdbot.core.sim.build_crowd import in_series
from crowdbot.core.support.records import rows_in, rows_of
from crowdbot.core.types.robot import RobotModel

Array = NDArray[np.float64]
ROBOTS = ("turtlebot2", "pepper", "qolo", "cuybot", "smart_wheelchair")
#: Where the person comes from, seen by the robot, and how far beside the middle, as a share of the
#: half width.
MEETINGS = {"head-on": (0.0, 0.0), "glancing": (0.5, 0.6), "rear": (math.pi, 0.2)}
PERSON, MASS, DISSIPATION, DT = 0.33, 75.0, 0.3, 1.0 / 256.0
YAW, SPEED = 0.7, 1.2


@cache
def model_of(kind: str) -> RobotModel:
    registry = discover(allow=())
    return build_model(registry, registry.find("robot", kind).spec(kind=kind))


class Case:
    """A free rigid robot that drives at 0.3 m/s and turns, and a person who walks into it."""

    def __init__(self, kind: str, meeting: str) -> None:
        self.model = model_of(kind)
        self.body = footprint_of_model(self.model)
        self.stiffness = in_series(30000.0, self.model.skin_stiffness)
        self.inertia = self.model.mass * self.body.reach**2 / 3.0
        corners = self.body.outline(0.0, 0.0, 0.0)
        half = self.body.radius if not len(corners) else float(corners[:, 1].max())
        side, share = MEETINGS[meeting]
        bearing = YAW + side
        c, sn = math.cos(bearing), math.sin(bearing)
        far, across = self.body.reach + PERSON + 0.05, share * half
        self.robot = np.array([0.0, 0.0, 0.3 * math.cos(YAW), 0.3 * math.sin(YAW), YAW, 0.2])
        self.person = np.array(
            [far * c - across * sn, far * sn + across * c, -SPEED * c, -SPEED * sn]
        )

    def simulated(self) -> tuple[float, Array, Array, float]:
        """Impulse, the robot's velocities and the person's after they have parted, and when."""
        x, y, vx, vy, yaw, w = self.robot.tolist()
        robot = np.array([x, y, vx, vy, self.body.radius, 0.0, yaw, w])
        agents, reaction = np.zeros((1, s.AGENT_COLUMNS)), np.zeros((1, 2))
        agents[0, : s.VY + 1] = self.person
        felt, touches = np.zeros(s.FELT_SIZE), np.zeros((1, s.TOUCH_COLUMNS))
        traits, impulse, touched = rows_of(1, TRAITS), 0.0, False
        traits["radius"][:] = PERSON
        for tick in range(2000):
            reaction[:] = 0.0
            robot_contact(
                rows_in(felt, s.FELT)[0], rows_in(touches, s.TOUCH), rows_in(agents, s.PERSON),
                traits, rows_in(robot, ROBOT)[0], self.body.corners, self.stiffness,
                DISSIPATION, tick * DT, DT, reaction,
            )  # fmt: skip
            force = felt[s.ROBOT_FX : s.ROBOT_FY + 1]
            size = float(np.hypot(*force))
            if touched and size == 0.0:
                break
            touched, impulse = touched or size > 0.0, impulse + size * DT
            robot[2:4] += force / self.model.mass * DT
            robot[7] += felt[s.ROBOT_TORQUE] / self.inertia * DT
            agents[0, s.VX : s.VY + 1] += reaction[0] / MASS * DT
            robot[:2] += robot[2:4] * DT
            robot[6] += robot[7] * DT
            agents[0, : s.Y + 1] += agents[0, s.VX : s.VY + 1] * DT
        ended = np.array([*robot[2:4], robot[7]]), agents[0, s.VX : s.VY + 1].copy()
        return impulse, *ended, tick * DT

    def expected(self, until: float) -> tuple[float, Array, Array]:
        """The same by the equations of motion: x, y, yaw, vx, vy, w; px, py, ux, uy; impulse."""

        def law(q: Array) -> tuple[float, Array, Array]:
            """Force, the normal towards the robot, the arm from its middle to the person."""
            c, sn = math.cos(q[2]), math.sin(q[2])
            turn = np.array([[c, -sn], [sn, c]])
            arm = q[6:8] - q[:2]
            away, rim = self._away(turn.T @ arm)
            distance = float(np.hypot(*away))
            normal = -turn @ away / distance
            depth = PERSON + rim - distance
            moving = q[3:5] + q[5] * np.array([-arm[1], arm[0]])
            closing = -float((moving - q[8:10]) @ normal)
            force = max(0.0, self.stiffness * depth * (1.0 + DISSIPATION * closing))
            return (force if depth > 0.0 else 0.0), normal, arm

        def rate(_: float, q: Array) -> Array:
            force, n, arm = law(q)
            torque = force * (arm[0] * n[1] - arm[1] * n[0])
            return np.array([
                *q[3:6], *(force * n / self.model.mass), torque / self.inertia,
                *q[8:10], *(-force * n / MASS), force,
            ])  # fmt: skip

        x, y, vx, vy, yaw, w = self.robot.tolist()
        start = np.array([x, y, yaw, vx, vy, w, *self.person, 0.0])
        done = solve_ivp(rate, (0.0, until), start, max_step=1e-3, rtol=1e-7, atol=1e-9)
        end = done.y[:, -1]
        assert law(end)[0] == 0.0
        return float(end[10]), end[3:6], end[8:10]

    def _away(self, p: Array) -> tuple[Array, float]:
        """From the nearest point of the outline's core to a point outside; how thick the rim is."""
        corners = self.body.corners
        if not len(corners):
            return p, self.body.radius
        ends = np.roll(corners, -1, axis=0)
        along = ends - corners
        share = np.clip(((p - corners) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
        ways = p - (corners + share[:, None] * along)
        rim = self.body.radius if len(corners) == 2 else 0.0
        return ways[np.argmin(np.hypot(*ways.T))], rim


@pytest.mark.parametrize("meeting", MEETINGS)
@pytest.mark.parametrize("kind", ROBOTS)
def test_impulse_and_velocities_are_those_of_the_equations(kind: str, meeting: str) -> None:
    case = Case(kind, meeting)
    impulse, robot_v, person_v, parted = case.simulated()
    wanted, wanted_robot, wanted_person = case.expected(parted + 0.02)
    assert wanted > 1.0
    assert impulse == pytest.approx(wanted, rel=0.01)
    assert robot_v == pytest.approx(wanted_robot, abs=0.03)
    assert person_v == pytest.approx(wanted_person, abs=0.02)
    gained = case.model.mass * (robot_v[:2] - case.robot[2:4])
    assert gained == pytest.approx(-MASS * (person_v - case.person[2:]), abs=1e-9)
