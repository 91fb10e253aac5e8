"""Low walls and raised gates: who sees them, who touches them, who walks under them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.sensing.depth_renderer import DepthRenderer
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.sim.control.kinematic import obstacles
from crowdbot.core.types.sensor import Pinhole
from crowdbot.plugin import EnvironmentParts, Pose
from crowdbot.plugins.environments.floor import FloorSpec
from crowdbot.plugins.environments.place_build import build
from tests.core.sim.sim_worlds import registry, scenario
from tests.core.sim.test_obstacles import BODY, drive

#: name -> bottom and top of a wall across the way, m.
WALLS = {"low": (0.0, 0.3), "gate": (0.3, 1.1), "beam": (0.45, 2.2), "sign": (2.0, 2.5)}
#: Heights of an ultrasound and of a lidar, m.
SONAR, LIDAR = 0.15, 0.4


def _parts(name: str) -> EnvironmentParts:
    bottom, top = WALLS[name]
    wall = {"start": [3.0, -1.0], "end": [3.0, 1.0], "thickness": 0.2}
    return build(
        FloorSpec.model_validate(
            {
                "area": {"x": (-5.0, 15.0), "y": (-5.0, 5.0)},
                "walls": {"w": {**wall, "base": bottom, "height": top}},
            }
        )
    )


def _scene(name: str) -> Scene:
    parts = _parts(name)
    return Scene(parts.walls, parts.wall_heights, [], [], parts.pillars, parts.pillar_heights)


@pytest.mark.parametrize(
    ("name", "sonar", "lidar"),
    [("low", True, False), ("gate", False, True), ("beam", False, False), ("sign", False, False)],
)
def test_each_sensor_sees_what_is_at_its_height(name: str, sonar: bool, lidar: bool) -> None:
    for height, sees in ((SONAR, sonar), (LIDAR, lidar)):
        ray = np.array([[0.0, 0.0, height]]), np.array([[1.0, 0.0, 0.0]])
        distance, _, _ = _scene(name).cast(*ray, 12.0)
        assert distance[0] == (pytest.approx(2.9) if sees else np.inf)


@pytest.mark.parametrize("name", ["low", "gate", "beam"])
def test_the_depth_camera_sees_them_all(name: str) -> None:
    lens = Pinhole(width=8, height=200, focal=150.0)
    camera = DepthRenderer(lens, 0.1, 20.0)
    image = _scene(name).render_depth(camera, (0.0, 0.0, 0.287), 0.0)
    heights = 0.287 + 2.9 * camera.slope
    hit = np.isclose(image[:, 4], 2.9)
    bottom, top = WALLS[name]
    assert np.array_equal(hit, (heights > bottom) & (heights < top))
    assert np.count_nonzero(hit) > 10


@pytest.mark.slow
@pytest.mark.parametrize(("name", "stops"), [("low", True), ("gate", True), ("beam", False)])
def test_the_robot_touches_what_is_at_its_own_height(name: str, stops: bool) -> None:
    x, _ = drive(_parts(name), Pose(1.0, 0.0, 0.0), 7.0)
    assert (x + BODY == pytest.approx(2.9, abs=0.02)) if stops else x > 3.1


@pytest.mark.parametrize(("name", "meets"), [("low", 1), ("gate", 1), ("beam", 0), ("sign", 0)])
def test_without_forces_too(name: str, meets: int) -> None:
    walls, _ = obstacles(_parts(name), 0.42)
    assert len(walls) == 4 + 4 * meets


@pytest.mark.parametrize(("name", "meets"), [("low", 1), ("gate", 1), ("beam", 1), ("sign", 0)])
def test_people_walk_under_what_is_above_their_heads(name: str, meets: int) -> None:
    bottom, top = WALLS[name]
    environment: dict[str, Any] = {
        "kind": "floor",
        "area": {"x": [-5.0, 60.0], "y": [-6.0, 6.0]},
        "walls": {"w": {"start": [3, -1], "end": [3, 1], "base": bottom, "height": top}},
        "pillars": {"p": {"x": 1, "y": 1, "radius": 0.2, "base": bottom, "height": top}},
    }
    one = scenario()
    spec = registry().find("environment", "floor").spec.model_validate(environment)
    assert one.crowd is not None
    crowd = build_crowd(one, Realisation.nobody(), build_environment(registry(), spec), registry())
    assert crowd is not None
    assert len(crowd.world.walls) == 4 + 4 * meets
    assert len(crowd.world.pillars) == meets
