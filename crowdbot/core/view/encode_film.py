"""Writes pictures as GIF, MP4, WebM or PNG."""

from __future__ import annotations

import itertools
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from PIL import Image

from crowdbot.core.view.shapes import DARK, LIGHT
from crowdbot.errors import InputError, MissingLibraryError

#: Format -> arguments of ffmpeg.
_VIDEO = {
    "mp4": ("-c:v", "libx264", "-preset", "medium", "-crf", "23", "-movflags", "+faststart"),
    "webm": ("-c:v", "libvpx-vp9", "-b:v", "0", "-crf", "34", "-row-mt", "1"),
}
_GAP = 8  # px between pictures that stand side by side


def write_gif(path: Path, images: Iterable[Image.Image], rate: float) -> None:
    """Write an endless GIF; all pictures share the colours of the first."""
    pictures = iter(images)
    first = next(pictures)
    palette = _palette(first)
    small = (
        image.quantize(palette=palette, dither=Image.Dither.NONE)
        for image in itertools.chain((first,), pictures)
    )
    shown = round(1000.0 / rate / 10.0) * 10  # GIF counts hundredths of a second
    next(small).save(
        path, save_all=True, append_images=small, duration=max(20, shown), loop=0,
        optimize=False, disposal=1,
    )  # fmt: skip


def _palette(image: Image.Image) -> Image.Image:
    """Return the colours of an image and of everything that may appear later."""
    later = sorted({*LIGHT.values(), *DARK.values()})
    swatch = max(8, image.height // 16)
    whole = Image.new("RGB", (image.width, image.height + swatch), "white")
    whole.paste(image, (0, 0))
    step = image.width // len(later)
    for i, colour in enumerate(later):
        whole.paste(colour, (i * step, image.height, (i + 1) * step, image.height + swatch))
    return whole.quantize(255, dither=Image.Dither.NONE)


def write_video(path: Path, images: Iterable[Image.Image], rate: float) -> None:
    """Write a film with ffmpeg; the suffix says the format.

    Raises:
        MissingLibraryError: there is no ffmpeg.
        InputError: ffmpeg failed; with its last line.
    """
    encoder, pictures = _ffmpeg(), iter(images)
    first = next(pictures)
    width, height = first.size
    command = [
        encoder, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24",
        "-s", f"{width}x{height}", "-r", f"{rate:g}", "-i", "-", "-an",
        *_VIDEO[path.suffix.removeprefix(".")], "-pix_fmt", "yuv420p",
        "-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact", str(path),
    ]  # fmt: skip
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=output)
        assert process.stdin is not None
        try:
            for image in itertools.chain((first,), pictures):  # a minute is gigabytes
                process.stdin.write(np.asarray(image).tobytes())
        except BrokenPipeError:  # it has ended; it says why
            pass
        finally:
            process.stdin.close()
            process.wait()
        output.seek(0)
        lines = output.read().decode(errors="replace").strip().splitlines()
    if process.returncode:
        raise InputError(f"{path}: ffmpeg failed: {lines[-1] if lines else process.returncode}")


def _ffmpeg() -> str:
    """Return the path of ffmpeg: of the package, else the system's.

    Raises:
        MissingLibraryError: there is none.
    """
    try:
        import imageio_ffmpeg

        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except (ImportError, RuntimeError):  # the package has no ffmpeg for some machines
        found = shutil.which("ffmpeg")
        if found is None:
            raise MissingLibraryError(
                "films need ffmpeg; install it with pip install 'crowdbot[film]', or write a .gif"
            ) from None
        return found


def write_png(path: Path, images: Sequence[Image.Image]) -> None:
    """Write pictures side by side."""
    width = sum(image.width for image in images) + _GAP * (len(images) - 1)
    whole = Image.new("RGB", (width, max(image.height for image in images)), "white")
    left = 0
    for image in images:
        whole.paste(image, (left, 0))
        left += image.width + _GAP
    whole.save(path, optimize=True)
