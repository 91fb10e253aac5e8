"""A plugin's components by category, each found when its category is first requested."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any, overload

from crowdbot.core.registry.component_data import data_digest
from crowdbot.core.registry.plugin_errors import is_user_interrupt
from crowdbot.dsl.spec.component import Component
from crowdbot.errors import CrowdbotError

Components = tuple[Component[Any], ...]


class ComponentList(Sequence[Component[Any]]):
    """All components, ordered by category, loaded on demand.

    Commands that only read scenarios never load planners and metrics, the largest categories.

    Attributes:
        errors: category -> why its components could not be loaded when they were requested.

    Args:
        later: category -> function that finds its components, called once.
    """

    def __init__(self, later: Mapping[str, Callable[[], Components]]) -> None:
        self._found: dict[str, Components] = {}
        self._later = dict(later)
        self._order = tuple(later)
        self.errors: dict[str, CrowdbotError] = {}

    def of(self, category: str) -> Components:
        """Return the components of one category; none if they cannot be loaded, see `errors`."""
        if category in self._later:
            try:
                self._found[category] = self._later[category]()
            except CrowdbotError as error:
                if is_user_interrupt(error):
                    raise
                self.errors[category] = error
            del self._later[category]
        return self._found.get(category, ())

    @cached_property
    def data_digest(self) -> str:
        """SHA-256 of the files that their specs declare as data; empty without any."""
        return data_digest(self)

    @property
    def known(self) -> Components:
        """Return the components that have been loaded."""
        return tuple(c for category in self._order for c in self._found.get(category, ()))

    @property
    def _all(self) -> Components:
        return tuple(c for category in self._order for c in self.of(category))

    @overload
    def __getitem__(self, index: int) -> Component[Any]: ...
    @overload
    def __getitem__(self, index: slice) -> Components: ...
    def __getitem__(self, index: int | slice) -> Component[Any] | Components:
        return self._all[index]

    def __len__(self) -> int:
        return len(self._all)

    def __iter__(self) -> Iterator[Component[Any]]:
        return iter(self._all)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and self._all == tuple(other)

    def __hash__(self) -> int:
        return hash(self._all)


class ComponentsByKind(Mapping[str, Mapping[str, Component[Any]]]):
    """Category -> kind -> component, sorted by kind; each category is built on demand."""

    def __init__(
        self, categories: Sequence[str], plugins: Sequence[Sequence[Component[Any]]]
    ) -> None:
        self._categories, self._plugins = tuple(categories), tuple(plugins)
        self._found: dict[str, Mapping[str, Component[Any]]] = {}

    def __getitem__(self, category: str) -> Mapping[str, Component[Any]]:
        if category not in self._found:
            if category not in self._categories:
                raise KeyError(category)
            found = {c.kind: c for plugin in self._plugins for c in of_category(plugin, category)}
            self._found[category] = dict(sorted(found.items()))
        return self._found[category]

    def __iter__(self) -> Iterator[str]:
        return iter(self._categories)

    def __len__(self) -> int:
        return len(self._categories)


def known_components(listed: Sequence[Component[Any]]) -> Sequence[Component[Any]]:
    """Return a plugin's components that have been loaded."""
    return listed.known if isinstance(listed, ComponentList) else listed


def of_category(listed: Sequence[Component[Any]], category: str) -> Sequence[Component[Any]]:
    """Return a plugin's components of one category; no other category is loaded."""
    if isinstance(listed, ComponentList):
        return listed.of(category)
    return [c for c in listed if c.category == category]
