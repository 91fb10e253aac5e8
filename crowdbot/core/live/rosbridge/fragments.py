"""Fragments of long text messages in the protocol."""

from __future__ import annotations

import json
from collections import OrderedDict
from collections.abc import Iterator, Mapping
from typing import Any

from crowdbot.core.live.rosbridge.bad_frame import BadFrame

#: Limits for fragmented messages from clients: fragments, characters, and open messages.
_MOST_PIECES, _MOST_CHARACTERS, _MOST_OPEN = 4096, 2**20, 8
#: Largest number of fragments of a message to a client.
MOST_SENT = 256


def split(text: str, size: int, number: int) -> Iterator[str]:
    """Split a text into messages of at most ``size`` characters; a short one is not split.

    Args:
        size: > 0.
        number: number of the message, unique among pending ones.

    Raises:
        BadFrame: it would be more than `MOST_SENT` messages.
    """
    if len(text) <= size:
        yield text
        return
    total = -(-len(text) // size)
    if total > MOST_SENT:
        raise BadFrame(
            f"{len(text)} characters are more than {MOST_SENT} fragments of {size}; "
            "ask for a larger 'fragment_size'"
        )
    for k in range(total):
        piece = {
            "op": "fragment", "id": str(number), "data": text[k * size : (k + 1) * size],
            "num": k, "total": total,
        }  # fmt: skip
        yield json.dumps(piece)


class Joiner:
    """Joins fragments in any order; the oldest incomplete message is dropped."""

    def __init__(self) -> None:
        self._open = OrderedDict[str, dict[int, str]]()
        self._sizes = dict[str, int]()

    def add(self, message: Mapping[str, Any]) -> str | None:
        """Add a fragment; return the whole text after the last one.

        Raises:
            BadFrame: it is not a fragment, or the text is too long.
        """
        name, data = message.get("id"), message.get("data")
        number, total = message.get("num"), message.get("total")
        known = isinstance(name, str | int) and isinstance(data, str)
        if not known or not _is_count(number) or not _is_count(total):
            raise BadFrame("a fragment has 'id', 'data', 'num' and 'total'")
        assert isinstance(number, int)
        assert isinstance(total, int)
        if not 0 <= number < total <= _MOST_PIECES:
            raise BadFrame(f"fragment {number} of {total}")
        key, text = str(name)[:256], str(data)
        pieces = self._open.setdefault(key, {})
        self._open.move_to_end(key)
        self._sizes[key] = self._sizes.get(key, 0) + len(text) - len(pieces.get(number, ""))
        pieces[number] = text
        if self._sizes[key] > _MOST_CHARACTERS:
            self._drop(key)
            raise BadFrame("the message in fragments is too long")
        while len(self._open) > _MOST_OPEN:
            self._drop(next(iter(self._open)))
        if len(pieces) < total:
            return None
        self._drop(key)
        return "".join(pieces[k] for k in sorted(pieces))

    def _drop(self, key: str) -> None:
        del self._open[key], self._sizes[key]


def _is_count(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)
