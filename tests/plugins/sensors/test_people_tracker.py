"""The privileged tracker: frames, occlusion, misses, noise."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from pydantic import ValidationError

from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugin import Mount, Pose, RobotState
from crowdbot.plugins.sensors.people_tracker import PEOPLE_TRACKER, PeopleTrackerSpec
from crowdbot.plugins.sensors.people_tracker_build import build
from crowdbot.testing.sensor_scenes import context

Array = NDArray[np.float64]
ORIGIN = Pose(0.0, 0.0, 0.0)


def scene_of(
    people: object, walls: object = (), top: float = 2.5, absent: tuple[int, ...] = ()
) -> Scene:
    rows = np.asarray(people, np.float64)
    rows = rows.reshape(len(rows), -1) if len(rows) else rows
    xyv = np.zeros((len(rows), 4))
    xyv[:, : rows.shape[1]] = rows
    scene = Scene(walls, [0.0, top], np.full(len(rows), 0.33), 1.7)  # type: ignore[arg-type]
    present = np.ones(len(rows), np.bool_)
    present[list(absent)] = False
    scene.update(RobotState(0, 0, 0, 0, 0, 0, 0, 0.0102, 0, 0), xyv, present)
    return scene


def read(spec: PeopleTrackerSpec, scene: Scene, pose: Pose = ORIGIN, tick: int = 0) -> Array:
    rng = sensor_rng(0, "robot", "tracker", tick)
    return build(spec, context()).read(scene, pose, tick / 128, rng)


def ids(rows: Array) -> list[int]:
    return [int(k) for k in rows[:, 0] if k >= 0]


def test_info_says_that_it_is_privileged() -> None:
    info = build(PeopleTrackerSpec(max_people=7), context()).info()
    assert info.privileged
    assert (info.category, info.shape, info.random) == ("people", (7, 5), False)
    assert load_build(PEOPLE_TRACKER) is build


def test_nearest_first_padded_and_cut() -> None:
    scene = scene_of([(5, 0), (1, 1), (-3, 0)])
    rows = read(PeopleTrackerSpec(max_people=4, occlusion=False), scene)
    assert ids(rows) == [1, 2, 0]
    assert rows[3].tolist() == [-1.0, 0.0, 0.0, 0.0, 0.0]
    assert ids(read(PeopleTrackerSpec(max_people=2), scene)) == [1, 2]
    assert ids(read(PeopleTrackerSpec(), scene_of(np.zeros((0, 2))))) == []
    assert ids(read(PeopleTrackerSpec(), scene_of([(5, 0), (1, 1)], absent=(1,)))) == [0]


@settings(max_examples=40)
@given(st.floats(-5, 5), st.floats(-5, 5), st.floats(-3.1, 3.1), st.floats(-1, 1), st.floats(-1, 1))
def test_in_the_axes_of_the_robot(x: float, y: float, yaw: float, vx: float, vy: float) -> None:
    """Turned back, it is the truth."""
    rows = read(PeopleTrackerSpec(occlusion=False), scene_of([(2, 1, vx, vy)]), Pose(x, y, yaw))
    c, s = math.cos(yaw), math.sin(yaw)
    turn = np.array([[c, -s], [s, c]])
    assert rows[0, 0] == 0
    assert turn @ rows[0, 1:3] + (x, y) == pytest.approx([2, 1])
    assert turn @ rows[0, 3:] == pytest.approx([vx, vy])


def test_range_and_field_of_view() -> None:
    scene = scene_of([(3, 0), (0, 3), (-3, 0), (9.5, 0.1)])
    ahead = PeopleTrackerSpec(view=math.pi / 2, occlusion=False)
    assert ids(read(ahead, scene)) == [0, 3]
    assert ids(read(ahead.model_copy(update={"range_max": 5.0}), scene)) == [0]
    assert ids(read(ahead, scene, Pose(0, 0, math.pi / 2))) == [1]
    assert ids(read(ahead.model_copy(update={"mount": Mount(yaw=math.pi)}), scene)) == [2]
    behind = scene_of([(-3, 1e-9), (-3, -1e-9)])
    assert len(ids(read(PeopleTrackerSpec(view=2 * math.pi, occlusion=False), behind))) == 2


def test_somebody_in_the_way_hides_who_is_behind() -> None:
    spec = PeopleTrackerSpec(mount=Mount(z=1.265))
    row = scene_of([(2, 0), (5, 0)])
    assert ids(read(spec, row)) == [0]
    assert ids(read(spec.model_copy(update={"occlusion": False}), row)) == [0, 1]
    # A trunk of 0.22 m at 2 m hides 0.55 m to either side at 5 m.
    assert ids(read(spec, scene_of([(2, 0), (5, 0.6)]))) == [0, 1]
    assert ids(read(spec, scene_of([(2, 0), (5, 0.3)]))) == [0]
    assert ids(read(spec, row, Pose(5, 3, 0))) == [1, 0]


def test_from_below_the_hip_one_sees_between_legs() -> None:
    """From 0.41 m up to 1.275 m at 5 m a line is at 0.76 m where the other's legs are."""
    assert ids(read(PeopleTrackerSpec(), scene_of([(2, 0), (5, 0)]))) == [0, 1]
    assert ids(read(PeopleTrackerSpec(), scene_of([(4, 0), (5, 0)]))) == [0]


def test_walls_hide_and_low_ones_do_not() -> None:
    wall, spec = [[3.0, -9.0, 3.0, 9.0]], PeopleTrackerSpec()
    assert ids(read(spec, scene_of([(2, 0), (5, 3)], wall))) == [0]
    assert ids(read(spec, scene_of([(2, 0), (5, 3)], wall, top=0.3))) == [0, 1]


def test_on_top_of_each_other() -> None:
    """The robot in the middle of somebody sees them and nobody else."""
    assert ids(read(PeopleTrackerSpec(mount=Mount(z=1.265)), scene_of([(0, 0), (3, 0)]))) == [0]


def test_misses_come_as_often_as_said() -> None:
    scene, spec = scene_of([(2, k) for k in range(-2, 3)]), PeopleTrackerSpec(miss=0.3)
    seen = [len(ids(read(spec, scene, tick=k))) for k in range(600)]
    n = 600 * 5
    assert sum(seen) / n == pytest.approx(0.7, abs=4 * math.sqrt(0.21 / n))


def test_noise_has_the_size_and_belongs_to_the_person() -> None:
    spec = PeopleTrackerSpec(position_noise=0.05, velocity_noise=0.2)
    alone = [read(spec, scene_of([(2, 0)]), tick=k)[0] for k in range(800)]
    error = np.array(alone)[:, 1:] - (2, 0, 0, 0)
    assert error.std(axis=0) == pytest.approx([0.05, 0.05, 0.2, 0.2], rel=0.1)
    assert np.abs(error.mean(axis=0)).max() < 4 * 0.2 / math.sqrt(800)
    far, near = scene_of([(2, 0), (8, 5)]), scene_of([(2, 0), (1, 1)])
    one, two = (read(spec, s) for s in (far, near))
    assert ids(one) == [0, 1]
    assert ids(two) == [1, 0]
    assert one[0].tolist() == two[1].tolist()


@pytest.mark.parametrize(
    "fields", [{"max_people": 0}, {"miss": 1.0}, {"view": 7.0}, {"range_max": 0.0}]
)
def test_refused(fields: dict[str, float]) -> None:
    with pytest.raises(ValidationError):
        PeopleTrackerSpec(**fields)  # type: ignore[arg-type]
