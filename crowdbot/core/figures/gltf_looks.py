"""Base colour and texture of the parts of a figure."""

from __future__ import annotations

from io import BytesIO
from typing import Any, NamedTuple

import numpy as np

from crowdbot.core.figures.gltf_file import GltfFile
from crowdbot.core.types.arrays import Array

#: Colour of a part without a material.
GREY = (0.6, 0.6, 0.6)
#: Largest width and height of a texture, pixels.
_LARGEST = 512


class Looks(NamedTuple):
    """Colour (sRGB), texture coordinates (N, 2) from the top left corner, and PNG of a part."""

    colour: tuple[float, float, float] = GREY
    uv: Array | None = None
    texture: bytes = b""


def looks_of(file: GltfFile, primitive: dict[str, Any]) -> Looks:
    """Return colour and texture of a primitive with a material.

    Vertex colours are replaced by their mean. A texture is multiplied by the base colour.
    """
    material = file.list("materials")[primitive["material"]].get("pbrMetallicRoughness", {})
    names = primitive["attributes"]
    linear = np.array(material.get("baseColorFactor", (1.0, 1.0, 1.0, 1.0)), float)[:3]
    if "COLOR_0" in names:
        linear = linear * np.mean(file.values(names["COLOR_0"])[:, :3], axis=0)
    red, green, blue = _srgb(linear).tolist()
    chosen = material.get("baseColorTexture")
    if chosen is None:
        return Looks((red, green, blue))
    moved = chosen.get("extensions", {}).get("KHR_texture_transform", {})
    place = f"TEXCOORD_{moved.get('texCoord', chosen.get('texCoord', 0))}"
    if place not in names:
        return Looks((red, green, blue))
    uv = _placed(np.asarray(file.values(names[place]), float), moved)
    return Looks((red, green, blue), uv, _png(file, chosen["index"], (red, green, blue)))


def _srgb(linear: Array) -> Array:
    """Return linear colours (3,) of a file as sRGB, 0 to 1."""
    clipped = np.clip(linear, 0.0, 1.0)
    bright = 1.055 * np.maximum(clipped, 0.0031308) ** (1.0 / 2.4) - 0.055
    return np.where(clipped <= 0.0031308, 12.92 * clipped, bright)


def _placed(uv: Array, moved: dict[str, Any]) -> Array:
    """Return texture coordinates (N, 2) after the extension KHR_texture_transform."""
    turn = float(moved.get("rotation", 0.0))
    c, s = np.cos(turn), np.sin(turn)
    scaled = uv * np.array(moved.get("scale", (1.0, 1.0)), float)
    turned = scaled @ np.array([[c, -s], [s, c]])
    return np.asarray(turned + np.array(moved.get("offset", (0.0, 0.0)), float))


def _png(file: GltfFile, texture: int, colour: tuple[float, float, float]) -> bytes:
    """Return a texture, multiplied by a colour, as PNG of limited size."""
    from PIL import Image

    image = file.list("images")[file.list("textures")[texture]["source"]]
    data = (
        file.bytes_of(image["bufferView"])
        if "bufferView" in image
        else file.outside(str(image["uri"]))
    )
    try:
        picture = Image.open(BytesIO(data)).convert("RGB")
    except OSError as error:
        raise file.error(f"has a texture that cannot be read: {error}") from error
    picture.thumbnail((_LARGEST, _LARGEST))
    if colour != (1.0, 1.0, 1.0):
        picture = Image.fromarray(np.rint(np.asarray(picture) * np.array(colour)).astype(np.uint8))
    made = BytesIO()
    picture.save(made, "PNG")
    return made.getvalue()
