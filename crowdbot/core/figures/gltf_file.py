"""Read a glTF 2.0 file (.glb, or .gltf with its buffers) as far as figures of people need it.

Source of the format: Khronos Group, "glTF 2.0 specification" (2021), also ISO/IEC 12113:2022.
"""

from __future__ import annotations

import base64
import binascii
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.support.text_files import input_bytes
from crowdbot.errors import InputError

#: Largest file, and largest buffer beside it, bytes.
LARGEST = 64 << 20
_MAGIC, _JSON, _BINARY = 0x46546C67, 0x4E4F534A, 0x004E4942
_COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}


class GltfFile:
    """A document and its buffers.

    Args:
        path: the file.

    Raises:
        InputError: it is not such a file, or needs an extension that is not known here.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        data = input_bytes(path, LARGEST)
        text, blob = _chunks(data) if data[:4] == b"glTF" else (data, b"")
        try:
            self.json: dict[str, Any] = json.loads(text)
        except ValueError as error:
            raise self.error(f"is not glTF: {error}") from error
        if not isinstance(self.json, dict) or "asset" not in self.json:
            raise self.error("is not glTF: it has no 'asset'")
        if needed := self.json.get("extensionsRequired"):
            raise self.error(f"needs {', '.join(map(str, needed))}; write it without extensions")
        self._buffers = [self._buffer(b, blob) for b in self.list("buffers")]

    def error(self, what: str) -> InputError:
        """Return an error about this file."""
        return InputError(f"{self._path}: {what}")

    def list(self, name: str) -> list[dict[str, Any]]:
        """Return a list of the document; empty if it has none."""
        found: list[dict[str, Any]] = self.json.get(name, [])
        return found

    def values(self, index: int) -> NDArray[Any]:
        """Return the values of an accessor, (N,), (N, K) or (N, 4, 4); normalised ones as floats.

        Raises:
            InputError: there is no such accessor, or it is sparse, or beyond its buffer.
        """
        try:
            accessor = self.list("accessors")[index]
            view = self.list("bufferViews")[accessor["bufferView"]]
            kind, columns = np.dtype(_TYPES[accessor["componentType"]]), _COUNTS[accessor["type"]]
            count, row = int(accessor["count"]), kind.itemsize * columns
            start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            found = np.ndarray(
                (count, columns), kind, self._buffers[view.get("buffer", 0)], start,
                (view.get("byteStride") or row, kind.itemsize),
            )  # fmt: skip
        except (KeyError, IndexError, TypeError, ValueError) as error:
            raise self.error(f"accessor {index} cannot be read: {error}") from error
        if "sparse" in accessor:
            raise self.error(f"accessor {index} is sparse; write it without sparse accessors")
        if accessor.get("normalized"):
            found = np.maximum(found / np.iinfo(kind).max, -1.0)
        if columns == 16:
            return found.reshape(-1, 4, 4).transpose(0, 2, 1)  # columns come first
        return found[:, 0] if columns == 1 else found

    def bytes_of(self, view: int) -> bytes:
        """Return the bytes of a buffer view."""
        about = self.list("bufferViews")[view]
        start: int = about.get("byteOffset", 0)
        end: int = start + about["byteLength"]
        return self._buffers[int(about["buffer"])][start:end]

    def outside(self, uri: str) -> bytes:
        """Return the bytes of a ``data:`` text, or of a file in the same folder.

        Raises:
            InputError: it cannot be read, or is not in that folder.
        """
        if uri.startswith("data:"):
            try:
                return base64.b64decode(uri.partition(",")[2], validate=True)
            except binascii.Error as error:
                raise self.error(f"data within it cannot be read: {error}") from error
        beside = self._path.parent / uri
        if not beside.resolve().is_relative_to(self._path.parent.resolve()):
            raise self.error(f"'{uri}' is not in its folder")
        return input_bytes(beside, LARGEST)

    def _buffer(self, about: dict[str, Any], blob: bytes) -> bytes:
        uri = about.get("uri")
        return blob if uri is None else self.outside(str(uri))


def _chunks(data: bytes) -> tuple[bytes, bytes]:
    """Return text and binary part of a .glb."""
    text, blob, at = b"", b"", 12
    while at + 8 <= len(data):
        length, kind = struct.unpack_from("<II", data, at)
        part = data[at + 8 : at + 8 + length]
        text, blob = (part if kind == _JSON else text), (part if kind == _BINARY else blob)
        at += 8 + length
    return text, blob
