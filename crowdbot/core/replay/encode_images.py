"""Pack camera images: 255 colours or distances, and changes from image to image."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.recording.reading.images import ReplayImages
from crowdbot.core.replay.pack import deflate

#: Largest size in base64 of all images of a run; beyond, every second image is dropped, and so on.
BUDGET = 130_000
_COLOURS = 255
_BITS = 4  # bits per channel that distinguish colours


def encode_images(cameras: Sequence[ReplayImages]) -> tuple[dict[str, Any], dict[str, str]]:
    """Return size, stamps and palette of each camera; pixels are indices, XORed between images."""
    every = 1
    while True:
        packed = [_packed(camera, every) for camera in cameras]
        alone = all(len(about["t"]) == 1 for about, _ in packed)
        if alone or sum(len(text) for _, text in packed) <= BUDGET:
            break
        every *= 2
    blobs = {f"images{i}": text for i, (_, text) in enumerate(packed)}
    return {"cameras": [about for about, _ in packed]}, blobs


def _packed(camera: ReplayImages, every: int) -> tuple[dict[str, Any], str]:
    pixels = camera.pixels[::every]
    indices, palette, far = _depths(pixels) if camera.kind == "depth" else _colours(pixels)
    changes = indices.copy()
    changes[1:] ^= indices[:-1]
    about = {
        "sensor": camera.sensor,
        "kind": camera.kind,
        "height": indices.shape[1],
        "width": indices.shape[2],
        "t": np.round(camera.t[::every], 6).tolist(),
        "palette": palette,
        "far": far,
    }
    return about, deflate(changes.tobytes())


def _depths(millimetres: NDArray[Any]) -> tuple[NDArray[np.uint8], list[int], float | None]:
    """Return depths as fractions of the largest one (m) in whole steps; 0 if not measured."""
    far = max(int(millimetres.max()), 1)
    steps = np.ceil(millimetres * (_COLOURS / far)).astype(np.uint8)
    return steps, [], far / 1000.0


def _colours(pixels: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], list[int], float | None]:
    """Return the most frequent colours, and the nearest of them for all others."""
    coarse = pixels.astype(np.int64) >> (8 - _BITS)
    codes = (coarse[..., 0] << 2 * _BITS) | (coarse[..., 1] << _BITS) | coarse[..., 2]
    counts = np.bincount(codes.ravel(), minlength=1 << 3 * _BITS)
    commonest = np.argsort(-counts, kind="stable")[: min(_COLOURS, int((counts > 0).sum()))]
    every = np.arange(len(counts))
    parts = np.stack([every >> 2 * _BITS, every >> _BITS, every], axis=1) & ((1 << _BITS) - 1)
    apart = ((parts[:, None] - parts[commonest][None]) ** 2).sum(axis=2)
    nearest = apart.argmin(axis=1).astype(np.uint8)
    shades = parts[commonest] * 255 // ((1 << _BITS) - 1)
    return nearest[codes], shades.ravel().tolist(), None
