"""Columns of numbers and documents as short text: zlib and base64, which `data.js` undoes."""

from __future__ import annotations

import base64
import json
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Bits of a mantissa that are kept: five significant digits, and whole numbers below 131 072.
KEPT_BITS = 16
_BITS = 52
_PLANES = 4


def pack(numbers: NDArray[np.float64]) -> str:
    """Numbers to five significant digits, NaN for none.

    What is kept of a double fits into its four highest bytes. All first bytes come first, then
    all second ones and so on: bytes that are alike stand together, and compress well.
    """
    words = _rounded(np.asarray(numbers, float)) >> np.uint64(8 * _PLANES)
    return _in_planes(words.astype(">u4"))


def pack_whole(numbers: NDArray[np.float64]) -> str:
    """The same with every digit: eight bytes each."""
    return _in_planes(np.ascontiguousarray(numbers, dtype=np.float64).astype(">f8"))


def _in_planes(words: NDArray[Any]) -> str:
    planes = words.reshape(-1, 1).view(np.uint8)
    return deflate(np.ascontiguousarray(planes.T).tobytes())


def _rounded(numbers: NDArray[np.float64]) -> NDArray[np.uint64]:
    """The bits of the nearest numbers of `KEPT_BITS`; what would become infinite is cut."""
    numbers = np.ascontiguousarray(numbers, dtype=np.float64)
    bits, dropped = numbers.view(np.uint64), np.uint64(_BITS - KEPT_BITS)
    up = bits + (np.uint64(1) << (dropped - np.uint64(1)))
    with np.errstate(over="ignore"):
        up = np.where(np.isfinite(numbers) & np.isfinite(up.view(np.float64)), up, bits)
    return (up >> dropped) << dropped


def pack_document(document: Any) -> str:
    """A document of JSON, packed."""
    text = json.dumps(document, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return deflate(text.encode())


def deflate(data: bytes) -> str:
    """Bytes as zlib and base64."""
    return base64.b64encode(zlib.compress(data, 9)).decode("ascii")
