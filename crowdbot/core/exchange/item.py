"""Parts of imported files: a tree whose nodes have positions, and record if they were used.

Elements, attributes, keys and entries are all items. An attribute ``x`` of an element is its child
``@x``. Items that no reader used are found at the end, so that nothing is dropped silently.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from typing import NoReturn

from crowdbot.dsl.text.diagnostics import Diagnostic, Mark
from crowdbot.errors import SpecError, did_you_mean, nearest

Scalar = str | int | float | bool | None

#: Largest magnitude of a coordinate or parameter that is taken seriously.
LARGEST = 1e9
_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}


class Item:
    """An element, attribute, key or entry.

    Attributes:
        name: tag, key, ``@attribute``, or ``[n]`` for an entry of a list.
        mark: its position.
        value: its text or scalar; None if it has only children.
        children: its parts, in order.
        parent: the item that it is a part of.
        used: True if a reader asked for it.
        heard: True if a reader asked for its value, or it has none.
    """

    __slots__ = ("children", "heard", "mark", "name", "parent", "used", "value")

    def __init__(self, name: str, mark: Mark, value: Scalar = None) -> None:
        self.name, self.mark, self.value = name, mark, value
        self.children: list[Item] = []
        self.parent: Item | None = None
        self.used = self.heard = False

    def add(self, child: Item) -> Item:
        """Append a child and return it."""
        child.parent = self
        self.children.append(child)
        return child

    @property
    def path(self) -> str:
        """Names from the root to this item, without indices: ``Trial/agents/agent``."""
        names, item = [], self
        while item.parent is not None:
            if not item.name.startswith("["):
                names.append(item.name)
            item = item.parent
        names.append(item.name)
        return "/".join(filter(None, reversed(names))).replace("/@", "@")

    def find(self, name: str) -> Item | None:
        """Return the first child of a name, and count it as used."""
        for child in self.children:
            if child.name == name:
                child.used = True
                return child
        return None

    def need(self, name: str) -> Item:
        """Return the first child of a name.

        Raises:
            SpecError: E402, there is none.
        """
        found = self.find(name)
        if found is None:
            kind = "attribute" if name.startswith("@") else "part"
            names = [child.name.removeprefix("@") for child in self.children]
            near = nearest(name.removeprefix("@"), names)
            self.refuse(f"'{self.name}' has no {kind} '{name.removeprefix('@')}'", near)
        return found

    def every(self, *names: str) -> list[Item]:
        """Return all children, or those of some names, and count them as used."""
        found = [c for c in self.children if not names or c.name in names]
        for child in found:
            child.used = True
        return found

    def entries(self, name: str) -> list[Item]:
        """Return the children of the first child of a name, if there is one, counted as used."""
        listed = self.find(name)
        return listed.every() if listed else []

    def elements(self) -> list[Item]:
        """Return all children but attributes, and count them as used."""
        found = [child for child in self.children if not child.name.startswith("@")]
        for child in found:
            child.used = True
        return found

    def take_all(self) -> None:
        """Count this item and everything in it as used."""
        stack = [self]
        while stack:
            item = stack.pop()
            item.used = item.heard = True
            stack += item.children

    def walk(self) -> Iterator[Item]:
        """Yield this item and everything in it, in the order of the file."""
        stack = [self]
        while stack:
            item = stack.pop()
            yield item
            stack += reversed(item.children)

    def text(self) -> str:
        """Return the value as text without outer blanks.

        Raises:
            SpecError: E402, it has parts instead.
        """
        self.heard = True
        if self.value is None and self.children:
            self.refuse(f"'{self.name}' has parts, and is expected to be a text")
        return "" if self.value is None else str(self.value).strip()

    def number(self, low: float = -LARGEST, high: float = LARGEST) -> float:
        """Return the value as a number within bounds.

        Raises:
            SpecError: E402, it is not one.
        """
        text = self.text()
        good = not isinstance(self.value, bool) and len(text) < 400 and _NUMBER.fullmatch(text)
        value = float(text) if good else math.nan
        if not math.isfinite(value):
            self.refuse(f"'{self.name}' is {text[:60]!r}, and has to be a finite number")
        if not low <= value <= high:
            self.refuse(f"'{self.name}' is {text[:60]}, and has to be from {low:g} to {high:g}")
        return value

    def whole(self, low: int = -(10**9), high: int = 10**9) -> int:
        """Return the value as a whole number within bounds.

        Raises:
            SpecError: E402, it is not one.
        """
        value = self.number(low, high)
        if value != int(value):
            self.refuse(f"'{self.name}' is {value:g}, and has to be a whole number")
        return int(value)

    def truth(self) -> bool:
        """Return the value as a bool.

        Raises:
            SpecError: E402, it is not one.
        """
        found = _BOOLEANS.get(self.text().lower())
        if found is None:
            self.refuse(f"'{self.name}' is {self.text()[:60]!r}, and has to be true or false")
        return found

    def word(self, *known: str) -> str:
        """Return the value in lower case, which must be one of the given words.

        Raises:
            SpecError: E402, it is another one.
        """
        text = self.text().lower()
        if text not in known:
            hint = nearest(text, known) or known
            self.refuse(f"'{self.name}' is {text[:60]!r}, which is not known", hint)
        return text

    def refuse(self, message: str, near: Sequence[str] = (), code: str = "E402") -> NoReturn:
        """Raise a SpecError at this item."""
        raise SpecError([self.problem(message, near, code)])

    def problem(self, message: str, near: Sequence[str] = (), code: str = "E402") -> Diagnostic:
        """Return an error at this item."""
        return Diagnostic(code, message, self.mark, did_you_mean(list(near)[:3]).removeprefix("; "))
