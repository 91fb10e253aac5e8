"""What other people's components may get wrong: each is told with the kind's name, exit code 3."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.cli import main
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.sim.build_crowd import build_crowd
from tests.paths import ROOT

HOWTO = ROOT / "docs" / "howto" / "files"
PLUGIN = """
from typing import Literal
import numpy as np
from numba import njit
from crowdbot.plugin import Component
from crowdbot.core.crowd.velocity_search.cost import BASE, CompiledCost, NumpyCost
from crowdbot.plugin import EnvironmentParts, SensorInfo
from crowdbot.plugin import CostFunctionSpec, CrowdPolicySpec, EnvironmentSpec, SensorSpec
from crowdbot.plugin import hookimpl

class Cost(CostFunctionSpec):
    kind: Literal["odd.cost"] = "odd.cost"
    way: str = "fine"

class Policy(CrowdPolicySpec):
    kind: Literal["odd.policy"] = "odd.policy"
    way: str = "fine"

class Place(EnvironmentSpec):
    kind: Literal["odd.place"] = "odd.place"
    way: str = "fine"

class Look(SensorSpec):
    kind: Literal["odd.look"] = "odd.look"
    way: str = "fine"

@njit("float64(float64)")
def other(x):
    return x

COSTS = {
    "fine": lambda c, a, n: np.zeros(len(c)),
    "raises": lambda c, a, n: 1 / 0,
    "nan": lambda c, a, n: np.full(len(c), np.nan),
    "shape": lambda c, a, n: np.zeros((len(c), 2)),
}

def cost(spec):
    if spec.way == "compiled":
        return CompiledCost(base=other, prepare=other, excess=other,
                            params=np.array([1.0, 0.0]), weight=1.0)
    if spec.way == "plain":
        return CompiledCost(base=len, prepare=other, excess=other,
                            params=np.array([1.0, 0.0]), weight=1.0)
    if spec.way == "none":
        return None
    return NumpyCost(evaluate=COSTS[spec.way], range=2.0, weight=1.0)

class Walk:
    def __init__(self, way):
        self.way = way
    def velocities(self, view, dt):
        if self.way == "raises":
            raise KeyError("gait")
        if self.way == "nan":
            return np.full(view.position.shape, np.nan)
        if self.way == "shape":
            return np.zeros(3)
        return np.tile([0.5, 0.0], (len(view.position), 1))

class Push(Walk):
    velocities = None
    def accelerations(self, view):
        return Walk.velocities(self, view, view.dt)

def policy(spec, costs, agents):
    if spec.way == "none":
        return 3
    return Push(spec.way[5:]) if spec.way.startswith("push_") else Walk(spec.way)

def place(spec):
    if spec.way == "raises":
        raise RuntimeError("no bricks")
    walls = np.array([[0.0, 0.0, 9.0, 0.0]])
    rows = 2 if spec.way == "shape" else 1
    if spec.way == "nan":
        walls[0, 0] = np.nan
    zones = {n: np.array(z.polygon) for n, z in spec.zones.items()}
    if spec.way == "zone":
        zones["goal"] = zones["goal"][::-1]
    return EnvironmentParts(
        walls=walls, wall_heights=np.tile([0.0, 2.0], (rows, 1)),
        stops_robot=np.ones(1, bool), stops_crowd=np.ones(1, bool), zones=zones, portals={},
        pillars=np.array([[5.0, 3.0, 0.3]]), pillar_heights=np.array([[0.0, 2.0]]))

class Sees:
    def __init__(self, way):
        self.way = way
    def info(self):
        if self.way == "info_raises":
            raise OSError("unplugged")
        return SensorInfo(category="beam", frame="", mount=(0.0, 0.0, 0.3, 0.0),
                          rate=200.0 if self.way == "rate" else 10.0, shape=(1,),
                          ros_type="std_msgs/msg/Float64MultiArray", memory=2, random=False
                          ) if self.way == "frame" else SensorInfo(
                          category="beam", frame="beam", mount=(0.0, 0.0, 0.3, 0.0),
                          rate=200.0 if self.way == "rate" else 10.0, shape=(1,),
                          ros_type="std_msgs/msg/Float64MultiArray", memory=2, random=False)
    def read(self, scene, pose, t, rng, memory):
        memory[0] += 1.0
        if self.way == "raises":
            raise ValueError("fog")
        if self.way == "shape":
            return np.zeros(4)
        if self.way == "nan":
            return np.array([np.nan])
        ahead = np.array([[np.cos(pose.yaw), np.sin(pose.yaw), 0.0]])
        found = scene.cast(np.array([[pose.x, pose.y, 0.3]]), ahead, 30.0)
        return found[0]

def look(spec, context):
    return Sees(spec.way)

def _all(category, spec, name):
    return Component(spec=spec, build=f"odd:{name}", summary=f"an odd {category}")

@hookimpl
def crowdbot_components():
    return {
        "cost function": [_all("cost", Cost, "cost")],
        "crowd policy": [_all("policy", Policy, "policy")],
        "environment": [_all("place", Place, "place")],
        "sensor": [_all("sensor", Look, "look")],
    }
"""
SUITE = """\
crowdbot: 1
suite: {id: odd, title: Odd things, seed: 1}
base:
  environment:
    kind: odd.place
    zones: {all: {x: [0 m, 9 m], y: [0 m, 6 m]}, goal: {x: [2 m, 3 m], y: [0 m, 6 m]}}
  robots.robot:
    model: {kind: turtlebot2}
    control: kinematic
    sensors: {odometry: {kind: wheel_odometry}, beam: {kind: odd.look}}
    task: {start: [1.7 m, 3 m, 0 deg], goal: {zone: goal}, time_limit: 5 s}
  crowd:
    agents:
      - {id: 0, x: 5 m, y: 1 m, goals: [[8 m, 1 m]], at_goal: stop, speed: 1 m/s}
      - {id: 1, x: 8 m, y: 5 m, goals: [[5 m, 5 m]], at_goal: stop, speed: 1 m/s}
    policy: {kind: velocity_space}
    costs: {odd: {kind: odd.cost}, rvo: {kind: rvo}}
matrix:
  one: {only: {}}
"""


@pytest.fixture
def odd(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    monkeypatch.chdir(tmp_path)
    Path("odd.py").write_text(PLUGIN)
    Path("odd.yaml").write_text(SUITE)
    yield ["simulate", "odd.yaml", "only", "--planner", "goal_seek", "--out", "runs",
           "--no-references", "--record", "all", "--plugin", "odd.py"]  # fmt: skip
    sys.modules.pop("odd", None)


def test_components_of_others_run(odd: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    for policy in ("velocity_space", "odd.policy"):
        assert main([*odd, "--force", "--set", f"crowd.policy={{kind: {policy}}}"]) == 0
    assert main([*odd, "--force", "--set", "crowd.policy={kind: odd.policy, way: push_fine}"]) == 0
    assert capsys.readouterr().out.count("arrived after") == 3


WRONG = [
    (
        "crowd.costs.odd.way=raises",
        "odd.cost' (odd.py): evaluate: ZeroDivisionError: division by zero",
    ),
    ("crowd.costs.odd.way=nan", "odd.cost' (odd.py): evaluate returned NaN"),
    ("crowd.costs.odd.way=shape", "odd.cost' (odd.py): evaluate returned shape"),
    ("crowd.costs.odd.way=compiled", "odd.cost' (odd.py): base is compiled for"),
    ("crowd.costs.odd.way=plain", "odd.cost' (odd.py): base is not compiled"),
    ("crowd.costs.odd.way=none", "odd.cost' (odd.py): build returned a NoneType"),
    (
        "crowd.policy={kind: odd.policy, way: raises}",
        "odd.policy' (odd.py): decision at t = 0 s: KeyError: 'gait'",
    ),
    (
        "crowd.policy={kind: odd.policy, way: nan}",
        "odd.policy' (odd.py): returned [nan, nan] for agent 0",
    ),
    ("crowd.policy={kind: odd.policy, way: shape}", "odd.policy' (odd.py): returned shape (3,)"),
    ("crowd.policy={kind: odd.policy, way: push_nan}", "odd.policy' (odd.py): returned [nan, nan]"),
    ("crowd.policy={kind: odd.policy, way: none}", "odd.policy' (odd.py): build returned a int"),
    ("environment.way=raises", "'odd.place' (odd.py): cannot be built: RuntimeError: no bricks"),
    ("environment.way=shape", "odd.place' (odd.py): wall_heights must be a float64 array (1, 2)"),
    ("environment.way=nan", "odd.place' (odd.py): walls must be finite"),
    ("environment.way=zone", "zone 'goal': its corners must run counter-clockwise"),
    ("robots.robot.sensors.beam.way=rate", "odd.look' (odd.py): info(): rate is 200.0 Hz"),
    ("robots.robot.sensors.beam.way=frame", "odd.look' (odd.py): info(): frame is ''"),
    ("robots.robot.sensors.beam.way=info_raises", "odd.look' (odd.py): info: OSError: unplugged"),
    (
        "robots.robot.sensors.beam.way=raises",
        "odd.look' (odd.py): read at t = 0 s: ValueError: fog",
    ),
    (
        "robots.robot.sensors.beam.way=shape",
        "odd.look' (odd.py): read returned shape (4,); info() says (1,)",
    ),
    ("robots.robot.sensors.beam.way=nan", "odd.look' (odd.py): read returned NaN"),
]


@pytest.mark.parametrize(("change", "message"), WRONG, ids=[c for c, _ in WRONG])
def test_what_is_wrong_is_told(
    change: str, message: str, odd: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*odd, "--set", change]) == 3
    output = " ".join(capsys.readouterr().err.replace("\n", " ").split())
    assert message in output, output
    assert "Traceback" not in output


@pytest.mark.parametrize("method", ["sampling", "gradient", "global"])
def test_costs_of_the_howto_agree_in_every_method(method: str) -> None:
    """The numpy one and the compiled one walk the same way."""
    registry: Registry = discover(extra=[HOWTO / "my_costs"])
    overrides = (f"crowd.policy.method={method}",)
    found: list[Any] = []
    for scenario in open_spec(str(HOWTO / "my_costs.yaml"), registry, overrides).scenarios:
        parts = build_environment(registry, scenario.environment)
        engine = build_crowd(scenario, realise(scenario), parts, registry)
        assert engine is not None
        found.append(engine.run(3.0)[1])
    assert found[0] == pytest.approx(found[1], abs=1e-9)
    assert np.ptp(found[0][:, 0, 0]) > 1.0
