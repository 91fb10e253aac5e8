"""Block: the base class of our systems in the diagram; none has witness functions.

Drake asks each system for its witness functions after each unrestricted update. The bindings of
Drake 1.51 (pybind11) then search the Python class for an overriding method, in vain: 4 % of a run's
time in the simulator. They give up for good where they find a compiled function, which cannot
override anything. Those of Drake 1.57 and newer search ten times as fast, and would call it.
"""

from __future__ import annotations

from collections.abc import Callable

from pydrake.systems.framework import LeafSystem

from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES


class Block(LeafSystem):
    """A system of the diagram."""

    __slots__ = NO_ATTRIBUTES


def _would_be_called(function: Callable[..., object]) -> bool:
    """Return True if Drake calls a function that stands for a system's witness functions."""
    names = {"__slots__": NO_ATTRIBUTES, "DoGetWitnessFunctions": function}
    system = type("Probe", (LeafSystem,), names)()
    try:
        return bool(system.GetWitnessFunctions(system.CreateDefaultContext()) != [])
    except TypeError:  # what it returned is not a list
        return True


# Compiled, and harmless if it is called: returns None. Never one of Drake's own methods, which
# would call itself without end (docs/decisions/0004).
_compiled = {}.get  # type: ignore[var-annotated]
if not _would_be_called(_compiled):
    Block.DoGetWitnessFunctions = _compiled
