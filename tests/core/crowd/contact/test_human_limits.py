"""Legs of people stay within the limits that every packaged crowd states, beside a robot, too."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import crowdbot
from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.scenarios.named_crowds import crowd_parts
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.errors import SpecError

TICKS = 128
registry: Registry = discover(allow=())
NAMES = sorted(crowd_parts(registry))
#: Limits of any packaged crowd: a run, and the first step of a sprint.
FASTEST, HARDEST = 3.0, 5.0
SCENARIO = """\
crowdbot: 1
scenario:
  id: limits
  extends: [speeds.yaml, "builtin:parts/crowds/{name}.yaml"]
  environment:
    kind: corridor
    length: 26 m
    width: 6 m
    pillars: {{a: {{x: 9 m, y: -1 m, radius: 0.4 m}}, b: {{x: 15 m, y: 1.2 m, radius: 0.4 m}}}}
    zones: {{crowd: {{x: [4 m, 24 m], y: [-3 m, 3 m]}}}}
    portals:
      a: {{x: [-1 m, 0 m], y: [-3 m, 3 m]}}
      b: {{x: [26 m, 27 m], y: [-3 m, 3 m]}}
  crowd:
    flow: {{direction: both, density: 0.3 1/m^2, area: crowd}}
"""
#: Of people in corridors, where a crowd has none of its own.
SPEEDS = "crowd.speed: {mean: 1.34 m/s, std: 0.26 m/s}\n"


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_no_leg_does_more_than_its_crowd_states(name: str, tmp_path: Path) -> None:
    (tmp_path / "speeds.yaml").write_text(SPEEDS, encoding="utf-8")
    (tmp_path / "limits.yaml").write_text(SCENARIO.format(name=name), encoding="utf-8")
    scenario = crowdbot.load(tmp_path / "limits.yaml", "limits")
    crowd = scenario.crowd
    assert crowd is not None
    body = crowd.body
    assert body.max_speed <= FASTEST
    assert body.max_acceleration <= HARDEST
    parts = build_environment(registry, scenario.environment)
    engine = build_crowd(scenario, realise(scenario, parts), parts, registry)
    assert engine is not None
    flat = engine.initial_state()
    robot = np.array([[1.0, 0.0, 0.65, 0.0, 0.178, 0.428, 0.0, 0.0]])
    hardest = braced = 0.0
    for _ in range(8 * TICKS):
        before = s.view(flat)[1].copy()
        engine.advance(flat, robot)
        robot[0, 0] += 0.65 / TICKS
        rows = s.view(flat)[1]
        here = (rows[:, s.WAITING] == s.PRESENT) & (before[:, s.WAITING] == s.PRESENT)
        here &= rows[:, s.JUMPS] == before[:, s.JUMPS]
        wanted = np.hypot(rows[here, s.AX], rows[here, s.AY])
        hardest = max(hardest, float(wanted.max()))
        free = here & (rows[:, s.PUSH_X] == 0.0) & (rows[:, s.PUSH_Y] == 0.0)
        free &= np.hypot(before[:, s.X] - robot[0, 0], before[:, s.Y] - robot[0, 1]) > 0.6
        gained = rows[free, s.VX : s.VY + 1] - before[free, s.VX : s.VY + 1]
        slow = np.hypot(before[free, s.VX], before[free, s.VY]) < body.max_speed
        braced = max(braced, float(np.hypot(*gained[slow].T).max(initial=0.0)) * TICKS)
        assert np.hypot(rows[free, s.VX], rows[free, s.VY])[slow].max() <= body.max_speed + 1e-9
    assert 1.0 < hardest <= body.max_acceleration + 1e-9
    assert braced <= body.max_acceleration + 1e-6


def test_more_damping_than_a_step_can_take_is_refused(tmp_path: Path) -> None:
    (tmp_path / "speeds.yaml").write_text(SPEEDS, encoding="utf-8")
    text = SCENARIO.format(name="orca")
    for value, fits in (("1 s/m", True), ("1.1 s/m", False)):
        (tmp_path / "limits.yaml").write_text(f"{text}  contact.dissipation: {value}\n")
        if fits:
            assert crowdbot.load(tmp_path / "limits.yaml", "limits").contact.dissipation == 1.0
        else:
            with pytest.raises(
                SpecError, match=r"contact\.dissipation: must be less than or equal to 1,"
            ):
                crowdbot.load(tmp_path / "limits.yaml", "limits")
