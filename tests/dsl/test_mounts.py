"""Mounts with roll and pitch in documents: level ones have the hashes that they had."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.robots.build import build_model
from crowdbot.core.robots.urdf_export import to_urdf
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.sensing.build import build_sensor
from crowdbot.core.view.build import _sectors
from crowdbot.core.view.map_content import _sector
from crowdbot.dsl.identity.canonical import canonical_bytes, content_hash, dump_scenario_yaml
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import SpecError
from crowdbot.testing.sensor_scenes import context

REGISTRY = discover(allow=())
LIDAR = "robots.robot.sensors.front_lidar.mount"


def scenario(*overrides: str) -> Scenario:
    return open_spec("challenge-2020", REGISTRY, overrides).scenarios[0]


def test_level_is_not_in_the_hash() -> None:
    plain = canonical_bytes(scenario(), {})
    assert b"pitch" not in plain
    assert canonical_bytes(scenario(f"{LIDAR}.pitch=0 deg", f"{LIDAR}.roll=-0.0"), {}) == plain


def test_a_tilt_changes_the_hash_and_reads_back(tmp_path: Path) -> None:
    found = {content_hash(scenario(), {})}
    for change in (f"{LIDAR}.pitch=10 deg", f"{LIDAR}.roll=10 deg"):
        changed = scenario(change)
        found.add(content_hash(changed, {}))
        path = tmp_path / "again.yaml"
        path.write_text(dump_scenario_yaml(changed))
        again = open_spec(str(path), REGISTRY).scenarios[0]
        assert content_hash(again, {}) == content_hash(changed, {})
    assert len(found) == 3


@pytest.mark.parametrize("kind", ["bumper", "contact_force", "people_tracker"])
def test_sensors_without_a_tilt_refuse_it_where_it_stands(kind: str) -> None:
    sensor = f"robots.robot.sensors.it={{kind: {kind}, mount: {{z: 0.1, pitch: 0.2}}}}"
    with pytest.raises(SpecError) as error:
        scenario(sensor)
    (found,) = error.value.diagnostics
    assert found.code == "E102"
    assert found.message == "unknown field 'pitch' in robots.robot.sensors.it.mount"
    assert "no tilt" in found.hint
    assert sensor[found.mark.column :].startswith("pitch")


def test_urdf_and_map_know_it() -> None:
    """20 degrees down from 0.25 m and the base's 0.01 m: the floor is at 0.72 m."""
    robot = scenario(f"{LIDAR}.pitch=20 deg").robots["robot"]
    model = build_model(REGISTRY, robot.model)
    infos = {n: build_sensor(REGISTRY, s, context()).info() for n, s in robot.sensors.items()}
    assert 'rpy="0 0.349065850399 0"' in to_urdf(model, infos, "r")
    sectors = {s.name: s for s in _sectors(robot, 0.0, 0.0, 0.0, model.base_height)}
    front = sectors["front_lidar"]
    assert front.height is not None
    far = front.height / math.tan(math.radians(20.0))
    assert max(x for x, _ in _sector(front)) == pytest.approx(front.x + far, rel=1e-3)
    rear = sectors["rear_lidar"]
    assert min(x for x, _ in _sector(rear)) == pytest.approx(rear.x - rear.reach, rel=1e-3)
