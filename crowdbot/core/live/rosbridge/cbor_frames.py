"""CBOR from clients: a frame's structure is checked before a library builds objects from it."""

from __future__ import annotations

import struct
from typing import Any

from crowdbot.core.live.rosbridge.bad_frame import BadFrame

#: Largest number of items in a frame, and largest depth; commands have 20 items at most.
_MOST_ITEMS, _MOST_DEPTH = 2000, 16
#: Tags of typed arrays, RFC 8746.
_TYPED_ARRAYS = range(64, 88)
_BYTES, _TEXT, _ARRAY, _MAP, _TAG, _SIMPLE = 2, 3, 4, 5, 6, 7
_SIZES = {24: ">B", 25: ">H", 26: ">I", 27: ">Q"}
_INDEFINITE = 31


def read_cbor(data: bytes) -> Any:
    """Return the value of a frame.

    Keys of maps must be text: Python does not randomise the hashes of other keys, so that a client
    could choose keys that collide.

    Raises:
        BadFrame: it is not one value within the bounds.
    """
    import cbor2

    check_cbor(data)
    return cbor2.loads(data)


def check_cbor(data: bytes) -> None:
    """Check items, depth, keys and tags of one value.

    Raises:
        BadFrame: one of them is not allowed, or the bytes end early or late.
    """
    try:
        end = _Scan(data).value(0, 0)
    except (IndexError, struct.error):
        raise BadFrame("not a message: it is cut off") from None
    if end != len(data):
        raise BadFrame("not a message: there is something after it")


class _Scan:
    def __init__(self, data: bytes) -> None:
        self._data, self._items = data, 0

    def value(self, at: int, depth: int, *, key: bool = False) -> int:
        """Check the value at position ``at``; return the position after it."""
        self._items += 1
        if self._items > _MOST_ITEMS or depth > _MOST_DEPTH:
            raise BadFrame(f"a frame has at most {_MOST_ITEMS} items, {_MOST_DEPTH} deep")
        kind, info = self._data[at] >> 5, self._data[at] & 31
        if key and kind != _TEXT:
            raise BadFrame("keys of a map are text")
        if info == _INDEFINITE:
            return self._pieces(kind, at + 1, depth)
        at, count = self._count(info, at + 1)
        if kind in (_BYTES, _TEXT):
            if at + count > len(self._data):
                raise IndexError
            return at + count
        if kind == _TAG:
            if count not in _TYPED_ARRAYS:
                raise BadFrame(f"tag {count} is not a typed array of RFC 8746")
            return self.value(at, depth + 1)
        if kind in (_ARRAY, _MAP):
            for _ in range(count):
                at = self._entry(kind, at, depth)
        return at

    def _entry(self, kind: int, at: int, depth: int) -> int:
        if kind == _MAP:
            at = self.value(at, depth + 1, key=True)
        return self.value(at, depth + 1)

    def _pieces(self, kind: int, at: int, depth: int) -> int:
        """Return the position after a value of indefinite length."""
        if kind not in (_BYTES, _TEXT, _ARRAY, _MAP):
            raise BadFrame("not a message: an end without a beginning")
        while self._data[at] != 0xFF:
            at = self._entry(kind, at, depth)
        return at + 1

    def _count(self, info: int, at: int) -> tuple[int, int]:
        """Return the position after a head, and its number."""
        if info < 24:
            return at, info
        if info not in _SIZES:
            raise BadFrame("not a message: a reserved head")
        code = _SIZES[info]
        return at + struct.calcsize(code), int(struct.unpack_from(code, self._data, at)[0])
