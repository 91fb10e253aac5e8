"""Sensors, policies and metrics that fail in a run: a message that names them, never ours."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from crowdbot.core.recording.recording import Recording
from tests.cli.simulate_cases import Shell

pytestmark = pytest.mark.slow

PLUGIN = '''
import sys
from typing import Literal
import numpy as np
from crowdbot.plugin import Component
from crowdbot.plugin import ScoreFactory, SensorInfo
from crowdbot.plugin import CrowdPolicySpec, MetricSpec, SensorSpec, declare_metric
from crowdbot.plugin import hookimpl

class SensorWords(SensorSpec):
    """A sensor."""
    kind: Literal["faulty.sensor"] = "faulty.sensor"

class PolicyWords(CrowdPolicySpec):
    """A policy."""
    kind: Literal["faulty.policy"] = "faulty.policy"

class MetricWords(MetricSpec):
    """A metric."""
    kind: Literal["faulty.metric"] = "faulty.metric"

METRIC = declare_metric(MetricWords, build="faulty:Metric", symbol="F", unit="m", better="lower",
                        category="task", card="# faulty.metric\\n")

class Sensor:
    def __init__(self, spec, context):
        {init}
    def info(self):
        return SensorInfo(category="s", frame="s", mount=(0, 0, 0, 0), rate=16.0, shape=(1,),
                          ros_type="std_msgs/msg/Float64MultiArray", random=False)
    def read(self, scene, pose, t, rng):
        {read}

class Policy:
    def __init__(self, spec, costs, agents):
        pass
    def velocities(self, view, dt):
        {velocities}

class Metric:
    def __init__(self, spec):
        pass
    def score(self, run, refs):
        {score}

@hookimpl
def crowdbot_components():
    return {{
        "sensor": [Component(spec=SensorWords, build="faulty:Sensor", summary="s")],
        "crowd policy": [Component(spec=PolicyWords, build="faulty:Policy", summary="p")],
        "metric": [METRIC],
    }}
'''
FINE = {
    "init": "pass",
    "read": "return np.zeros(1)",
    "velocities": "return view.velocity.copy()",
    "score": "print('hello'); return [ScoreFactory(METRIC).ok('corrected', 1.0)]",
}
FAILING = {
    "sensor cannot be built": ("init", "raise ValueError('no')", "sensor 'faulty.sensor' ("),
    "sensor raises": ("read", "raise ValueError('no')", "read at t = 0 s: ValueError: no ("),
    "sensor leaves": ("read", "sys.exit(0)", "read at t = 0 s: SystemExit: 0"),
    "reading too long": ("read", "return np.zeros(3)", "): read returned shape (3,); info"),
    "reading without end": ("read", "return type('E', (list,), {'__iter__': iter})((0.0,))",
        "TypeError: a E where an array of numbers is wanted"),
    "policy is complex": ("velocities", "return view.velocity * 1j", "not one of real numbers"),
    "policy overflows": ("velocities", "return view.velocity + 1e308", "): returned [1e+308, 1e"),
    "metric without end": ("score", "import itertools; return itertools.repeat(1.0)",
        "returned 1.0 instead of its own scores"),
    "metric hides": ("score",
        "return [ScoreFactory(METRIC).undefined('corrected', chr(27))]", "character U+001B"),
    "policy raises": ("velocities", "raise ValueError('no')",
        "decision at t = 0 s: ValueError: no ("),
    "policy is nan": ("velocities", "return view.velocity * np.nan",
        "): returned [nan, nan] for agent "),
    "metric raises": ("score", "1 / 0", "): score: ZeroDivisionError: division by zero ("),
    "metric leaves": ("score", "sys.exit(0)", "SystemExit: 0"),
    "metric is nan": ("score", "return [ScoreFactory(METRIC).ok('corrected', np.nan)]",
        "nan must not escape"),
    "metric is empty": ("score", "return []", "variants none; declared are corrected"),
    "metric is nothing": ("score", "return None", "returned None; a list of scores is wanted"),
    "metric is not a score": ("score", "return [3.0]", "returned 3.0 instead of its own scores"),
}  # fmt: skip
SETTINGS = (
    "robots.robot.sensors.x={kind: faulty.sensor}",
    "crowd.policy={kind: faulty.policy}",
    "crowd.costs={}",
)


@pytest.fixture(autouse=True)
def _forget() -> Iterator[None]:
    yield
    sys.modules.pop("faulty", None)


def options(folder: Path, **code: str) -> list[str]:
    path = folder / "faulty.py"
    path.write_text(PLUGIN.format(**{**FINE, **code}), encoding="utf-8")
    changes = [word for setting in SETTINGS for word in ("--set", setting)]
    return ["--plugin", str(path), "--planner", "goal_seek", "--no-references", "--record", "all",
            *changes]  # fmt: skip


@pytest.mark.parametrize("case", FAILING)
def test_the_message_names_the_component(case: str, shell: Shell, tmp_path: Path) -> None:
    place, code, text = FAILING[case]
    answer = shell(*options(tmp_path, **{place: code}), "--json")
    assert answer.code == 3
    assert text in answer.err
    assert answer.out == ""
    assert shell.runs() == []
    if place == "score":
        (partial,) = shell.out.rglob("*.partial")
        assert f"what was recorded: {partial}" in answer.err
        assert Recording(partial / "run.mcap").trajectories().t[-1] == 1.0


def test_without_faults_it_runs_and_prints_of_metrics_keep_off_stdout(
    shell: Shell, tmp_path: Path
) -> None:
    answer = shell(*options(tmp_path), "--json")
    assert answer.code == 0
    assert "faulty.metric" in {s["metric"] for s in answer.json["scores"]}
    assert "hello" in answer.err
