"""Robots that are not discs: capsules and polygons touch people and walls with their outline."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact.robot_contact import ROBOT, from_outline, robot_contact
from crowdbot.core.crowd.traits import TRAITS
from crowdbot.core.geometry.footprint import Footprint, body_side
from crowdbot.core.sim.contacts.outline_gap import is_clear, outline_gap, touched_at
from crowdbot.core.support.records import rows_in, rows_of
from tests.core.sim.sim_worlds import Array, Drive, alone, constant, person, rig, scenario

pytestmark = pytest.mark.slow

BOX = np.array([[0.25, -0.3], [0.25, 0.3], [-0.35, 0.3], [-0.35, -0.3]])
WEDGE = np.array([[-0.2, -0.25], [0.4, 0.0], [-0.2, 0.25]])
AXIS = np.array([[-0.3, 0.0], [0.2, 0.0]])
OUTLINES = {"box": (BOX, 0.0), "wedge": (WEDGE, 0.0), "capsule": (AXIS, 0.18)}
SHAPES = st.sampled_from(list(OUTLINES))
PLACE = st.floats(-1.2, 1.2)
NO_PILLARS = np.zeros((0, 3))


@given(shape=SHAPES, x=PLACE, y=PLACE)
def test_the_nearest_point_of_an_outline(shape: str, x: float, y: float) -> None:
    """Distance as the metrics have it; the point lies on the outline, that far along the normal."""
    corners, _ = OUTLINES[shape]
    distance, ux, uy, qx, qy = from_outline(corners, x, y)
    assert distance == pytest.approx(Footprint(corners, 0.0).gap(np.array(x), np.array(y)))
    assert math.hypot(ux, uy) == pytest.approx(1.0)
    assert (qx + distance * ux, qy + distance * uy) == pytest.approx((x, y), abs=1e-9)
    assert Footprint(corners, 0.0).gap(np.array(qx), np.array(qy)) == pytest.approx(0.0, abs=1e-9)


class Bump:
    """A free rigid robot and a person under the contact kernel alone."""

    mass, inertia, person = 20.0, 0.9, 75.0

    def __init__(self, shape: str, yaw: float, w: float, at: tuple[float, float], v: Array) -> None:
        self.outline, radius = OUTLINES[shape]
        self.robot = np.array([0.4, -0.2, *v[:2], radius, 0.0, yaw, w])
        self.agents = np.zeros((1, s.AGENT_COLUMNS))
        self.agents[0, : s.VY + 1] = 0.4 + at[0], -0.2 + at[1], *v[2:]
        self.felt, self.touches = np.zeros(s.FELT_SIZE), np.zeros((1, s.TOUCH_COLUMNS))
        self.reaction = np.zeros((1, 2))
        self.tick, self.dt = 0, 1.0 / 128.0
        self.traits = rows_of(1, TRAITS)
        self.traits["radius"][:] = 0.33

    def step(self) -> float:
        self.reaction[:] = 0.0
        robot_contact(
            rows_in(self.felt, s.FELT)[0], rows_in(self.touches, s.TOUCH),
            rows_in(self.agents, s.PERSON), self.traits, rows_in(self.robot, ROBOT)[0],
            self.outline, 30000.0, 0.3, self.tick * self.dt, self.dt, self.reaction,
        )  # fmt: skip
        force = self.felt[s.ROBOT_FX : s.ROBOT_FY + 1]
        self.robot[2:4] += force / self.mass * self.dt
        self.robot[7] += self.felt[s.ROBOT_TORQUE] / self.inertia * self.dt
        self.agents[0, s.VX : s.VY + 1] += self.reaction[0] / self.person * self.dt
        self.robot[:2] += self.robot[2:4] * self.dt
        self.robot[6] += self.robot[7] * self.dt
        self.agents[0, : s.Y + 1] += self.agents[0, s.VX : s.VY + 1] * self.dt
        self.tick += 1
        return float(np.hypot(*force))

    @property
    def momentum(self) -> Array:
        """Linear, and angular about the origin."""
        (x, y, vx, vy), (px, py, ux, uy) = self.robot[:4], self.agents[0, : s.VY + 1]
        spin = self.inertia * self.robot[7]
        turning = self.mass * (x * vy - y * vx) + self.person * (px * uy - py * ux) + spin
        return np.array([
            self.mass * vx + self.person * ux, self.mass * vy + self.person * uy, turning
        ])  # fmt: skip


@given(
    shape=SHAPES, yaw=st.floats(-3.0, 3.0), w=st.floats(-3.0, 3.0), bearing=st.floats(-3.1, 3.1),
    speed=st.floats(0.2, 2.0), across=st.floats(-0.5, 0.5),
)  # fmt: skip
@settings(max_examples=80)
def test_linear_and_angular_momentum_balance(
    shape: str, yaw: float, w: float, bearing: float, speed: float, across: float
) -> None:
    """However the person comes and the robot spins: what both have together stays, to rounding."""
    c, sn = math.cos(bearing), math.sin(bearing)
    start = (1.1 * c - across * sn, 1.1 * sn + across * c)
    hit = Bump(shape, yaw, w, start, np.array([0.3 * c, 0.3 * sn, -speed * c, -speed * sn]))
    before = hit.momentum
    forces = [hit.step() for _ in range(200)]
    assert hit.momentum == pytest.approx(before, abs=1e-9)
    if max(forces) > 0.0:
        row = hit.touches[0]
        assert row[s.TOUCH_PEAK] == pytest.approx(max(forces)) or row[s.TOUCHES] > 0.0
        assert math.isfinite(row[s.TOUCH_SIDE])


def test_force_torque_and_side_of_a_capsule() -> None:
    """A person at rest, 1 mm deep in the left flank, 0.1 m behind the middle of the base."""
    hit = Bump("capsule", 0.5 * math.pi, 0.0, (-(0.18 + 0.33 - 1e-3), -0.1), np.zeros(4))
    assert hit.step() == pytest.approx(30.0)
    force = hit.felt[s.ROBOT_FX : s.ROBOT_FY + 1]
    assert force == pytest.approx([30.0, 0.0], abs=1e-9)  # the robot looks along y: left is -x
    assert hit.felt[s.ROBOT_TORQUE] == pytest.approx(0.1 * 30.0)
    assert hit.touches[0, s.TOUCH_SIDE] == pytest.approx(math.atan2(0.18, -0.1), abs=0.01)
    assert body_side(hit.touches[0, s.TOUCH_SIDE]) == "left"


def test_a_spinning_robot_strikes_with_the_speed_of_its_corner() -> None:
    """The base stands; the wedge's tip, 0.4 m ahead of it, sweeps to the left at 2 rad/s."""
    away = 0.33 - 1e-4
    hit = Bump("wedge", 0.0, 2.0, (0.4 + 0.5 * away, math.sqrt(0.75) * away), np.zeros(4))
    hit.step()
    assert hit.touches[0, s.TOUCHING] == 1.0
    assert hit.touches[0, s.TOUCH_SPEED] == pytest.approx(0.8, rel=1e-6)


WALL = np.array([[1.0, -5.0, 1.0, 5.0]])


@given(shape=SHAPES, x=st.floats(-1.0, 0.0), y=PLACE, yaw=st.floats(-3.0, 3.0))
def test_the_gap_to_a_wall_is_that_of_the_farthest_corner(
    shape: str, x: float, y: float, yaw: float
) -> None:
    corners, _ = OUTLINES[shape]
    reach = np.max(math.cos(yaw) * corners[:, 0] - math.sin(yaw) * corners[:, 1])
    gap = outline_gap(WALL, NO_PILLARS, corners, x, y, yaw)
    assert gap == pytest.approx(max(0.0, 1.0 - x - reach), abs=1e-9)
    bx, by = touched_at(WALL, NO_PILLARS, corners, x, y, yaw)
    if gap > 0.0:
        assert x + math.cos(yaw) * bx - math.sin(yaw) * by == pytest.approx(1.0)


def test_walls_within_and_pillars_beside_an_outline() -> None:
    crossing, inner = np.array([[-9.0, 0.1, 9.0, 0.1]]), np.array([[-0.1, 0.0, 0.1, 0.1]])
    for wall in (crossing, inner):
        assert outline_gap(wall, NO_PILLARS, BOX, 0.0, 0.0, 0.3) == 0.0
    pillar = np.array([[1.0, 0.0, 0.2]])
    none = np.zeros((0, 4))
    assert outline_gap(none, pillar, BOX, 0.0, 0.0, 0.0) == pytest.approx(0.55)
    assert touched_at(none, pillar, BOX, 0.0, 0.0, 0.0) == pytest.approx((0.8, 0.0))
    assert touched_at(none, pillar, np.zeros((0, 2)), 1.0, -1.0, 0.5 * math.pi) == (
        pytest.approx((0.8, 0.0))
    )
    assert outline_gap(none, NO_PILLARS, BOX, 0.0, 0.0, 0.0) == math.inf


@given(shape=SHAPES, x=PLACE, y=PLACE, yaw=st.floats(-3.0, 3.0), seed=st.integers(0, 99))
def test_far_walls_are_left_out_without_a_difference(
    shape: str, x: float, y: float, yaw: float, seed: int
) -> None:
    corners, rng = OUTLINES[shape][0], np.random.default_rng(seed)
    walls, pillars = rng.uniform(-3.0, 3.0, (8, 4)), rng.uniform(0.1, 3.0, (2, 3))
    each = [outline_gap(walls[k : k + 1], NO_PILLARS, corners, x, y, yaw) for k in range(8)]
    each.append(outline_gap(walls[:0], pillars, corners, x, y, yaw))
    gap = outline_gap(walls, pillars, corners, x, y, yaw)
    assert gap == min(each)
    extent = max(map(math.hypot, *corners.T), default=0.0)
    for least in (gap, np.nextafter(gap, math.inf), gap - 0.3, gap + 0.3):
        c, s = math.cos(yaw), math.sin(yaw)
        assert is_clear(walls, pillars, corners, extent, x, y, c, s, least) == (gap >= least)


def _body(shape: str) -> dict[str, Any]:
    corners, radius = OUTLINES[shape]
    return {"footprint": corners, "footprint_radius": radius or 0.178}


MIDDLE = "robots.robot.task.start=[25, 0, 0]"


@pytest.mark.parametrize("shape", OUTLINES)
def test_a_wall_stops_an_outline(shape: str) -> None:
    """Driving at it head-on: the base stops where the outline's front touches; one contact."""
    world = rig(
        alone("robots.robot.task.start=[25, 3.5, 1.5707963267948966]",
              "robots.robot.control=kinematic"),
        constant(0.4), body=_body(shape),
    ).advance(6.0)  # fmt: skip
    corners, radius = OUTLINES[shape]
    front = float(np.max(corners[:, 0])) + radius
    assert world.robot().y == pytest.approx(5.0 - front, abs=2e-6)
    world.own.logger.walls.finish()
    (contact,) = world.memory.contacts
    assert contact["agent"] == -1
    assert contact["relative_speed"] == pytest.approx(0.4, rel=1e-6)
    assert contact["bearing"] == pytest.approx(0.0, abs=1e-6)


def test_corners_stop_a_turn_beside_a_wall() -> None:
    """A box along a wall turns until its rear corner touches, and turns back freely."""
    drive = Drive(lambda t: (0.0, 1.0 if t < 3.0 else -1.0))
    world = rig(
        alone("robots.robot.task.start=[25, 4.65, 0]", "robots.robot.control=kinematic"), drive,
        body=_body("box"),
    ).advance(3.0)  # fmt: skip
    yaw = world.robot().yaw
    reach = [math.sin(yaw) * x + math.cos(yaw) * y for x, y in BOX]
    assert 4.65 + max(reach) == pytest.approx(5.0, abs=1e-5)
    assert 0.1 < yaw < 0.5
    assert world.robot().w == pytest.approx(0.0, abs=1e-6)
    world.advance(4.5)
    assert world.robot().yaw < yaw - 0.05


@pytest.mark.parametrize("mode", ["force", "differential_drive"])
def test_a_push_beside_the_middle_turns_the_robot(mode: str) -> None:
    """A person walks into the front right of a box: it backs off and turns to the right."""
    world = rig(
        scenario(MIDDLE, f"robots.robot.control={mode}"), constant(0.0), person(26.0, -0.25),
        body=_body("box"),
    )  # fmt: skip
    world.advance(0.75)
    felt, touches = s.contact_with(world.crowd())
    assert touches[0, s.TOUCHES] + touches[0, s.TOUCHING] > 0.0
    robot = world.robot()
    assert robot.x < 25.0 - 1e-3
    assert robot.yaw < -1e-3
    assert felt[s.ROBOT_JX] == -felt[s.PEOPLE_JX] != 0.0


def test_people_see_a_disc_around_the_whole_outline() -> None:
    """The perceived radius is the farthest corner's distance and the margin."""
    world = rig(scenario(MIDDLE), constant(0.0), person(30.0), body=_body("box"))
    assert world.blocks.crowd is not None
    margin = scenario().crowd.robot_response.margin  # type: ignore[union-attr]
    farthest = math.hypot(0.35, 0.3)
    assert world.blocks.crowd._rows[0, 4] == 0.0
    assert world.blocks.crowd._rows[0, 5] == pytest.approx(farthest + margin)
