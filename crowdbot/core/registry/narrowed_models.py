"""Classes narrowed to the installed components: shared, and found again when they are unpickled.

They are made when a registry is, so that no module has them. A pickled object holds the arguments
of `discover` instead, and its class's name; another process discovers the same plugins first.
"""

from __future__ import annotations

import pickle
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pydantic import BaseModel

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry, RegistrySource
    from crowdbot.dsl.spec.spec import ComponentSpec

Specs = tuple[tuple[str, type["ComponentSpec"]], ...]
#: Paths of plugins that are not installed, the allow-list, whether entry points are read.
Whereabouts = tuple[tuple[str, ...], tuple[str, ...] | None, bool]
Model = TypeVar("Model", bound=BaseModel)


class Models(dict[str, type[BaseModel]]):
    """The classes of equal registries by name, and how another process discovers one of them."""

    source: RegistrySource | None = None

    def keep(self, model: type[Model], name: str) -> type[Model]:
        """Keep a class under a name; its objects can be pickled."""

        def reduce(one: BaseModel) -> tuple[Any, ...]:
            if type(one) is not model:
                return tuple(object.__reduce_ex__(one, 2))
            return _blank, (whereabouts(self.source), name), one.__getstate__()

        model.__reduce__ = reduce  # type: ignore[method-assign, assignment]
        self[name] = model
        return model


#: Specs by category -> their classes, latest last. Building them takes pydantic a fifth of a
#: second, and repeated discovery finds the same specs.
_shared: dict[Specs, Models] = {}
_KEPT = 8


def models_of(specs: Specs, source: RegistrySource | None) -> Models:
    """Return the classes so far for some specs by category; to be added to.

    Args:
        specs: category and class of each component's spec.
        source: arguments of `discover` that find them; None if they were not discovered.
    """
    if specs not in _shared:
        if len(_shared) == _KEPT:
            del _shared[next(iter(_shared))]
        _shared[specs] = Models()
    models = _shared[specs]
    models.source = models.source or source
    return models


def whereabouts(source: RegistrySource | None) -> Whereabouts:
    """Return what another process needs to find the components of a registry.

    Raises:
        PicklingError: it was put together by hand.
    """
    if source is None:
        raise pickle.PicklingError(
            "components of plugins that were not discovered cannot be found by another process"
        )
    return tuple(map(str, source.extra)), source.allow, source.entry_points


def _blank(where: Whereabouts, name: str) -> BaseModel:
    """Return an object without fields, which unpickling fills in."""
    model = registry_of(where).narrowed(name)
    return model.__new__(model)


@cache
def registry_of(where: Whereabouts) -> Registry:
    """Return the registry that another process had, discovered once per process."""
    from crowdbot.core.registry.registry import discover

    discovering: Callable[..., Registry] = discover
    extra, allow, entry_points = where
    return discovering(extra=[Path(p) for p in extra], allow=allow, entry_points=entry_points)
