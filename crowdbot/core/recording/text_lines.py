"""Texts as line segments on the floor, for viewers that cannot draw letters."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from crowdbot.core.types.arrays import Array

#: Size of the letters, m.
_SIZE = 0.3


def text_lines(columns: Array, texts: Sequence[str]) -> Array:
    """Return the outlines of texts, read from where the robot starts: lines (2, M, 2), m.

    Args:
        columns: (2, K) x, y of the middle of each text, m.
        texts: K of them.
    """
    found = [np.zeros((2, 0, 2))]
    for place, text in zip(columns[:2].T, texts, strict=True):
        found.append(_outlines(text) + place)
    return np.concatenate(found, axis=1)


@lru_cache(maxsize=1000)
def _outlines(text: str) -> Array:
    """Return the lines of a text whose middle is at 0, 0: letters upright along x."""
    from matplotlib.font_manager import FontProperties  # slow to import
    from matplotlib.path import Path
    from matplotlib.textpath import text_to_path

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # letters that its font lacks are boxes
        corners, codes = text_to_path.get_text_path(FontProperties(), text, ismath=False)
    if not len(corners):
        return np.zeros((2, 0, 2))
    outlines = Path(np.asarray(corners), codes).to_polygons(closed_only=False)
    scale = _SIZE / text_to_path.FONT_SCALE
    lines = [scale * np.asarray(line, np.float64) for line in outlines]
    ends = np.concatenate([np.stack([line[:-1], line[1:]]) for line in lines], axis=1)
    middle = 0.5 * (ends.min(axis=(0, 1)) + ends.max(axis=(0, 1)))
    right, up = np.moveaxis(ends - middle, -1, 0)
    return np.stack([up, -right], axis=-1)
