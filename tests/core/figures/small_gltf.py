"""Tiny figures as glTF, written by hand: a box that stands, swings, or bends."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

_BOX = np.array([[x, y, z] for y in (0, 2) for x in (-0.3, 0.3) for z in (-0.1, 0.1)], "<f4")
_FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6],
     [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]], "<u2",
)[:, ::-1]  # fmt: skip


class Writer:
    """Puts arrays into one buffer."""

    def __init__(self) -> None:
        self.data, self.views, self.accessors = b"", list[Any](), list[Any]()

    def blob(self, data: bytes) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data
        return len(self.views) - 1

    def add(self, rows: Any, kind: str) -> int:
        rows = np.asarray(rows)
        types = {"<f4": 5126, "<u2": 5123, "|u1": 5121}
        columns = 1 if rows.ndim == 1 else rows.shape[1]
        about = {
            "bufferView": self.blob(rows.tobytes()), "count": len(rows),
            "componentType": types[rows.dtype.str], "type": kind,
        }  # fmt: skip
        assert columns == {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind]
        self.accessors.append(about)
        return len(self.accessors) - 1


def write(path: Path, *, moves: str = "", textured: bool = False) -> Path:
    """Write a box 2 m high; ``moves``: "" or "node", "skin", "each", "away" or "morph"."""
    made = Writer()
    attributes = {"POSITION": made.add(_BOX, "VEC3")}
    primitive: dict[str, Any] = {
        "attributes": attributes, "indices": made.add(_FACES.ravel(), "SCALAR"), "material": 0,
    }  # fmt: skip
    looks: dict[str, Any] = {"baseColorFactor": [1.0, 0.03, 0.01, 1.0]}
    document: dict[str, Any] = {
        "asset": {"version": "2.0"}, "meshes": [{"primitives": [primitive]}],
        "nodes": [{"mesh": 0}], "materials": [{"pbrMetallicRoughness": looks}],
    }  # fmt: skip
    if textured:
        picture = BytesIO()
        Image.new("RGB", (4, 4), (0, 255, 0)).save(picture, "PNG")
        attributes["TEXCOORD_0"] = made.add(np.zeros((8, 2), "<f4"), "VEC2")
        document["images"] = [{"bufferView": made.blob(picture.getvalue())}]
        document["textures"] = [{"source": 0}]
        looks |= {"baseColorTexture": {"index": 0}, "baseColorFactor": [1.0, 1.0, 1.0, 1.0]}
    if moves:
        _animate(document, primitive, made, moves)
    document |= {
        "buffers": [{"byteLength": len(made.data)}], "bufferViews": made.views,
        "accessors": made.accessors,
    }  # fmt: skip
    return _pack(path, document, made.data)


def edit(path: Path, change: Callable[[dict[str, Any], Writer], None]) -> Path:
    """Change the document of a file, and add arrays."""
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    document, made = json.loads(data[20 : 20 + length]), Writer()
    made.data, made.views = data[28 + length :], document["bufferViews"]
    made.accessors = document["accessors"]
    change(document, made)
    document["buffers"] = [{"byteLength": len(made.data)}]
    return _pack(path, document, made.data)


def _pack(path: Path, document: dict[str, Any], data: bytes) -> Path:
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    blob = data + b"\0" * (-len(data) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text
    body += struct.pack("<II", len(blob), 0x004E4942) + blob
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body)
    return path


def _animate(document: dict[str, Any], primitive: dict[str, Any], made: Writer, how: str) -> None:
    """Move it 1 m to its front (z) and back within 2 s; of a skin, its upper half only."""
    ahead = np.array([[0, 0, 0], [0, 0, 1], [0, 0, 0]], "<f4")
    node, path = 0, "translation"
    output, kind = ahead, "VEC3"
    if how == "away":
        output = np.array([[0, 0, 0], [0, 0, 1], [0, 0, 2]], "<f4")
    if how in ("skin", "each"):
        document["nodes"] = [{"mesh": 0, "skin": 0}, {"children": [2]}, {}]
        document["skins"] = [{"joints": [1, 2]}]
        joints, weights = np.zeros((8, 4), "|u1"), np.zeros((8, 4), "<f4")
        joints[4:, 0], weights[:, 0] = 1, 1.0
        primitive["attributes"]["JOINTS_0"] = made.add(joints, "VEC4")
        primitive["attributes"]["WEIGHTS_0"] = made.add(weights, "VEC4")
        node = 2
    if how == "morph":
        target = np.zeros((8, 3), "<f4")
        target[:, 2] = 1.0
        primitive["targets"] = [{"POSITION": made.add(target, "VEC3")}]
        path, output, kind = "weights", np.array([0, 1, 0], "<f4"), "SCALAR"
    times = made.add(np.array([0, 1, 2], "<f4"), "SCALAR")
    document["animations"] = [
        {
            "name": "Walking",
            "channels": [{"sampler": 0, "target": {"node": node, "path": path}}],
            "samplers": [{"input": times, "output": made.add(output, kind)}],
        }
    ]
    if how == "each":  # as some programs write it: an animation without a name for each node
        del document["animations"][0]["name"]
        still = {
            "channels": [{"sampler": 0, "target": {"node": 1, "path": path}}],
            "samplers": [{"input": times, "output": made.add(0 * output, kind)}],
        }
        document["animations"].insert(0, still)
