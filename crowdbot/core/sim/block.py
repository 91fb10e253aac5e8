"""Block: what each of our systems in a diagram is."""

from __future__ import annotations

from pydrake.systems.framework import LeafSystem

from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES


class Block(LeafSystem):
    """A system of Drake, written in Python, without witness functions.

    After each unrestricted update, that is at every tick, the simulator asks all systems for
    witness functions. Drake's bindings then look for a method of this name, which their own base
    class lacks, and a name that is not there is searched for through all classes, reported as an
    exception, and searched for again at the next tick. Found in compiled code, it is taken for
    Drake's own and never looked for again (docs/decisions/0004).
    """

    __slots__ = NO_ATTRIBUTES

    DoGetWitnessFunctions = LeafSystem.GetWitnessFunctions
