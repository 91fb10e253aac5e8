"""What the simulator asks of our blocks after each unrestricted update costs no search."""

from __future__ import annotations

import importlib
import pkgutil
from typing import Any

from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, DiagramBuilder, LeafSystem, State

import crowdbot.core.sim
from crowdbot.core.sim.block import Block
from crowdbot.core.support.ticks import TICK


class _Watched:
    """Counts searches for witness functions that are not there; changes nothing at every tick."""

    def __init__(self) -> None:
        super().__init__()
        self.searches = self.ticks = 0
        self.DeclarePeriodicUnrestrictedUpdateEvent(TICK, 0.0, self._update)

    def _update(self, context: Context, state: State) -> None:
        del context, state
        self.ticks += 1

    def __getattr__(self, name: str) -> Any:
        if name == "DoGetWitnessFunctions":
            self.searches += 1
        raise AttributeError(name)


def _watched(base: type) -> Any:
    """A system, advanced by seven ticks."""
    builder = DiagramBuilder()
    system: Any = builder.AddSystem(type("Watched", (_Watched, base), {})())
    Simulator(builder.Build()).AdvanceTo(7.0 * TICK)
    assert system.ticks == 7
    return system


def test_a_block_is_not_searched_for_witness_functions() -> None:
    assert _watched(Block).searches == 0
    assert _watched(LeafSystem).searches >= 7  # or Drake has no need of `Block` any more


def test_all_systems_are_blocks() -> None:
    package = crowdbot.core.sim
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        importlib.import_module(module.name)
    ours = [k for k in LeafSystem.__subclasses__() if k.__module__.startswith(package.__name__)]
    assert ours == [Block]
