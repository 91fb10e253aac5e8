"""The planners that see nothing: one stands, one follows the wall."""

import math

import numpy as np
import pytest

from crowdbot.core.registry.build_reference import load_build
from crowdbot.plugin import Command, Pose
from crowdbot.plugins.planners import stand_still_build, wall_hug_build
from crowdbot.plugins.planners.goal_seek import GoalSeekSpec
from crowdbot.plugins.planners.goal_seek_build import build as build_goal_seek
from crowdbot.plugins.planners.stand_still import STAND_STILL, StandStillSpec
from crowdbot.plugins.planners.wall_hug import WALL_HUG, WallHugSpec
from tests.plugins.planners.world import HALF_WIDTH, LIMITS, RADIUS, START, World

NO_WALLS = np.empty((0, 4))


def test_components() -> None:
    assert load_build(STAND_STILL) is stand_still_build.build
    assert load_build(WALL_HUG) is wall_hug_build.build
    assert StandStillSpec.needs == WallHugSpec.needs == ()
    assert StandStillSpec.role == WallHugSpec.role == "floor"


def test_standing_still_nothing_moves() -> None:
    world = World([[2.9, 0.6, 0.0, 0.0]])
    out = world.run(stand_still_build.build(StandStillSpec()), time_limit=2.0)
    assert world.pose == START
    assert set(out.commands) == {Command(0.0, 0.0)}


@pytest.mark.parametrize(("side", "sign"), [("left", 1.0), ("right", -1.0)])
def test_it_follows_the_wall_of_the_corridor(side: str, sign: float) -> None:
    spec = WallHugSpec.model_validate({"kind": "wall_hug", "side": side})
    out = World().run(wall_hug_build.build(spec), stop_at=30.0)
    assert out.arrived
    late = [p for p in out.path if p.x > 15.0]
    assert all(abs(sign * p.y - (HALF_WIDTH - 0.3)) < 0.02 for p in late)
    assert out.least_wall_gap > 0.3 - RADIUS - 0.02


def test_it_ends_in_the_goal_zone() -> None:
    world = World(start=Pose(40.0, 0.0, 0.0))
    world.run(wall_hug_build.build(WallHugSpec()), time_limit=40.0, stop_at=60.0)
    assert world.pose.x == pytest.approx(47.5, abs=0.1)
    assert world.pose.y == pytest.approx(HALF_WIDTH - 0.3, abs=0.1)
    assert abs(world.twist[0]) < 1e-3


def test_left_is_left_on_the_way_whatever_the_way() -> None:
    """The corridor driven from its end to its beginning: the left wall is the one at -y."""
    world = World(start=Pose(47.5, 0.0, math.pi), goal=(2.5, 0.0), walls=NO_WALLS)
    world.run(wall_hug_build.build(WallHugSpec()), time_limit=25.0, stop_at=60.0)
    assert world.pose.y == pytest.approx(-(HALF_WIDTH - 0.3), abs=0.05)


def test_it_sees_nobody() -> None:
    wall = HALF_WIDTH - 0.3
    out = World([[20.0, wall, 0.0, 0.0]]).run(wall_hug_build.build(WallHugSpec()), stop_at=25.0)
    assert len(out.contacts) == 1


def test_it_is_away_from_those_in_the_middle() -> None:
    people = [[x, 0.0, 0.0, 0.0] for x in (15.0, 20.0, 25.0)]
    hug = World(people).run(wall_hug_build.build(WallHugSpec()), stop_at=30.0)
    straight = World(people).run(build_goal_seek(GoalSeekSpec()), stop_at=30.0)
    assert (len(hug.contacts), len(straight.contacts)) == (0, 3)


def test_commands_keep_to_the_limits() -> None:
    out = World(start=Pose(2.5, 0.0, -2.0)).run(
        wall_hug_build.build(WallHugSpec()), time_limit=20.0
    )
    assert all(0.0 <= c.v <= LIMITS.v_max and abs(c.w) <= LIMITS.w_max for c in out.commands)
