"""Compress columns of numbers and documents with zlib and base64; `data.js` decodes them."""

from __future__ import annotations

import base64
import json
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Mantissa bits that are kept: five significant digits, and whole numbers below 131 072.
KEPT_BITS = 16
_BITS = 52
_PLANES = 4
#: Numbers that are rounded together: what they need stays in the processor's cache.
_AT_ONCE = 65_536


def pack(numbers: NDArray[np.float64]) -> str:
    """Pack numbers with five significant digits, NaN for missing ones.

    The kept part of a double is its four highest bytes. All first bytes are stored first, then all
    second ones and so on, since similar bytes compress well together.
    """
    flat = np.asarray(numbers, float).ravel()
    packed = PackedNumbers(len(flat))
    for start in range(0, len(flat), _AT_ONCE):
        packed.put(start, flat[start : start + _AT_ONCE])
    return packed.text()


class PackedNumbers:
    """Numbers packed as by `pack`, in parts, to limit memory."""

    def __init__(self, count: int) -> None:
        self._planes = np.empty((_PLANES, count), np.uint8)

    def put(self, start: int, numbers: NDArray[np.float64]) -> None:
        """Set some numbers (n,) from an index on."""
        words = (_rounded(numbers) >> np.uint64(8 * _PLANES)).astype(">u4")
        self._planes[:, start : start + len(words)] = words.reshape(-1, 1).view(np.uint8).T

    def text(self) -> str:
        """Return the packed numbers, once all are set."""
        return deflate(self._planes.tobytes(), zlib.Z_RLE)


def pack_whole(numbers: NDArray[np.float64]) -> str:
    """Pack numbers with all digits, eight bytes each."""
    words = np.ascontiguousarray(numbers, dtype=np.float64).astype(">f8")
    planes = words.reshape(-1, 1).view(np.uint8)
    return deflate(np.ascontiguousarray(planes.T).tobytes(), zlib.Z_RLE)


def _rounded(numbers: NDArray[np.float64]) -> NDArray[np.uint64]:
    """Return the bits of the nearest numbers with `KEPT_BITS`; overflow is clipped."""
    numbers = np.ascontiguousarray(numbers, dtype=np.float64)
    bits, dropped = numbers.view(np.uint64), np.uint64(_BITS - KEPT_BITS)
    up = bits + (np.uint64(1) << (dropped - np.uint64(1)))
    with np.errstate(over="ignore"):
        up = np.where(np.isfinite(numbers) & np.isfinite(up.view(np.float64)), up, bits)
    return (up >> dropped) << dropped


def pack_document(document: Any) -> str:
    """Pack a JSON document."""
    text = json.dumps(document, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return deflate(text.encode())


def deflate(data: bytes, strategy: int = zlib.Z_DEFAULT_STRATEGY) -> str:
    """Compress bytes with zlib and base64.

    Args:
        strategy: of zlib. In planes of numbers only runs of equal bytes repeat: `zlib.Z_RLE` takes
            a tenth of the time of a search for longer repetitions, and leaves no more.
    """
    packer = zlib.compressobj(6, strategy=strategy)
    return base64.b64encode(packer.compress(data) + packer.flush()).decode("ascii")
