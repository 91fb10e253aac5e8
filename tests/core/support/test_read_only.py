"""What sensors, noise generators and metrics are given: nobody can make its arrays writable.

Cost functions and policies: tests/core/crowd/velocity_search/test_broken.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pytest

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.build import build_policy
from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.sensing.other_robots import OtherRobot, RobotSurfaces
from crowdbot.core.sensing.range_model import RangeModel
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.support.immutable import immutable_fields
from crowdbot.core.trajectories import encounters, headway, preprocess
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.appearance import Appearance
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotState
from crowdbot.dsl.spec.component_specs import CrowdPolicySpec
from crowdbot.dsl.spec.range_sensor import RangeSensorSpec
from tests.core.sensing.sensing_worlds import REGISTRY


def scene(robots: bool) -> Scene:
    """A wall, a pillar, three people who look different; perhaps two other robots."""
    looks = Appearance(
        height=np.zeros(3), leg_length=np.zeros(3), phase=np.zeros(3),
        look=("", "stroller", "wheelchair_user"),
    )  # fmt: skip
    corners = np.array([[0.3, -0.2], [0.3, 0.2], [-0.3, 0.2], [-0.3, -0.2]])
    others = [
        OtherRobot(Footprint(corners, 0.0), 1.0),
        OtherRobot(Footprint(np.zeros((0, 2)), 0.3), 1.2),
    ]
    seen = Scene(
        [[2.0, -3.0, 2.0, 3.0]], [0.0, 2.5], [0.25] * 3, 1.7, [[1.0, 1.0, 0.2]], [[0.0, 2.0]],
        looks, others if robots else (),
    )  # fmt: skip
    if robots:
        seen.show_robots([Pose(3.0, 0.0, 0.0), None])
    people = np.column_stack([np.arange(3.0), np.ones(3), np.zeros((3, 2))])
    seen.update(RobotState(0, 0, 0, 0, 0, 0, 0, 0, 0, 0), people, np.ones(3, dtype=np.bool_))
    return seen


def run() -> Trajectories:
    """A robot that passes two people; velocities were not recorded."""
    t = np.arange(0.0, 4.0, 0.25)
    return Trajectories.from_arrays(
        t=t, robot_x=t, robot_y=0.0 * t, robot_theta=0.0 * t, robot_radius=0.2, robot_mass=30.0,
        robot_goal_time=3.0, robot_goal=(3.0, 0.0), agent_id=[0, 1],
        agent_x=np.column_stack([t, 4.0 - t]), agent_y=np.ones((len(t), 2)),
        agent_radius=[0.25, 0.25], agent_mass=[80.0, 80.0], walls=[[0.0, 3.0, 9.0, 3.0]],
        contacts={
            "t0": [1.0], "t1": [1.1], "agent": [0], "impulse": [1.0], "peak_force": [9.0],
            "relative_speed": [0.5],
        }, signals={"noise": [[0.0, 1.0]]},
    )  # fmt: skip


def with_parts(value: Any) -> Iterator[Any]:
    """Arrays of a value and of the values that it consists of."""
    if isinstance(value, np.ndarray):
        yield value
    elif isinstance(value, dict):
        for part in value.values():
            yield from with_parts(part)
    elif isinstance(value, (tuple, list)):
        for part in value:
            yield from with_parts(part)
    elif isinstance(value, (Scene, RobotSurfaces)):
        for name in dir(value):
            if not name.startswith("_"):
                yield from with_parts(getattr(value, name))
    elif is_dataclass(value):
        for part in fields(value):
            yield from with_parts(getattr(value, part.name))


def by_metrics() -> list[Any]:
    moves = preprocess.with_velocities(run())
    early = preprocess.truncate_at_arrival(moves)
    found: list[Any] = [moves, early]
    for part in (moves, early):
        found += [encounters.encounter(part, 10.0), encounters.approach(part, 10.0, 0.0, 0.1)]
        found += [encounters.onsets(part, 10.0, 0.0, 0.1), encounters.people_speeds(part, 10.0)]
        found += [encounters.people_velocities(part, 10.0), headway.headway(part, 10.0)]
    return found


def by_noise() -> list[Any]:
    seen: list[Any] = []

    class Generator:
        random = False

        def errors(self, distance: Any, rng: Any) -> Any:
            del rng
            seen.append(distance)
            return np.zeros(len(distance))

    spec = REGISTRY.spec_model("sensor", "ultrasound").model_validate({"kind": "ultrasound"})
    assert isinstance(spec, RangeSensorSpec)
    RangeModel(spec, [Generator(), Generator()]).measure(np.ones(9), np.random.default_rng(0))
    return seen


def by_policies() -> list[Any]:
    looks = Appearance(height=np.zeros(1), leg_length=np.zeros(1), phase=np.zeros(1), look=("",))
    agents = Agents.of(x=np.zeros(1), y=np.zeros(1), routes=[[(9.0, 0.0)]], looks=looks)
    spec = REGISTRY.spec_model("crowd policy", "velocity_space").model_validate(
        {"kind": "velocity_space"}
    )
    assert isinstance(spec, CrowdPolicySpec)
    built: Any = build_policy(REGISTRY, spec, [], agents)
    return [immutable_fields(agents), built.costs.agents]


@pytest.mark.parametrize(("given", "least"), [
    (lambda: [scene(robots=False)], 15), (lambda: [scene(robots=True)], 20),
    (by_noise, 2), (by_metrics, 40), (by_policies, 15),
])  # fmt: skip
def test_nobody_can_make_it_writable(given: Callable[[], list[Any]], least: int) -> None:
    arrays = list(with_parts(given()))
    assert len(arrays) >= least
    for array in arrays:
        memory: Any = array
        while isinstance(memory, np.ndarray):
            assert not memory.flags.writeable
            with pytest.raises(ValueError, match="WRITEABLE"):
                memory.setflags(write=True)
            with pytest.raises(ValueError, match="WRITEABLE"):
                memory.flags.writeable = True
            with pytest.raises(ValueError, match="WRITEABLE"):
                np.asarray(memory).setflags(write=True)
            assert memory.data.readonly
            memory = memory.base
        assert isinstance(memory, bytes)


def test_a_scene_shows_each_instant_once() -> None:
    seen = scene(robots=True)
    assert seen.people is seen.people
    assert seen.obstacles is seen.obstacles
    before, wall = seen.people.copy(), seen.walls[-1].copy()
    seen.update(None, before + 1.0, np.zeros(3, dtype=np.bool_))
    seen.show_robots([Pose(5.0, 0.0, 0.0), None])
    assert np.array_equal(seen.people, before + 1.0)
    assert not seen.present.any()
    assert np.isinf(seen.cylinders[:9, 0]).all()
    assert seen.walls[-1, 0] == wall[0] + 2.0
