"""Images of occupancy grids in the formats that nav2's map server reads, and what is refused."""

from __future__ import annotations

import logging
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from crowdbot.cli import main
from crowdbot.errors import InputError
from crowdbot.plugins.environments.map_image_build import read_grey

#: Free floor with walls around, a block, and cells of which nothing is known.
GREY = np.full((12, 17), 254, np.uint8)
GREY[[0, -1]] = GREY[:, [0, -1]] = 0
GREY[3:6, 4:9] = 0
GREY[8:10, 10:14] = 205
PICTURE = Image.fromarray(GREY)
WIDE = GREY.astype(np.uint16) * 257


def _text(values: np.ndarray) -> str:
    return "\n".join(" ".join(map(str, row)) for row in values.tolist())


def _chunk(kind: bytes, content: bytes) -> bytes:
    check = zlib.crc32(kind + content)
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", check)


def _interlaced() -> bytes:
    """A PNG in the seven passes of Adam7."""
    rows = b""
    for x, y, dx, dy in ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4),
                         (1, 0, 2, 2), (0, 1, 1, 2)):  # fmt: skip
        rows += b"".join(b"\0" + row.tobytes() for row in GREY[y::dy, x::dx])
    head = struct.pack(">IIBBBBB", GREY.shape[1], GREY.shape[0], 8, 0, 0, 0, 1)
    parts = ((b"IHDR", head), (b"IDAT", zlib.compress(rows)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*part) for part in parts)


_SIZE = f"{GREY.shape[1]} {GREY.shape[0]}"
SAVED: dict[str, Callable[[Path], object]] = {
    "grey.bmp": PICTURE.save,
    "colours.bmp": PICTURE.convert("RGB").save,
    "grey.gif": PICTURE.save,
    "grey.tif": PICTURE.save,
    "lzw.tiff": lambda file: PICTURE.save(file, compression="tiff_lzw"),
    "wide.tif": Image.fromarray(WIDE).save,
    "wide.png": Image.fromarray(WIDE).save,
    "palette.png": PICTURE.convert("P").save,
    "interlaced.png": lambda file: file.write_bytes(_interlaced()),
    "colours.ppm": PICTURE.convert("RGB").save,
    "lossless.webp": lambda file: PICTURE.save(file, lossless=True),
    "a.pgm": lambda file: file.write_text(f"P2 {_SIZE}\n255\n# pixels\n{_text(GREY)} # end\n"),
    "b.pgm": lambda file: file.write_bytes(
        f"P5\n# CREATOR\n{_SIZE}\n65535\n".encode() + WIDE.astype(">u2").tobytes()
    ),
    "c.ppm": lambda file: file.write_text(
        f"P3\n# c\n{_SIZE}\n255\n{_text(np.repeat(GREY, 3, axis=1))}\n"
    ),
}


@pytest.mark.parametrize("name", SAVED)
def test_every_format_has_the_same_greys(tmp_path: Path, name: str) -> None:
    SAVED[name](tmp_path / name)
    (tmp_path / "wrongly_named.png").write_bytes((tmp_path / name).read_bytes())
    for file in (tmp_path / name, tmp_path / "wrongly_named.png"):
        np.testing.assert_allclose(read_grey(file), GREY / 255.0, atol=1e-12)


def test_maxval_scales(tmp_path: Path) -> None:
    percent = np.round(GREY / 2.55).astype(np.uint8)
    (tmp_path / "a.pgm").write_text(f"P2\n{_SIZE}\n100\n{_text(percent)}\n")
    (tmp_path / "b.pgm").write_bytes(f"P5\n{_SIZE}\n100\n".encode() + percent.tobytes())
    for name in ("a.pgm", "b.pgm"):
        np.testing.assert_allclose(read_grey(tmp_path / name), percent / 100.0, atol=1e-12)


def test_a_jpeg_and_further_pictures_are_told(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    PICTURE.save(tmp_path / "a.png", format="JPEG", quality=95)
    PICTURE.save(tmp_path / "b.gif", save_all=True, append_images=[Image.new("L", PICTURE.size)])
    with caplog.at_level(logging.WARNING):
        found = read_grey(tmp_path / "a.png")
        np.testing.assert_allclose(read_grey(tmp_path / "b.gif"), GREY / 255.0, atol=1e-12)
    assert np.abs(found - GREY / 255.0).mean() < 0.02
    assert "a.png: is a JPEG, whose greys are not exact" in caplog.text
    assert "b.gif: has 2 pictures; the first is read" in caplog.text


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is empty"),
        (b"%PDF-1.4", "is a PDF document: convert it to PNG"),
        (b"<svg xmlns='a'/>", "is an SVG drawing: convert it to PNG"),
        (b"gimp xcf v011\0", "GIMP's own XCF"),
        (b"\0\0\0\x18ftypheic\0", "is a HEIF or AVIF image"),
        (b"\x1f\x8b\x08", "unpack it with gunzip"),
        (b"version https://git-lfs.github.com/spec/v1\n", "git lfs pull"),
        (b"/annex/objects/MD5E-s1--a.png\n", "git annex get"),
        (b"<!DOCTYPE html>", "is a web page"),
        (b"image: map.pgm\n", "is a map, not its picture"),
        (b"qwertyuiop", r"it begins with b'qwertyui': convert it to PNG"),
        (b"P2\n2 2\n255\n1 2 x 3", "a pixel is 'x', not a number"),
        (b"P2\n2 2\n255\n1 2 3", "3 pixels, fewer than 2 x 2"),
        (b"BM" + struct.pack("<IHHIIiiHHIIiiII", 54, 0, 0, 54, 40, 9**5, 9**5, 1, 24, *[0] * 6),
         "pixels are too many|not an image of a map"),
    ],
)  # fmt: skip
def test_what_is_no_image_is_named(tmp_path: Path, content: bytes, message: str) -> None:
    (tmp_path / "map.png").write_bytes(content)
    with pytest.raises(InputError, match=rf"map\.png: .*({message})"):
        read_grey(tmp_path / "map.png")


@pytest.mark.parametrize("kind", [np.float32, np.int32])
def test_pixels_of_other_numbers_are_refused(tmp_path: Path, kind: type[np.generic]) -> None:
    Image.fromarray(GREY.astype(kind)).save(tmp_path / "map.tif")
    with pytest.raises(InputError, match=r"numbers of another kind .* 8 or 16 bits: convert"):
        read_grey(tmp_path / "map.tif")


def test_import_says_where_an_image_belongs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    PICTURE.save(tmp_path / "map.png")
    (tmp_path / "map.pgm").write_text("P2\n1 1\n255\n0\n")
    for name in ("map.png", "map.pgm"):
        assert main(["import", str(tmp_path / name)]) == 1
        assert "is an image: a scenario reads it with the map.yaml" in capsys.readouterr().err
