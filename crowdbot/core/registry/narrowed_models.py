"""Classes narrowed to the installed components, and their pickling.

They are created at run time with a registry, so no module has them. A pickled object holds the
arguments of `discover` and its class's name instead; another process discovers the same plugins
first.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar
from weakref import WeakValueDictionary

from pydantic import BaseModel

from crowdbot.core.registry.registry_source import RegistrySource, Whereabouts, whereabouts

if TYPE_CHECKING:
    from crowdbot.dsl.spec.spec import ComponentSpec

Specs = tuple[tuple[str, type["ComponentSpec"]], ...]
#: Returns an object without fields of the class with a name, which unpickling fills in.
Blank = Callable[[Whereabouts, str], BaseModel]
Model = TypeVar("Model", bound=BaseModel)


class Models(dict[str, type[BaseModel]]):
    """The classes of equal registries by name, and how another process discovers one of them."""

    source: RegistrySource | None = None

    def __init__(self, blank: Blank) -> None:
        """Build it empty; ``blank`` has to be a function of a module."""
        super().__init__()
        self._blank = blank

    def keep(self, model: type[Model], name: str) -> type[Model]:
        """Keep a class under a name; its objects can be pickled."""

        def reduce(one: BaseModel) -> tuple[Any, ...]:
            if type(one) is not model:
                return tuple(object.__reduce_ex__(one, 2))
            return self._blank, (whereabouts(self.source), name), one.__getstate__()

        model.__reduce__ = reduce  # type: ignore[method-assign, assignment]
        self[name] = model
        return model


#: Specs by category -> their classes, as long as a registry has them: objects that are unpickled
#: are of the same classes as those that were pickled.
_shared: WeakValueDictionary[Specs, Models] = WeakValueDictionary()
#: The latest ones, which stay: building them takes pydantic a fifth of a second, and repeated
#: discovery finds the same specs.
_latest: deque[Models] = deque(maxlen=8)


def models_of(specs: Specs, source: RegistrySource | None, blank: Blank) -> Models:
    """Return the classes created so far for some specs; new ones are added to it.

    Args:
        specs: category and class of each component's spec.
        source: arguments of `discover` that find them; None if they were not discovered.
        blank: as in `Models`.
    """
    models = _shared.get(specs)
    if models is None:
        models = _shared[specs] = Models(blank)
        _latest.append(models)
    models.source = models.source or source
    return models
