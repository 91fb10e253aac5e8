"""What the replay page says stands there, from the parts of an environment."""

from __future__ import annotations

import numpy as np

from crowdbot.core.environments.build import build_environment
from crowdbot.core.registry.registry import discover
from crowdbot.core.runs.replayed import scenery
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.types.environment import EnvironmentParts
from tests.paths import ROOT


def world(name: str) -> EnvironmentParts:
    registry = discover(entry_points=False)
    spec = ROOT / "scenario_specs" / "examples" / f"world_{name}.yaml"
    return build_environment(registry, pick(open_spec(str(spec), registry), None).environment)


def test_sides_of_blocks_are_no_walls_for_people() -> None:
    parts = world("shed")
    assert np.count_nonzero(parts.sides()) == 16
    shown = scenery(parts, height=0.42)
    assert (len(shown.blocks), len(shown.steps)) == (4, 0)
    assert len(shown.walls) == len(parts.walls) - 16
    assert np.count_nonzero(~shown.stops_robot) == 1  # the far end of the walkway
    assert len(scenery(parts, height=0.2).blocks) == 2  # it drives under the gate


def test_people_step_over_kerbs() -> None:
    parts = world("street")
    shown = scenery(parts, height=0.42)
    kerbs = np.count_nonzero(~parts.solids_stop_crowd)
    assert len(shown.steps) == kerbs > 0
    assert len(shown.blocks) == len(parts.solids) - kerbs > 0
