"""The components of a plugin, by category; some are asked for when somebody wants to know."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, overload

from crowdbot.dsl.spec.component import Component

Components = tuple[Component[Any], ...]


class ComponentList(Sequence[Component[Any]]):
    """All components in the order of their categories.

    crowdbot's own metrics and planners are the most, and no scenario holds one: a command that
    reads documents ends without them.

    Args:
        known: category -> components.
        later: category -> what finds its components, once.
    """

    def __init__(
        self, known: Mapping[str, Components], later: Mapping[str, Callable[[], Components]]
    ) -> None:
        self._found, self._later = dict(known), dict(later)
        self._order = [*known, *later]

    def of(self, category: str) -> Components:
        """The components of one category."""
        if category in self._later:
            self._found[category] = self._later.pop(category)()
        return self._found.get(category, ())

    @property
    def known(self) -> Components:
        """Those that were asked for."""
        return tuple(c for found in self._found.values() for c in found)

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
    """Category -> kind -> component, sorted by kind, put together when a category is asked for."""

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
    """Those of a plugin that are there already."""
    return listed.known if isinstance(listed, ComponentList) else listed


def of_category(listed: Sequence[Component[Any]], category: str) -> Sequence[Component[Any]]:
    """Those of a plugin that belong to one category; no other is asked for."""
    if isinstance(listed, ComponentList):
        return listed.of(category)
    return [c for c in listed if c.category == category]
