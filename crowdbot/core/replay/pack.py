"""Packs numbers for the page: small integers, differences, bytes by significance, zlib, base64.

Rows of int16 become differences modulo 2^16, and these are folded so that small ones of either
sign have a zero high byte (0, -1, 1, -2 become 0, 1, 2, 3). All low bytes come before all high
bytes. `decode.js` undoes it.
"""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.types.arrays import Array

ABSENT = -32768
_LARGEST = 32000
#: Of zlib: half the time of level 6, for a twentieth more bytes.
_LEVEL = 4


def quantise(rows: Array, scale: float) -> NDArray[np.int16]:
    """Numbers as multiples of ``scale``; what is not finite as `ABSENT`."""
    steps = rows / scale
    np.rint(steps, out=steps)
    np.clip(steps, -_LARGEST, _LARGEST, out=steps)
    steps[~np.isfinite(rows)] = ABSENT
    return steps.astype(np.int16)


def pack_motion(rows: NDArray[np.int16]) -> str:
    """Rows that change steadily, as positions do: differences of differences along each row."""
    return _pack(_differences(_differences(rows.astype(np.uint16))), zlib.Z_DEFAULT_STRATEGY)


def pack_readings(rows: NDArray[np.int16]) -> str:
    """Rows whose neighbours are alike, as the beams of a scan: differences from row to row.

    They hold no strings that come again, so zlib does not look for any.
    """
    return _pack(_differences(rows.T.astype(np.uint16)).T, zlib.Z_RLE)


def pack_words(numbers: NDArray[Any]) -> str:
    """Rows of float32 (K, N), or one of float64: differences of their bits along each row."""
    kind = np.dtype(f"<u{numbers.dtype.itemsize}")
    words = np.atleast_2d(numbers).view(kind)
    shuffled = _differences(words).astype(kind).reshape(-1, 1).view(np.uint8)
    return deflate(np.ascontiguousarray(shuffled.T).tobytes())


def deflate(data: bytes, strategy: int = zlib.Z_DEFAULT_STRATEGY) -> str:
    """Zlib and base64."""
    squeeze = zlib.compressobj(_LEVEL, zlib.DEFLATED, 15, 9, strategy)
    return base64.b64encode(squeeze.compress(data) + squeeze.flush()).decode("ascii")


def _differences(words: NDArray[Any]) -> NDArray[Any]:
    """Along each row, the first one stays; modulo the size of a word."""
    changes = words.copy()
    changes[:, 1:] -= words[:, :-1]
    return changes


def _pack(changes: NDArray[np.uint16], strategy: int) -> str:
    signed = np.ascontiguousarray(changes).view(np.int16)
    folded = np.ascontiguousarray((signed << 1) ^ (signed >> 15), "<i2").view(np.uint8)
    return deflate(folded.reshape(-1, 2).T.tobytes(), strategy)
