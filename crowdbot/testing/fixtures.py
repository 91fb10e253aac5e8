"""Fixtures for tests of plugins: ``pytest_plugins = ("crowdbot.testing.fixtures",)``. Needs pytest.

They use crowdbot's own components only; `crowdbot.testing.around.around` adds one.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import crowdbot.testing.tiny as tiny
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.scenario.scenario import Scenario


@pytest.fixture(scope="session")
def registry() -> Registry:
    """Return the registry with crowdbot's own components only."""
    return discover(allow=(), entry_points=False)


@pytest.fixture(scope="session")
def tiny_scenario(registry: Registry) -> Scenario:
    """Return a robot that has to cross an empty room, for a second."""
    return tiny.tiny_scenario(registry)


@pytest.fixture
def expand_one(registry: Registry, tmp_path: Path) -> Callable[[str], Scenario]:
    """Return a function that builds a scenario from a document with a single one."""

    def expand(text: str) -> Scenario:
        file = tmp_path / "one.yaml"
        file.write_text(text, encoding="utf-8")
        (scenario,) = open_spec(str(file), registry).scenarios
        return scenario

    return expand


@pytest.fixture(scope="session")
def run_directory(
    registry: Registry, tiny_scenario: Scenario, tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """Return a complete run of the tiny scenario, with its recording and scores."""
    from crowdbot.core.sim.simulate import simulate

    out = tmp_path_factory.mktemp("runs")
    run = simulate(
        tiny_scenario, registry, planner="goal_seek", out=out, options=RunOptions(references=False)
    )
    return run.directory
