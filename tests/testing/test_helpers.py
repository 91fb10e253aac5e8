"""What authors get besides the checks: strategies, fixtures, tiny worlds; and at what price."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.registry.registry import Registry
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.plugin import Component
from crowdbot.testing.fixtures import expand_one, registry, run_directory, tiny_scenario
from crowdbot.testing.strategies import specs
from tests.testing.wrong import BUILT_IN

__all__ = ["expand_one", "registry", "run_directory", "tiny_scenario"]

ALL = [c for p in BUILT_IN.plugins for c in p.components]
SCENARIO = """
crowdbot: 1
scenario:
  id: mine
  environment:
    kind: corridor
    zones: {all: {x: [0 m, 50 m], y: [-5 m, 5 m]}, goal: {x: [8 m, 9 m], y: [-1 m, 1 m]}}
  robots.robot:
    model: {kind: turtlebot2}
    task: {start: [1 m, 0 m, 0 deg], goal: {zone: goal}}
"""


@pytest.mark.parametrize("component", ALL, ids=lambda c: c.kind)
def test_random_specs_are_valid_and_come_back(component: Component[Any]) -> None:
    @given(spec=specs(component, BUILT_IN))
    @settings(max_examples=5, derandomize=True, database=None)
    def holds(spec: Any) -> None:
        again = type(spec).model_validate(spec.model_dump(mode="json"))
        assert again == spec

    holds()


def test_random_specs_differ() -> None:
    found = set()

    @given(spec=specs(BUILT_IN.find("planner", "dwa"), BUILT_IN), _=st.integers())
    @settings(max_examples=30, derandomize=True, database=None)
    def gather(spec: Any, _: int) -> None:
        found.add(spec.model_dump_json())

    gather()
    assert len(found) > 10


def test_fixtures(
    registry: Registry, tiny_scenario: Scenario, expand_one: Callable[[str], Scenario]
) -> None:
    assert [p.name for p in registry.plugins] == ["builtin"]
    assert set(tiny_scenario.robots) == {"robot"}
    assert expand_one(SCENARIO).id == "mine"


def test_the_fixture_of_a_run(run_directory: Path) -> None:
    assert {"run.json", "scores.csv"} <= {f.name for f in run_directory.iterdir()}


@pytest.mark.slow
def test_the_list_of_checks_needs_neither_pytest_nor_hypothesis() -> None:
    code = (
        "import sys; sys.modules['pytest'] = sys.modules['hypothesis'] = None\n"
        "from crowdbot.core.registry.registry import discover\n"
        "from crowdbot.testing import checks_for\n"
        "r = discover(allow=(), entry_points=False)\n"
        "found = checks_for(r.find('noise', 'offset'), r)\n"
        "[check() for name, check in found]\n"
        "print(len(found), 'pydrake' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["14", "False"]
