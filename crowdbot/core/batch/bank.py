"""A pool of worlds that are built once and reset, or given new draws of people."""

from __future__ import annotations

from collections import OrderedDict

from crowdbot.core.batch.array_tables import ScratchPool
from crowdbot.core.batch.blueprint import Blueprint
from crowdbot.core.batch.world import BatchWorld

#: Most worlds that are kept while no one steps them.
_MOST = 1024


class Bank:
    """A pool of worlds for one thread.

    Args:
        keep: True to keep worlds for reuse, because draws of people repeat.
    """

    def __init__(self, *, keep: bool) -> None:
        self._keep, self._pool = keep, ScratchPool()
        self._free: OrderedDict[tuple[int, int | None], list[BatchWorld]] = OrderedDict()

    def take(self, blueprint: Blueprint, root: int | None) -> BatchWorld:
        """Return a world with a given draw in its initial state, from the pool or new.

        Raises:
            InputError: the people do not fit, or a robot would start in a wall or a person.
            PluginError: a component cannot be built.
        """
        kept = self._free.get((id(blueprint), root))
        if not kept:
            return BatchWorld(blueprint, root, self._pool)
        world = kept.pop()
        world.reset()
        return world

    def give_back(self, world: BatchWorld) -> None:
        """Return a world that is no longer stepped to the pool."""
        if not self._keep:
            return
        key = id(world.blueprint), world.root
        self._free.setdefault(key, []).append(world)
        self._free.move_to_end(key)
        while sum(map(len, self._free.values())) > _MOST:
            self._free.popitem(last=False)
