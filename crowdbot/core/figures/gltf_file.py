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
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.support.text_files import input_bytes
from crowdbot.errors import InputError

#: Largest file, and largest buffer beside it, bytes.
LARGEST = 64 << 20
_MAGIC, _JSON, _BINARY = 0x46546C67, 0x4E4F534A, 0x004E4942
_COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
#: What a file may require: other types of numbers, which are read anyway; how light is reflected;
#: where a texture lies, which `gltf_looks` reads.
_READ = ("KHR_mesh_quantization", "KHR_materials_", "KHR_texture_transform")
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
        required = map(str, self.json.get("extensionsRequired", []))
        if needed := [name for name in required if not name.startswith(_READ)]:
            raise self.error(f"needs {', '.join(needed)}; write it without compression")
        self._buffers = [self._buffer(b, blob) for b in self.list("buffers")]

    def error(self, problem: str) -> InputError:
        """Return an error that names this file."""
        return InputError(f"{self._path}: {problem}")

    def list(self, name: str) -> list[dict[str, Any]]:
        """Return a list of the document; empty if it has none.

        Raises:
            InputError: it is something else.
        """
        found: list[dict[str, Any]] = self.json.get(name, [])
        if not isinstance(found, list) or not all(isinstance(each, dict) for each in found):
            raise self.error(f"'{name}' is not a list of objects")
        return found

    def values(self, index: int) -> NDArray[Any]:
        """Return the values of an accessor, (N,), (N, K) or (N, 4, 4); normalised ones as floats.

        Raises:
            InputError: there is no such accessor, or it is beyond its buffer.
        """
        try:
            accessor = self.list("accessors")[index]
            kind, columns = np.dtype(_TYPES[accessor["componentType"]]), _COUNTS[accessor["type"]]
            found = self._rows(accessor, int(accessor["count"]), kind, columns)
            if about := accessor.get("sparse"):
                count, where = int(about["count"]), about["indices"]
                rows = self._rows(where, count, np.dtype(_TYPES[where["componentType"]]), 1)
                found = found.copy()
                found[rows[:, 0]] = self._rows(about["values"], count, kind, columns)
        except (KeyError, IndexError, TypeError, ValueError) as error:
            raise self.error(f"accessor {index} cannot be read: {error}") from error
        if accessor.get("normalized"):
            found = np.maximum(found / np.iinfo(kind).max, -1.0)
        if columns == 16:
            return found.reshape(-1, 4, 4).transpose(0, 2, 1)  # columns come first
        return found[:, 0] if columns == 1 else found

    def _rows(
        self, about: dict[str, Any], count: int, kind: np.dtype[Any], columns: int
    ) -> NDArray[Any]:
        """Return the rows (N, K) that an accessor, or a part of a sparse one, refers to."""
        if "bufferView" not in about:
            return np.zeros((count, columns), kind)
        view = self.list("bufferViews")[about["bufferView"]]
        start = view.get("byteOffset", 0) + about.get("byteOffset", 0)
        step = view.get("byteStride") or kind.itemsize * columns
        buffer = self._buffers[view.get("buffer", 0)]
        return np.ndarray((count, columns), kind, buffer, start, (step, kind.itemsize))

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
        beside = self._path.parent / unquote(uri)
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
