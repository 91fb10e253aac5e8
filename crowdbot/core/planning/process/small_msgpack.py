"""A small msgpack for Pythons without a library: the types in planner messages.

None, bool, int, float, str, bytes, list (tuple) and dict. Uses only the standard library and
supports Python 3.8, for foreign Pythons.
"""

from __future__ import annotations

import struct
from typing import Any

_DEEPEST = 32
#: First byte -> struct format of a number.
_NUMBERS = {
    0xCA: ">f", 0xCB: ">d", 0xCC: ">B", 0xCD: ">H", 0xCE: ">I", 0xCF: ">Q",
    0xD0: ">b", 0xD1: ">h", 0xD2: ">i", 0xD3: ">q",
}  # fmt: skip
#: First byte -> format of the length of a text, bytes, a list, a map.
_LENGTHS = {
    0xD9: ("str", ">B"), 0xDA: ("str", ">H"), 0xDB: ("str", ">I"),
    0xC4: ("bin", ">B"), 0xC5: ("bin", ">H"), 0xC6: ("bin", ">I"),
    0xDC: ("list", ">H"), 0xDD: ("list", ">I"), 0xDE: ("map", ">H"), 0xDF: ("map", ">I"),
}  # fmt: skip
_CONSTANTS: dict[int, Any] = {0xC0: None, 0xC2: False, 0xC3: True}


def packb(value: Any) -> bytes:
    """Encode a value as msgpack.

    Raises:
        TypeError: it contains an unsupported type.
        OverflowError: a whole number does not fit into 64 bits.
    """
    out = bytearray()
    _pack(value, out)
    return bytes(out)


def _pack(value: Any, out: bytearray) -> None:
    if value is None or isinstance(value, bool):
        out.append({None: 0xC0, False: 0xC2, True: 0xC3}[value])
    elif isinstance(value, int):
        _pack_int(value, out)
    elif isinstance(value, float):
        out += b"\xcb" + struct.pack(">d", value)
    elif isinstance(value, str):
        raw = value.encode("utf-8", "replace")
        out += b"\xdb" + struct.pack(">I", len(raw)) + raw
    elif isinstance(value, (bytes, bytearray, memoryview)):
        raw = bytes(value)
        out += b"\xc6" + struct.pack(">I", len(raw)) + raw
    elif isinstance(value, (list, tuple)):
        out += b"\xdd" + struct.pack(">I", len(value))
        for item in value:
            _pack(item, out)
    elif isinstance(value, dict):
        out += b"\xdf" + struct.pack(">I", len(value))
        for key, item in value.items():
            _pack(key, out)
            _pack(item, out)
    else:
        raise TypeError(f"{type(value).__name__} cannot be sent")


def _pack_int(value: int, out: bytearray) -> None:
    if 0 <= value < 128:
        out.append(value)
        return
    try:
        out += b"\xd3" + struct.pack(">q", value)
    except struct.error:
        try:
            out += b"\xcf" + struct.pack(">Q", value)
        except struct.error:
            raise OverflowError("a number that does not fit into 64 bits") from None


def unpackb(raw: bytes) -> Any:
    """Decode a msgpack value.

    Raises:
        ValueError: it is not supported msgpack.
    """
    try:
        value, end = _unpack(memoryview(raw), 0, 0)
    except (IndexError, struct.error, UnicodeDecodeError, TypeError) as error:
        raise ValueError(f"not a message: {error}") from None
    if end != len(raw):
        raise ValueError(f"{len(raw) - end} bytes too many")
    return value


def _unpack(raw: memoryview, at: int, depth: int) -> tuple[Any, int]:
    if depth > _DEEPEST:
        raise ValueError(f"deeper than {_DEEPEST}")
    first, at = raw[at], at + 1
    if first < 0x80 or first >= 0xE0:
        return (first if first < 0x80 else first - 0x100), at
    if first in _CONSTANTS:
        return _CONSTANTS[first], at
    if first in _NUMBERS:
        form = _NUMBERS[first]
        return struct.unpack_from(form, raw, at)[0], at + struct.calcsize(form)
    kind, count, at = _length(raw, first, at)
    if kind in ("str", "bin"):
        if at + count > len(raw):
            raise ValueError("it is cut")
        piece = bytes(raw[at : at + count])
        return (piece.decode("utf-8") if kind == "str" else piece), at + count
    return _many(raw, at, kind, count, depth)


def _length(raw: memoryview, first: int, at: int) -> tuple[str, int, int]:
    if first < 0x90:
        return "map", first & 0x0F, at
    if first < 0xA0:
        return "list", first & 0x0F, at
    if first < 0xC0:
        return "str", first & 0x1F, at
    if first not in _LENGTHS:
        raise ValueError(f"0x{first:02x} begins nothing that is known here")
    kind, form = _LENGTHS[first]
    return kind, struct.unpack_from(form, raw, at)[0], at + struct.calcsize(form)


def _many(raw: memoryview, at: int, kind: str, count: int, depth: int) -> tuple[Any, int]:
    if count > len(raw) - at:
        raise ValueError("it is cut")
    items = []
    for _ in range(count * (2 if kind == "map" else 1)):
        item, at = _unpack(raw, at, depth + 1)
        items.append(item)
    if kind == "list":
        return items, at
    return dict(zip(items[::2], items[1::2])), at  # noqa: B905 - Python 3.8
