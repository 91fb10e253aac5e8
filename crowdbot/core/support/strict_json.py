"""Strict JSON for untrusted input: no duplicate keys, NaN or lone surrogates.

Python's parser accepts duplicate keys (the last one wins), NaN, numbers that overflow, and lone
surrogates; other parsers do not. crowdbot never writes any of these.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator
from typing import Any, NoReturn

from crowdbot.errors import hidden_character

#: Largest nesting depth, and number of digits of an integer.
DEEPEST, LONGEST = 64, 300
_TOO_DEEP = f"it is nested deeper than {DEEPEST} brackets"
#: What a text of ASCII must hold to hide a character: DEL, or an escape of a hidden one.
_HIDING = ("\x7f", "\\u", "\\b", "\\f")


def parse_json(text: str) -> Any:
    """Return the content of a document.

    Raises:
        ValueError: it is not JSON, or is ambiguous; the message says why.
    """
    if text.startswith("\ufeff"):
        raise ValueError("it begins with a byte order mark")
    try:
        content = json.loads(
            text, object_pairs_hook=_once, parse_constant=_constant, parse_int=_whole,
            parse_float=_finite,
        )  # fmt: skip
    except RecursionError:
        raise ValueError(_TOO_DEEP) from None
    _check(content, text)
    return content


def parse_foreign_json(text: str) -> Any:
    """Return the content of a document that another program wrote, such as GeoJSON.

    Repeated keys, hidden characters and NaN are left to the reader; depth and numbers are bounded.

    Raises:
        ValueError: it is not JSON, too deep, or a number is too long; the message says where.
    """
    try:
        content = json.loads(text.removeprefix("\ufeff"), parse_int=_whole)
    except json.JSONDecodeError as error:
        raise ValueError(f"line {error.lineno}, column {error.colno}: {error.msg}") from None
    except RecursionError:
        raise ValueError(_TOO_DEEP) from None
    if _is_deeper(content, DEEPEST):
        raise ValueError(_TOO_DEEP)
    return content


def _is_deeper(content: Any, most: int) -> bool:
    """Return True if lists and objects are nested deeper than ``most``."""
    waiting = [(content, 0)] if isinstance(content, (dict, list)) else []
    while waiting:
        value, depth = waiting.pop()
        if depth > most:
            return True
        inner = value.values() if isinstance(value, dict) else value
        waiting += [(v, depth + 1) for v in inner if isinstance(v, (dict, list))]
    return False


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
        raise ValueError(f"a whole number has {len(digits)} digits, more than {LONGEST}")
    return int(digits)


def _finite(digits: str) -> float:
    number = float(digits)
    if not math.isfinite(number):
        raise ValueError(f"the number {digits[:40]} is too large")
    return number


def _check(content: Any, text: str) -> None:
    """Check depth, and characters that readers cannot see.

    ASCII hides none but by an escape or as DEL: then only the depth is left to check.
    """
    if text.isascii() and not any(mark in text for mark in _HIDING):
        if _is_deeper(content, DEEPEST - 1):
            raise ValueError(_TOO_DEEP)
        return
    level: Iterable[Any] = [content]
    for _ in range(DEEPEST + 1):
        level = [part for value in level for part in _parts(value)]
        if not level:
            return
    raise ValueError(_TOO_DEEP)


def _parts(value: Any) -> Iterator[Any]:
    if isinstance(value, str):
        hidden = hidden_character(value)
        if hidden:
            raise ValueError(f"a text has the hidden character {hidden}")
    elif isinstance(value, dict):
        yield from value
        yield from value.values()
    elif isinstance(value, list):
        yield from value
