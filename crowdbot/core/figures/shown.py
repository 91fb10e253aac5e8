"""Simplified figures for web pages: few triangles, one colour per vertex, whole millimetres."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.figures.figure import Figure, FigurePart
from crowdbot.core.types.arrays import Array

#: Corners nearer together than this become one, of a figure 1 m high, m.
_CELL = 0.012


def shown_figure(figure: Figure) -> dict[str, Any]:
    """Return a figure for JSON, of 1000 mm height.

    Returns:
        ``colours``: ``rrggbb`` of each corner, in one text; ``triangles``: rows of corners, flat;
        ``phases``: x, y, z of the corners in each phase, flat, mm.
    """
    points = [np.concatenate([part.points for part in phase]) for phase in figure.phases]
    starts = np.cumsum([0, *(len(part.points) for part in figure.phases[0])])
    triangles = np.concatenate(
        [p.triangles + start for p, start in zip(figure.phases[0], starts, strict=False)]
    )
    colours = np.concatenate([_colours(part) for part in figure.phases[0]])
    kept, merged = _merged(points[0])
    rows = merged[triangles]
    whole = (rows[:, 0] != rows[:, 1]) & (rows[:, 1] != rows[:, 2]) & (rows[:, 2] != rows[:, 0])
    return {
        "colours": "".join(f"{r:02x}{g:02x}{b:02x}" for r, g, b in colours[kept].tolist()),
        "triangles": rows[whole].ravel().tolist(),
        "phases": [np.rint(1000.0 * p[kept]).astype(int).ravel().tolist() for p in points],
    }


def _merged(points: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Merge close points: return rows of those kept, and for each point its row among these."""
    cells = np.round(points / _CELL).astype(np.int64)
    _, kept, merged = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    return kept, merged.ravel()


def _colours(part: FigurePart) -> NDArray[np.uint8]:
    """Return the colour (N, 3) of each corner, from the texture if there is one."""
    plain = np.rint(255.0 * np.clip(part.colour, 0.0, 1.0)).astype(np.uint8)
    if part.uv is None or not part.texture:
        return np.tile(plain, (len(part.points), 1))
    from PIL import Image

    pixels = np.asarray(Image.open(BytesIO(part.texture)))
    high, wide = pixels.shape[:2]
    columns = np.floor(np.mod(part.uv[:, 0], 1.0) * wide).astype(int) % wide
    rows = np.floor(np.mod(part.uv[:, 1], 1.0) * high).astype(int) % high
    return np.asarray(pixels[rows, columns, :3])
