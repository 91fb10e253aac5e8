"""No system binds a method of Drake under the name of a virtual one: that recurses without end."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator

import pytest
from pydrake.systems.framework import LeafSystem, System

import crowdbot.core.sim


def _systems(base: type = LeafSystem) -> Iterator[type]:
    subclasses: list[type] = base.__subclasses__()
    for subclass in subclasses:
        if subclass.__module__.startswith("crowdbot."):
            yield subclass
            yield from _systems(subclass)


def _bound_to_drake(system: type) -> list[str]:
    """The ``Do…`` attributes of a system that are methods of Drake instead of its own functions."""
    drakes = {id(value) for base in System.__mro__ for value in vars(base).values()}
    drakes |= {id(value) for value in vars(LeafSystem).values()}
    return [name for name, value in vars(system).items() if id(value) in drakes]


def test_no_system_binds_a_method_of_drake_under_another_name() -> None:
    package = crowdbot.core.sim
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        importlib.import_module(module.name)
    systems = list(_systems())
    assert len(systems) >= 10
    for system in systems:
        assert _bound_to_drake(system) == [], system


def test_the_check_sees_such_a_binding() -> None:
    bound = type("Bound", (LeafSystem,), {"DoGetWitnessFunctions": LeafSystem.GetWitnessFunctions})
    if not _bound_to_drake(bound):
        pytest.fail("a bound method of the base class goes unnoticed")
