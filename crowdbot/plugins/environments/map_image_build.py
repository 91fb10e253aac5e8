"""Images of occupancy grids as grey values: netpbm's, PNG, JPEG, BMP, GIF, TIFF and WebP.

The content says which format an image has, not the ending of its name.
"""

from __future__ import annotations

import logging
import re
import warnings
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import InputError
from crowdbot.plugin.for_environments import LARGEST_TABLE, input_bytes

_LOG = logging.getLogger(__name__)
#: Largest image, px; anything larger is a mistake.
MOST_PIXELS = 64_000_000
Alpha = Literal["averaged", "unknown", "ignored"]
_HEADER = re.compile(rb"(P[25])\s+((?:#[^\n]*\n\s*)*)(\d+)\s+(?:#[^\n]*\n\s*)*(\d+)\s+"
                     rb"(?:#[^\n]*\n\s*)*(\d+)\s")  # fmt: skip
#: First bytes -> format, by Pillow's name.
_FORMATS = {
    b"\x89PNG": "PNG", b"\xff\xd8\xff": "JPEG", b"BM": "BMP", b"GIF8": "GIF",
    b"II*\0": "TIFF", b"MM\0*": "TIFF", b"P1": "PPM", b"P3": "PPM", b"P4": "PPM", b"P6": "PPM",
    b"RIFF": "WEBP",
}  # fmt: skip
#: First bytes of what is not read -> what it is.
_OTHERS = {
    b"P7": "a PAM image",
    b"Pf": "a PFM image",
    b"PF": "a PFM image",
    b"gimp xcf": "GIMP's own XCF",
    b"8BPS": "a Photoshop document",
    b"%PDF": "a PDF document",
    b"\0\0\0\x0cjP": "a JPEG 2000 image",
    b"\x93NUMPY": "an array of numpy",
    b"<svg": "an SVG drawing",
    b"<?xml": "XML, perhaps SVG",
    b"\x1f\x8b": "compressed; unpack it with gunzip",
    b"PK": "a zip archive; unpack it",
}
#: Pillow's modes of whole numbers of 16 bits.
_SIXTEEN_BITS = ("I;16", "I;16B", "I;16L", "I;16N")
#: Pillow's modes of greys and colours of 8 bits or less.
_COLOURS = ("1", "L", "LA", "P", "PA", "RGB", "RGBX", "RGBA", "CMYK", "YCbCr")
_CONVERT = "convert it to PNG (with GIMP, or ImageMagick: convert {} map.png)"


def read_grey(file: Path, alpha: Alpha = "ignored") -> NDArray[np.float64]:
    """Read an image as grey values (H, W) from 0 to 1; the first row is on top.

    Args:
        alpha: what opacity means where the image has it: ``averaged`` with the colours;
            ``unknown``: pixels that are not opaque become NaN; ``ignored``.

    Raises:
        InputError: it is of no known format, or damaged.
    """
    content = input_bytes(file, LARGEST_TABLE, file.name)
    if content[:2] in (b"P2", b"P5"):
        return _read_pgm(file.name, content)
    found = next((name for start, name in _FORMATS.items() if content.startswith(start)), None)
    if found is None:
        raise InputError(f"{file.name}: {_of_no_image(file, content)}")
    return _grey(file.name, _opened(file, found), alpha)


def _of_no_image(file: Path, content: bytes) -> str:
    """Return what a file is that is not read as an image, and what helps."""
    if not content:
        return "is empty, not an image"
    begin = content.lstrip()
    for start, name in _OTHERS.items():
        if begin.startswith(start):
            return f"is {name}" if ";" in name else f"is {name}: {_CONVERT.format(file.name)}"
    if content[4:12] in (b"ftypheic", b"ftypmif1", b"ftypavif"):
        return f"is a HEIF or AVIF image: {_CONVERT.format(file.name)}"
    if file.suffix.lower() in (".yaml", ".yml") or begin.startswith(b"image:"):
        return (
            "is a map, not its picture; a map names its picture with image, and "
            "environment.image names another"
        )
    return (
        "is not an image that is read (PGM, PPM, PBM, PNG, JPEG, BMP, GIF, TIFF, WebP); it begins "
        f"with {content[:8]!r}: {_CONVERT.format(file.name)}"
    )


def _read_pgm(name: str, content: bytes) -> NDArray[np.float64]:
    header = _HEADER.match(content)
    if header is None:
        raise InputError(f"{name}: its PGM header is damaged")
    width, height, most = (int(header[k]) for k in (3, 4, 5))
    _check_size(name, width, height)
    if not 0 < most < 65536:
        raise InputError(f"{name}: pixels up to {most} are not those of an image of a map")
    rest = content[_first_pixel(header, width * height * (1 if most < 256 else 2)) :]
    if header[1] == b"P2":
        cells = _plain_pixels(name, rest, width * height)
    else:
        size = width * height * (2 if most > 255 else 1)
        cells = np.frombuffer(rest[: len(rest) // 2 * 2 if most > 255 else None][:size],
                              ">u2" if most > 255 else "u1")  # fmt: skip
    if len(cells) != width * height:
        raise InputError(f"{name}: {len(cells)} pixels, fewer than {width} x {height}")
    if (largest := int(cells.max())) > most:
        raise InputError(f"{name}: a pixel is {largest}, but its header says at most {most}")
    return cells.astype(np.float64).reshape(height, width) / most


def _plain_pixels(name: str, text: bytes, count: int) -> NDArray[np.float64]:
    """Return the first numbers of a text, in which comments begin with ``#``."""
    words = re.sub(rb"#[^\n]*", b"", text).split()[:count]
    try:
        return np.array(words, np.float64)
    except ValueError:
        odd = next(word for word in words if not word.isdigit())
        raise InputError(
            f"{name}: a pixel is {odd[:20].decode(errors='replace')!r}, not a number"
        ) from None


def _first_pixel(header: re.Match[bytes], size: int) -> int:
    """Return the offset of the pixels, bytes: one blank after the header, or where the size fits.

    Programs of Windows end the header with two characters, and some with a comment.
    """
    content = header.string
    tail = re.compile(rb"\n|[ \t]*#[^\n]*\n").match(content, header.end())
    if header[1] == b"P5" and tail is not None and len(content) - tail.end() == size:
        return tail.end()
    return header.end()


def _check_size(name: str, width: int, height: int) -> None:
    """Refuse an image without pixels, or with too many, before they are unpacked.

    Raises:
        InputError: that is so.
    """
    if not 0 < width * height <= MOST_PIXELS:
        raise InputError(f"{name}: {width} x {height} pixels are not an image of a map")


def _opened(file: Path, kind: str) -> Any:
    """Return the first picture of an image file, unpacked.

    Raises:
        InputError: it is damaged, or has no pixels or too many.
    """
    from PIL import Image

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # its size is checked below
            with Image.open(file, formats=[kind]) as image:
                _check_size(file.name, *image.size)
                image.load()
                frames = getattr(image, "n_frames", 1)
                found = image.copy()
    except (MemoryError, InputError):
        raise
    except Image.DecompressionBombError:
        raise InputError(f"{file.name}: its pixels are too many for an image of a map") from None
    except Exception as error:  # its decoders raise many types
        raise InputError(f"{file.name}: is a damaged {kind} image: {error}") from error
    if frames > 1:
        _LOG.warning("%s: has %d pictures; the first is read", file.name, frames)
    if kind == "JPEG":
        _LOG.warning(
            "%s: is a JPEG, whose greys are not exact: cells of unknown (205) can become free, and "
            "edges ragged; save maps as PNG", file.name,
        )  # fmt: skip
    return found


def _grey(name: str, image: Any, alpha: Alpha) -> NDArray[np.float64]:
    """Return the mean of a pixel's colours, as nav2's map server takes it.

    Raises:
        InputError: its pixels are other numbers than greys and colours.
    """
    if image.mode in _SIXTEEN_BITS:
        return np.asarray(image, np.float64) / 65535.0
    if image.mode not in _COLOURS:
        raise InputError(
            f"{name}: its pixels are numbers of another kind ({image.mode}) than greys and colours "
            f"of 8 or 16 bits: {_CONVERT.format(name)}"
        )
    see_through = image.mode in ("LA", "PA", "RGBA") or "transparency" in image.info
    values = np.asarray(image.convert("RGBA" if see_through else "RGB"), np.float64) / 255.0
    if see_through and alpha == "averaged":
        return np.asarray(values.mean(axis=2))
    grey = values[..., :3].mean(axis=2)
    if see_through and alpha == "unknown":
        grey = np.where(values[..., 3] < 1.0, np.nan, grey)
    return np.asarray(grey)
