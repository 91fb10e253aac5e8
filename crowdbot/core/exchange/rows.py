"""Tables from elements of other formats to crowdbot's fields, for readers and documentation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from crowdbot.core.exchange.item import Item


class PartOutcome(StrEnum):
    """The outcome for one part of a file: carried over, interpreted, left out or added."""

    CARRIED = "carried over"
    INTERPRETED = "interpreted"
    LEFT_OUT = "left out"
    ADDED = "added"


def number(item: Item) -> float:
    """Return a cell as a number, which may be negative."""
    return item.number()


def positive(item: Item) -> float:
    """Return a number above zero."""
    return item.number(1e-9)


def not_negative(item: Item) -> float:
    """Return a number that is not negative."""
    return item.number(0.0)


def text(item: Item) -> str:
    """Return a text."""
    return item.text()


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a table.

    Attributes:
        theirs: name of the part, such as ``@rad`` or ``Goals``.
        ours: place in our language, such as ``crowd.agents.radius``; empty if there is none.
        note: reason why it is left out, or how it was interpreted; empty if carried over as it is.
        read: converts the part to our value; raises SpecError.
        unless: value, as text, with which leaving the part out loses nothing.
    """

    theirs: str
    ours: str = ""
    note: str = ""
    read: Callable[[Item], Any] = number
    unless: str = ""

    @property
    def outcome(self) -> PartOutcome:
        """Return the outcome for the file's part: carried over, interpreted, or left out."""
        if not self.ours:
            return PartOutcome.LEFT_OUT
        return PartOutcome.INTERPRETED if self.note else PartOutcome.CARRIED

    @property
    def field(self) -> str:
        """Return the name of crowdbot's field."""
        return self.ours.rpartition(".")[2]


@dataclass(frozen=True, slots=True)
class RowTable:
    """The rows of one element of one format.

    Attributes:
        element: path or name of the element, for people.
        rows: its parts.
    """

    element: str
    rows: Sequence[Row]
