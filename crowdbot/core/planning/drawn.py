"""A planner's drawing: rows of numbers in its robot's base frame, perhaps with a text at each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crowdbot.errors import hidden_character

#: Largest length of a text, and number of texts in one drawing.
_LONGEST_TEXT, _MOST_TEXTS = 80, 200


#: Rows (K, C) of a drawing, or a function that returns them.
DrawnRows = ArrayLike | Callable[[], ArrayLike]


class Drawn(NamedTuple):
    """A planner's drawing after validation.

    Attributes:
        name: its name.
        rows: (K, C) numbers in the robot's base frame.
        texts: K texts, each at its row's first two numbers, x and y; None: lines or points.
    """

    name: str
    rows: NDArray[np.float32]
    texts: tuple[str, ...] | None = None

    @property
    def size(self) -> int:
        """Return the number of its numbers and characters."""
        return int(self.rows.size) + sum(map(len, self.texts or ()))


class Draw(Protocol):
    """Records a drawing; see `Observation`."""

    def __call__(
        self, name: str, rows: DrawnRows, /, text: str | Sequence[str] | None = None
    ) -> None:
        """Record rows (K, C) by name; ``text``: one for all rows, or one for each."""
        ...


def texts_of_rows(name: str, count: int, text: str | Sequence[str]) -> tuple[str, ...]:
    """Return one text for each row, without characters that are not shown.

    Raises:
        TypeError, ValueError: they are not texts, not as many as rows, too many or too long.
    """
    if not isinstance(text, str | list | tuple):
        raise TypeError(f"draw: '{name}' has one text or a list of texts, not {text!r:.40}")
    if count > _MOST_TEXTS:
        raise ValueError(f"draw: '{name}' has at most {_MOST_TEXTS} texts, not {count}")
    given = [text] * count if isinstance(text, str) else text
    if len(given) != count:
        raise ValueError(f"draw: '{name}' has {count} rows, but {len(given)} texts")
    return tuple(_shown(name, one) for one in given)


def _shown(name: str, text: object) -> str:
    """Return a text of one line without hidden characters."""
    if not isinstance(text, str):
        raise TypeError(f"draw: '{name}' has {text!r:.40} in place of a text")
    if len(text) > _LONGEST_TEXT:
        raise ValueError(
            f"draw: a text of '{name}' has at most {_LONGEST_TEXT} characters, not {len(text)}"
        )
    line = " ".join(text.split()) if "\n" in text or "\t" in text or "\r" in text else str(text)
    return "".join(c for c in line if not hidden_character(c, allowed=""))
