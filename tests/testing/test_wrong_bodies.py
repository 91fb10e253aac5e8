"""Environments and robots that are wrong, each found by the check that is for it."""
# ruff: noqa: ARG001, ARG005 - the signature of build is fixed

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from crowdbot.plugin import EnvironmentParts, RobotLimits, RobotModel
from crowdbot.plugins.robots.turtlebot2 import Turtlebot2Spec
from crowdbot.plugins.robots.turtlebot2_build import build as turtlebot2
from crowdbot.testing import environment, robot
from crowdbot.testing.checks import checks_in
from tests.testing.wrong import BUILT_IN, WrongEnvironment, WrongRobot, assert_fails, made

# ------------------------------------------------------------------------ environments
_CORNERS = np.array([[0.0, -3.0], [8.0, -3.0], [8.0, 3.0], [0.0, 3.0]])
WALLS = np.concatenate([_CORNERS, np.roll(_CORNERS, -1, axis=0)], axis=1)
ZONE = np.array([[3.0, -1.0], [5.0, -1.0], [5.0, 1.0], [3.0, 1.0]])
GAP = np.concatenate([WALLS[1:], [[0.0, -3.0, 3.0, -3.0], [5.0, -3.0, 8.0, -3.0]]])
PILLAR = {"pillars": np.array([[4.0, 0.0, 0.3]]), "pillar_heights": np.array([[0.0, 2.0]])}


def parts(walls: Any = WALLS, **changes: Any) -> EnvironmentParts:
    count = len(walls)
    given: dict[str, Any] = {
        "walls": walls,
        "wall_heights": np.tile([0.0, 2.5], (count, 1)),
        "stops_robot": np.ones(count, np.bool_),
        "stops_crowd": np.ones(count, np.bool_),
        "zones": {"middle": ZONE},
        "portals": {},
    }
    return EnvironmentParts(**{**given, **changes})


def place(found: EnvironmentParts, **words: Any) -> Any:
    return made(WrongEnvironment, lambda spec: found, **words)


@pytest.mark.parametrize(
    ("check", "found", "because"),
    [
        (environment.check_parts, parts(WALLS * np.nan), "walls is not finite"),
        (environment.check_parts, parts(wall_heights=np.zeros((4, 2))), "below the top"),
        (environment.check_parts, parts(stops_crowd=np.ones(3, np.bool_)), "stops_crowd"),
        (environment.check_parts, parts(solids=(ZONE,)), "0 solid_heights for 1"),
        (environment.check_zones_and_portals, parts(zones={"z": ZONE[::-1]}), "counter-clock"),
        (environment.check_zones_and_portals, parts(portals={"p": (1, 0, 0, 1)}), "portal 'p'"),
        (environment.check_zones_are_on_the_floor, parts(zones={"z": ZONE + 20.0}), "outside"),
        (environment.check_zones_are_on_the_floor, parts(**PILLAR), "something in its centre"),
        (environment.check_free_side_is_on_the_left, parts(WALLS[:, [2, 3, 0, 1]]), "right side"),
        (environment.check_is_closed, parts(GAP), "a robot gets out at"),
        (environment.check_is_closed, parts(stops_robot=np.zeros(4, np.bool_)), "no wall stops"),
        (environment.check_parts, parts(stops_robot=[True] * 4), "stops_robot is a list"),
    ],
)
def test_environments(check: Any, found: EnvironmentParts, because: str) -> None:
    assert_fails(check, place(found), because)


def test_a_zone_that_is_forgotten() -> None:
    words = {"zones": {"there": {"x": [1.0, 2.0], "y": [0.0, 1.0]}}}
    component = place(parts(), examples=(words,))
    assert_fails(environment.check_zones_and_portals, component, "the spec has a zone 'there'")


def test_a_place_that_is_drawn_anew() -> None:
    component = made(
        WrongEnvironment, lambda spec: parts(WALLS + np.random.default_rng().normal(0.0, 0.1))
    )
    assert_fails(environment.check_same_spec_same_place, component, "other walls")


def test_a_place_that_lacks_the_zones_of_the_words_does_not_run() -> None:
    with pytest.raises(KeyError):
        environment.check_runs(place(parts()), BUILT_IN)


def test_a_sound_place_passes() -> None:
    def build(spec: Any) -> EnvironmentParts:
        zones = {name: np.array(zone.polygon) for name, zone in spec.zones.items()}
        return parts(zones={"middle": ZONE, **zones})

    for check in checks_in(environment):
        check(made(WrongEnvironment, build), BUILT_IN)


# ------------------------------------------------------------------------------ robots
SOUND = turtlebot2(Turtlebot2Spec())
FLAT = np.array([[-0.2, -0.2], [-0.2, 0.2], [0.2, -0.2]])  # clockwise


def kind_of(model: RobotModel) -> Any:
    return made(WrongRobot, lambda spec: model)


def limits(**changes: Any) -> RobotLimits:
    return replace(SOUND.limits, **changes)


@pytest.mark.parametrize(
    ("check", "changes", "because"),
    [
        (robot.check_model, {"limits": limits(v_max=0.0)}, "v from"),
        (robot.check_model, {"limits": limits(a_max=float("nan"))}, "a_max is nan"),
        (robot.check_model, {"limits": limits(command_timeout=0.0)}, "command_timeout"),
        (robot.check_model, {"force_height": 3.0}, "force_height"),
        (robot.check_model, {"footprint": FLAT}, "counter-clockwise"),
        (robot.check_mass_agrees, {"mass": 60.0}, "the links weigh 6.3"),
        (robot.check_footprint_agrees, {"footprint_radius": 0.1}, "beyond the footprint"),
        (robot.check_footprint_agrees, {"footprint_radius": 0.4}, "less than the footprint"),
        (robot.check_footprint_agrees, {"height": 0.2}, "m high"),
    ],
)
def test_robots(check: Any, changes: dict[str, Any], because: str) -> None:
    assert_fails(check, kind_of(replace(SOUND, **changes)), because)


def test_a_robot_that_is_another_one_each_time() -> None:
    component = made(
        WrongRobot, lambda spec: replace(SOUND, height=float(np.random.default_rng().random()))
    )
    assert_fails(robot.check_model_is_constant, component, "height differs")


def test_a_robot_that_cannot_drive() -> None:
    ice = SOUND.description.replace("mu_dynamic>1.0<", "mu_dynamic>0.0<")
    weak = replace(SOUND, description=ice.replace("mu_static>1.0<", "mu_static>0.0<"))
    assert_fails(robot.check_drives_ahead, kind_of(weak), "m ahead in 2 s")


def test_a_robot_that_does_not_stop() -> None:
    """It says another timeout than the one it has."""
    timeouts = iter([0.05, *[math.inf] * 10])

    def build(spec: Any) -> RobotModel:
        return replace(SOUND, limits=limits(command_timeout=next(timeouts), a_max=2.0))

    component = made(WrongRobot, build)
    assert_fails(robot.check_stops_without_commands, component, "after the last command")
