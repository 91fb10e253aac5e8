"""Pack numbers for the page: small integers, differences, bytes by significance, zlib, base64.

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
#: zlib level: half the time of level 6 for 5 % more bytes.
_LEVEL = 4


def quantise(rows: Array, scale: float) -> NDArray[np.int16]:
    """Return numbers as multiples of ``scale``; non-finite ones as `ABSENT`."""
    steps = rows / scale
    np.rint(steps, out=steps)
    np.clip(steps, -_LARGEST, _LARGEST, out=steps)
    steps[~np.isfinite(rows)] = ABSENT
    return steps.astype(np.int16)


def pack_motion(rows: NDArray[np.int16]) -> str:
    """Pack smooth rows such as positions: second differences along each row."""
    return _pack(_differences(_differences(rows.astype(np.uint16))), zlib.Z_DEFAULT_STRATEGY)


def pack_readings(rows: NDArray[np.int16]) -> str:
    """Pack rows with similar neighbours, such as the beams of a scan, as differences of rows.

    They contain no repeated strings, so zlib does not search for any.
    """
    return _pack(_differences(rows.T.astype(np.uint16)).T, zlib.Z_RLE)


def pack_words(numbers: NDArray[Any]) -> str:
    """Pack rows of float32 (K, N) or one of float64: differences of their bits along each row."""
    kind = np.dtype(f"<u{numbers.dtype.itemsize}")
    words = np.atleast_2d(numbers).view(kind)
    shuffled = _differences(words).astype(kind).reshape(-1, 1).view(np.uint8)
    return deflate(np.ascontiguousarray(shuffled.T).tobytes())


def deflate(data: bytes, strategy: int = zlib.Z_DEFAULT_STRATEGY) -> str:
    """Compress with zlib and base64."""
    squeeze = zlib.compressobj(_LEVEL, zlib.DEFLATED, 15, 9, strategy)
    return base64.b64encode(squeeze.compress(data) + squeeze.flush()).decode("ascii")


def _differences(words: NDArray[Any]) -> NDArray[Any]:
    """Return differences along each row, keeping the first value; modulo the word size."""
    changes = words.copy()
    changes[:, 1:] -= words[:, :-1]
    return changes


def _pack(changes: NDArray[np.uint16], strategy: int) -> str:
    signed = np.ascontiguousarray(changes).view(np.int16)
    folded = np.ascontiguousarray((signed << 1) ^ (signed >> 15), "<i2").view(np.uint8)
    return deflate(folded.reshape(-1, 2).T.tobytes(), strategy)
