"""No system binds a method of Drake under the name of a virtual one: that recurses without end."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from importlib.metadata import version
from typing import Any

import pytest
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import LeafSystem, System

from crowdbot.core.sim.block import Block
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES
from tests.paths import ROOT


def _bound_to_drake(kind: type) -> list[str]:
    """The attributes of a class that are methods of a class of Drake under another name."""
    drakes = {
        id(value): name
        for base in kind.__mro__
        if base.__module__.startswith("pydrake")
        for name, value in vars(base).items()
        if callable(value)
    }
    return [name for name, value in vars(kind).items() if drakes.get(id(value), name) != name]


def _drakes() -> Iterator[type]:
    """Our classes below one of Drake, from all modules that name it."""
    for path in sorted((ROOT / "crowdbot").rglob("*.py")):
        if "pydrake" not in path.read_text(encoding="utf-8") or "templates" in path.parts:
            continue
        name = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
        for kind in vars(importlib.import_module(name)).values():
            if isinstance(kind, type) and kind.__module__ == name and _of_drake(kind):
                yield kind


def _of_drake(kind: type) -> bool:
    return any(base.__module__.startswith("pydrake") for base in kind.__mro__)


def test_nothing_binds_a_method_of_drake_under_another_name() -> None:
    found = list(_drakes())
    assert sum(issubclass(kind, System) for kind in found) >= 10
    for kind in found:
        assert _bound_to_drake(kind) == [], kind


def test_the_check_sees_such_a_binding() -> None:
    bound = type("Bound", (LeafSystem,), {"DoGetWitnessFunctions": LeafSystem.GetWitnessFunctions})
    if not _bound_to_drake(bound):
        pytest.fail("a bound method of the base class goes unnoticed")


def test_every_system_is_a_block() -> None:
    systems = [kind for kind in _drakes() if issubclass(kind, System)]
    assert len(systems) >= 10
    assert [kind for kind in systems if not issubclass(kind, Block)] == []


class _Asked(Block):
    """Counts how often Drake looks for its witness functions, at 100 updates a second."""

    __slots__ = NO_ATTRIBUTES

    searches = 0

    def __init__(self) -> None:
        super().__init__()
        self.DeclareDiscreteState(1)
        self.DeclarePeriodicUnrestrictedUpdateEvent(0.01, 0.0, lambda _context, _state: None)

    def __getattribute__(self, name: str) -> Any:
        if name == "DoGetWitnessFunctions":
            _Asked.searches += 1
        return super().__getattribute__(name)


def test_drake_does_not_search_a_block_for_witness_functions_at_each_update() -> None:
    block = _Asked()
    assert block.GetWitnessFunctions(block.CreateDefaultContext()) == []
    Simulator(block).AdvanceTo(1.0)
    major, minor = map(int, version("drake").split(".")[:2])
    assert _Asked.searches < 10 or (major, minor) >= (1, 57)  # where a search takes 0.1 µs
