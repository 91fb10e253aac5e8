"""A run that is over leaves nothing in memory: a campaign makes hundreds in one process."""

from __future__ import annotations

import gc
import importlib
import pkgutil
from pathlib import Path

import pytest
from pydrake.systems.framework import Diagram, DiagramBuilder, LeafSystem

import crowdbot.core.sim
from crowdbot.core.planning.given_planner import choose_planner
from crowdbot.core.runs.identity import prepare, references_of
from crowdbot.core.runs.run import Request
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.sim.references import make_reference
from crowdbot.core.sim.simulate import simulate
from crowdbot.core.sim.weak_callback import weak_callback
from crowdbot.dsl.suite.suite_entry import SuiteEntry
from crowdbot.testing.tiny import tiny_scenario
from tests.core.sim import fleets
from tests.core.sim.sim_worlds import registry, scenario

_MODES = ("differential_drive", "force", "kinematic")
_HELD = (Diagram, DiagramBuilder, LeafSystem)

QUICK = RunOptions(references=False, replay=False)


def _systems() -> list[type]:
    """Our blocks, wherever they are written."""
    package = crowdbot.core.sim
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        importlib.import_module(module.name)
    found, todo = [], [LeafSystem]
    while todo:
        todo += (below := todo.pop().__subclasses__())
        found += [kind for kind in below if kind.__module__.startswith(package.__name__)]
    return found


def test_no_system_has_a_second_dictionary() -> None:
    kinds = _systems()
    assert len(kinds) > 6
    assert [kind.__name__ for kind in kinds if "__slots__" not in vars(kind)] == []


def test_a_weak_callback_calls_and_lets_go() -> None:
    class Thing:
        def double(self, x: int) -> int:
            return 2 * x

    thing = Thing()
    call = weak_callback(thing.double)
    assert call(3) == 6
    del thing
    with pytest.raises(AssertionError):
        call(3)


@pytest.mark.slow
@pytest.mark.parametrize("mode", _MODES)
def test_a_finished_run_is_thrown_away(mode: str, tmp_path: Path) -> None:
    before = _alive()
    world = tiny_scenario(registry(), control=mode, time_limit=0.125)
    simulate(world, registry(), planner="goal_seek", out=tmp_path, options=QUICK)
    assert _alive() - before == set()


@pytest.mark.slow
def test_so_is_a_run_of_several_robots(tmp_path: Path) -> None:
    two = {"a": fleets.robot(-6, 0, 0, "east", 0.125), "b": fleets.robot(6, 0, 180, "west", 0.125)}
    before = _alive()
    fleets.run(fleets.scenario(tmp_path, registry(), two, fleets.PEOPLE), registry(), tmp_path)
    assert _alive() - before == set()


@pytest.mark.slow
def test_so_is_a_run_for_comparison(tmp_path: Path) -> None:
    """A campaign's worker makes these by themselves."""
    before = _alive()
    world = scenario("robots.robot.task.time_limit=0.125")
    choice = choose_planner("goal_seek", registry())
    request = Request(
        scenario=world,
        choice=choice,
        registry=registry(),
        seed=0,
        out=tmp_path,
        entry=SuiteEntry(suite="tiny"),
    )
    prepared = prepare(world, registry())
    made = [make_reference(request, one) for one in references_of(request, prepared)]
    assert made
    assert _alive() - before == set()


def _alive() -> set[int]:
    return {id(one) for one in gc.get_objects() if issubclass(type(one), _HELD)}
