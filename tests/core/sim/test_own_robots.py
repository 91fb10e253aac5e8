"""Robots that somebody else describes: they go where they are told, or an error says why not."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.planning.host import PlannerHost
from crowdbot.core.robots.check import check_model
from crowdbot.core.robots.description_file import read_description
from crowdbot.core.robots.task import robot_task
from crowdbot.core.robots.urdf_export import to_urdf
from crowdbot.core.sensing.build import build_sensor
from crowdbot.core.sim.control.kinematic import arc
from crowdbot.core.sim.planner_system import _slew_planar
from crowdbot.core.support.ticks import TICK
from crowdbot.errors import InputError, PluginError, SpecError
from crowdbot.plugin import Command, DifferentialDrive, Observation, RobotState
from crowdbot.testing.commanded_motion import assert_moves, check_commanded_motion, drive
from crowdbot.testing.sensor_scenes import context
from tests.core.robots.test_published import pepper_model, qolo_model
from tests.core.sim import sim_worlds
from tests.core.sim.own_robots import HOWTO, known, model
from tests.core.sim.sim_worlds import Drive, alone, rig

pytestmark = pytest.mark.slow

PUCK, TROLLEY = "my_robots.puck", "my_robots.trolley"
WHEELS = "differential_drive"
MIDDLE = "robots.robot.task.start=[25, 0, 0.5]"


@pytest.fixture(autouse=True)
def _installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sim_worlds, "registry", known)


class Holonomic(Drive):
    """A planner whose command has vy, too."""

    def __init__(self, *command: float) -> None:
        super().__init__(lambda _: (0.0, 0.0))
        self.answer = Command(*command)

    def step(self, obs: Any) -> Command:
        super().step(obs)
        return self.answer


def _puck(mode: str) -> Any:
    kind = f"robots.robot.model={{kind: {PUCK}}}"
    sensors = "robots.robot.sensors.odometry={kind: holonomic_odometry}"
    return alone(MIDDLE, kind, sensors, f"robots.robot.control={mode or 'null'}")


@pytest.mark.parametrize("kind", [PUCK, TROLLEY, "turtlebot2"])
def test_every_robot_moves_as_commanded(kind: str) -> None:
    check_commanded_motion(known().find("robot", kind), known())


@pytest.mark.parametrize("mode", ["force", "kinematic"])
def test_a_holonomic_robot_goes_where_its_body_twist_leads(mode: str) -> None:
    """Constant (v, vy, w) is a circle about the point where the body stands still."""
    v, w, vy = 0.3, 0.5, 0.2
    planner = Holonomic(v, w, vy)
    world = rig(_puck(mode), planner)
    track = [r for t, r in world.track(6.0, 0.25) if t >= 1.0]
    for r in track:
        c, d = math.cos(r.yaw), math.sin(r.yaw)
        assert (c * r.vx + d * r.vy, c * r.vy - d * r.vx) == pytest.approx((v, vy), abs=3e-3)
        assert r.w == pytest.approx(w, abs=1e-3)
    still = [
        (r.x - (d * v + c * vy) / w, r.y + (c * v - d * vy) / w)
        for r in track
        for c, d in [(math.cos(r.yaw), math.sin(r.yaw))]
    ]
    assert np.ptp(still, axis=0) == pytest.approx([0.0, 0.0], abs=0.01)
    seen = planner.seen[-1]
    robot = world.robot()
    assert (seen.twist[0], seen.vy) == pytest.approx((v, vy), abs=0.12)  # ticks of 64 Hz
    late = world.memory.readings["odometry"][-1].values
    assert late[:2] == pytest.approx([robot.x, robot.y], abs=0.01)
    assert late[2] == pytest.approx(robot.yaw, abs=0.02)
    assert world.memory.commands[-1][1] == (v, w, vy)


def test_it_is_pushed_by_a_force_unless_told_otherwise() -> None:
    (robot,) = _puck("").robots.values()
    assert robot.control == "force"
    with pytest.raises(SpecError, match=r"my_robots\.puck; what does: force, kinematic"):
        _puck("differential_drive")


def test_people_push_a_holonomic_robot_and_it_comes_to_rest_again() -> None:
    kind = f"robots.robot.model={{kind: {PUCK}}}"
    world = rig(
        sim_worlds.scenario(MIDDLE, kind, "robots.robot.control=force"), Holonomic(0.0, 0.0, 0.0),
        sim_worlds.person(26.5), sensors=(),
    )  # fmt: skip
    world.advance(4.0)
    robot, (felt, _) = world.robot(), s.contact_with(world.crowd())
    assert felt[s.ROBOT_JX] == -felt[s.PEOPLE_JX] != 0.0
    assert robot.x < 25.0
    assert math.hypot(robot.vx, robot.vy) < 0.05
    assert robot.tilt < math.radians(1.0)


@pytest.mark.parametrize("mode", ["force", "kinematic"])
def test_a_wall_stops_what_comes_sideways(mode: str) -> None:
    world = rig(_puck(mode), Holonomic(0.0, 0.0, 0.5))
    top = max(r.y for _, r in world.track(14.0, 0.5))
    assert top < 4.8 + 3e-3
    assert top > 4.7


def test_checkpoints_hold_the_measuring_wheels() -> None:
    """A clone of the context goes on as the run itself does."""
    world = rig(_puck("force"), Holonomic(0.2, 0.4, 0.2)).advance(1.0)
    before = world.simulator.get_context().Clone()
    ended = world.advance(2.0).robot()
    world.simulator.reset_context(before)
    assert world.advance(2.0).robot() == ended


def test_the_host_clamps_vy_to_what_the_drive_gives() -> None:
    limits = model(PUCK).limits
    task: Any = robot_task(
        next(iter(_puck("").robots.values())), build_environment(known(), _puck("").environment)
    )
    for given_limits, inside, clamped in (
        (limits, 0.6, True), (replace(limits, vy_max=0.0), 0.0, True),
        (replace(limits, vy_max=0.9), 0.8, False),
    ):  # fmt: skip
        host = PlannerHost(Holonomic(0.1, 0.0, 0.8), "test", given_limits)
        host.reset(task, {}, 0)
        seen = Observation(
            t=0.0, pose=task.start, twist=(0, 0), goal=task.goal, goal_zone=task.goal_zone
        )
        answer = host.step(seen)
        assert (answer.command.vy, answer.clamped) == (inside, clamped)


SPEED = st.floats(-2.0, 2.0)


@given(SPEED, SPEED, SPEED, SPEED, st.floats(1e-3, 0.1))
def test_the_slew_of_a_vector_is_no_longer_than_a_step(
    v: float, vy: float, to_v: float, to_vy: float, step: float
) -> None:
    new_v, new_vy = _slew_planar(v, vy, to_v, to_vy, step)
    assert math.hypot(new_v - v, new_vy - vy) <= step * (1 + 1e-12)
    left, was = math.hypot(to_v - new_v, to_vy - new_vy), math.hypot(to_v - v, to_vy - vy)
    assert left == pytest.approx(max(0.0, was - step), abs=1e-9)


@given(SPEED, SPEED, SPEED)
def test_a_tick_sideways_is_the_exact_motion(v: float, vy: float, w: float) -> None:
    """Against the integral of the body twist, in small steps."""
    x, y, _ = arc(0.0, 0.0, math.atan2(vy, v), math.hypot(v, vy), w, 0.5)
    times = (np.arange(2000) + 0.5) * 0.5 / 2000
    way = np.exp(1j * w * times) * complex(v, vy)
    total = way.mean() * 0.5
    assert (x, y) == pytest.approx((total.real, total.imag), abs=1e-6)


# ----------------------------------------------------------------- descriptions that do not fit
TEXT = (HOWTO / "my_robots" / "trolley.urdf").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("</robot>", "", "not well-formed XML.*line"),
        ("<robot name", "<rabbit name", "not well-formed"),
        ('name="left_wheel_joint"', 'name="left_weel_joint"', "no joint 'left_wheel_joint'; did"),
        ('<link name="base_link">', '<link name="body">', "no link 'base_link'"),
        ('<child link="left_wheel"/>', '<child link="left_weel"/>', "no link 'left_weel'; did you"),
        ('xyz="0 0.16 0" rpy="-1.57', 'xyz="0 0.16 0" rpy="1.57', "does not drive ahead"),
        ('xyz="0 0.16 0"', 'xyz="0.1 0.16 0"', "0.1 m ahead of 'base_link'"),
        ('xyz="0 0.16 0"', 'xyz="0 0.26 0"', "the wheels are 0.42 m apart"),
        ('xyz="0 0.16 0"', 'xyz="0 -0.16 0"', "other side"),
        ('<limit effort="4" velocity="15"/>', "", "has no motor"),
        ('value="14"', 'value="13"', "the links weigh 15 kg"),
        ('value="14"', 'value="heavy"', "mass of 'base_link': could not convert"),
        ('type="revolute"', 'type="planar"', "'mast_joint' is planar"),
        ('<cylinder radius="0.08" length="0.03"/>', '<mesh filename="w.stl"/>', "a mesh; use box"),
        ('<cylinder radius="0.08" length="0.03"/>', '<box size="1 1 1"/>', "shape that can roll"),
        ('type="continuous"', 'type="fixed"', "is fixed; a wheel's is continuous"),
        ("<robot name", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name', ""),
    ],
)
def test_a_description_that_does_not_fit_is_told(old: str, new: str, message: str) -> None:
    assert old in TEXT
    broken = replace(model(TROLLEY), description=TEXT.replace(old, new))
    if not message:  # macros that are not used do no harm
        check_model(broken)
        return
    with pytest.raises(PluginError, match=message):
        check_model(broken)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"base": "base_lnk"}, "no link 'base_lnk'; did you mean 'base_link'"),
        ({"base": "mast"}, "let it be the base"),
        ({"base_height": 0.2}, "0.12 m above the floor"),
        ({"mass": math.nan}, "mass is nan"),
        ({"footprint_radius": 0.0}, "footprint_radius is 0.0"),
        ({"description": "trolley.txt"}, "cannot be read"),
        ({"description": "<html/>"}, "neither URDF"),
        ({"description": "<robot/>"}, "no link"),
    ],
)
def test_a_model_that_does_not_fit_is_told(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(PluginError, match=message):
        check_model(replace(model(TROLLEY), **changes))
    with pytest.raises(PluginError, match="RobotModel is wanted"):
        check_model(changes)


def test_only_a_holonomic_drive_has_sideways_limits() -> None:
    trolley = model(TROLLEY)
    with pytest.raises(PluginError, match="do not go sideways"):
        check_model(replace(trolley, limits=replace(trolley.limits, vy_max=0.1)))


def test_the_motion_check_finds_what_the_numbers_hide() -> None:
    """A wheel that is larger than the drive believes, too little to be refused."""
    trolley = model(TROLLEY)
    drive_ = trolley.drive
    assert isinstance(drive_, DifferentialDrive)
    wrong = replace(trolley, drive=replace(drive_, command_radius=0.073))
    with pytest.raises(AssertionError, match="moved"):
        assert_moves(wrong, "differential_drive", Command(0.2, 0.0))


def test_wheels_may_be_named_in_any_order() -> None:
    """The right wheel described first: left and right are not mixed up."""
    left = TEXT.index('  <link name="left_wheel">')
    right = TEXT.index('  <link name="right_wheel">')
    end = TEXT.index('  <link name="mast">')
    turned = TEXT[:left] + TEXT[right:end] + TEXT[left:right] + TEXT[end:]
    states: list[RobotState] = [
        drive(replace(model(TROLLEY), description=t), WHEELS, Command(0.2, 0.5), 1.0)[-1]
        for t in (TEXT, turned)
    ]
    assert states[0] == pytest.approx(states[1], abs=1e-6)
    assert states[0].yaw > 0.2


def test_a_root_on_the_floor_changes_nothing() -> None:
    """``base_footprint`` below ``base_link``, as ROS likes it."""
    below = (
        '<link name="base_footprint"/><joint name="up" type="fixed">'
        '<parent link="base_footprint"/><child link="base_link"/><origin xyz="0 0 0.08"/></joint>'
    )
    grounded = replace(model(TROLLEY), description=TEXT.replace("</robot>", f"{below}</robot>"))
    for mode in ("force", "differential_drive"):
        plain = drive(model(TROLLEY), mode, Command(0.2, 0.3), 1.0)[-1]
        same = drive(check_model(grounded), mode, Command(0.2, 0.3), 1.0)[-1]
        assert same[:8] == pytest.approx(plain[:8], abs=1e-4)
    text = to_urdf(grounded, {}, "trolley")
    assert text.count('"base_footprint_joint"') == 0
    assert text.count('child link="base_link"') == 1


def test_the_exported_urdf_has_one_root_and_the_sensors() -> None:
    from crowdbot.plugin import Mount

    registry = known()
    lidar = registry.find("sensor", "lidar2d").spec(mount=Mount(x=0.1, z=0.3))
    infos = {"lidar": build_sensor(registry, lidar, context()).info()}
    text = to_urdf(model(PUCK), infos, "puck")
    described = read_description(text)
    assert described.root == "base_footprint"
    assert described.pose("lidar", "base_link")[:3, 3] == pytest.approx([0.1, 0.0, 0.3])
    named = model(TROLLEY)
    clash = {"mast": infos["lidar"]}
    with pytest.raises(InputError, match="has the name of a link"):
        to_urdf(named, clash, "trolley")
    for taken in ("map", "odom", "base_footprint", "base_link"):
        with pytest.raises(InputError, match=f"'{taken}' has the name of another frame"):
            to_urdf(model(PUCK), {taken: infos["lidar"]}, "puck")
    camera = build_sensor(registry, registry.find("sensor", "rgbd_camera").spec(), context()).info()
    with pytest.raises(InputError, match="'eye_optical' has the name of another frame"):
        to_urdf(model(PUCK), {"eye": camera, "eye_optical": infos["lidar"]}, "puck")


def test_commands_do_not_jump() -> None:
    """|change of (v, vy)| is at most a_max a tick, in the robot's frame."""
    world = rig(_puck("kinematic"), Holonomic(0.4, 0.0, 0.4))
    track = [r for _, r in world.track(1.0, TICK)]
    for before, after in itertools.pairwise(track):
        step = math.hypot(after.vx - before.vx, after.vy - before.vy)
        assert step <= 1.0 * TICK * (1 + 1e-9)


@pytest.mark.parametrize("kind", ["pepper", "qolo"])
def test_robots_as_published_go_where_they_are_told(kind: str) -> None:
    """Files with the structure of those of Pepper and Qolo, in Drake."""
    model = pepper_model() if kind == "pepper" else qolo_model()
    mode = "force" if kind == "pepper" else WHEELS
    for command in (Command(0.3, 0.0), Command(0.0, 0.5)):
        assert_moves(model, mode, command)
