"""JSON that somebody else wrote, read so that nobody can read it otherwise.

Python's parser takes the last of two equal keys, NaN, numbers that become infinite, and half
characters; other parsers do not. None of these is in what crowdbot writes.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator
from typing import Any, NoReturn

from crowdbot.errors import hidden_character

#: Most brackets around a value, and digits of a whole number.
DEEPEST, LONGEST = 64, 300


def parse_json(text: str) -> Any:
    """The content of a document.

    Raises:
        ValueError: it is not JSON, or can be read in two ways; says what.
    """
    if text.startswith("\ufeff"):
        raise ValueError("it begins with a byte order mark")
    try:
        content = json.loads(
            text, object_pairs_hook=_once, parse_constant=_constant, parse_int=_whole,
            parse_float=_finite,
        )  # fmt: skip
    except RecursionError:
        raise ValueError(f"it is nested deeper than {DEEPEST} brackets") from None
    _check(content)
    return content


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise ValueError(f"the key {twice[:60]!a} is there twice")
    return found


def _constant(word: str) -> NoReturn:
    raise ValueError(f"{word} is not a number of JSON")


def _whole(digits: str) -> int:
    if len(digits) > LONGEST:
        raise ValueError(f"a whole number has {len(digits)} digits")
    return int(digits)


def _finite(digits: str) -> float:
    number = float(digits)
    if not math.isfinite(number):
        raise ValueError(f"the number {digits[:40]} is too large")
    return number


def _check(content: Any) -> None:
    """Depth, and characters that no reader would see."""
    level: Iterable[Any] = [content]
    for _ in range(DEEPEST + 1):
        level = [part for value in level for part in _parts(value)]
        if not level:
            return
    raise ValueError(f"it is nested deeper than {DEEPEST} brackets")


def _parts(value: Any) -> Iterator[Any]:
    if isinstance(value, str):
        hidden = hidden_character(value)
        if hidden:
            raise ValueError(f"a text has the character {hidden}, which nobody sees")
    elif isinstance(value, dict):
        yield from value
        yield from value.values()
    elif isinstance(value, list):
        yield from value
