"""Pictures of each robot from above, with the outline that others touch: docs/images/robots."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.registry.registry import discover
from crowdbot.core.robots.build import build_model
from crowdbot.core.robots.look import seen_from_above

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "images" / "robots"
KINDS = ("turtlebot2", "pepper", "qolo", "cuybot", "smart_wheelchair")
_SCALE = 200.0  # pixels a metre
_MARGIN = 0.12  # m


def picture(kind: str) -> str:
    """The picture as SVG text: x of the robot to the right, y up; a bar of 0.5 m below."""
    registry = discover(allow=())
    model = build_model(registry, registry.find("robot", kind).spec())
    body = footprint_of_model(model)
    axis = body.corners if len(body.corners) else np.zeros((1, 2))
    low, high = axis.min(axis=0) - body.radius - _MARGIN, axis.max(axis=0) + body.radius + _MARGIN
    low[1] -= 0.08
    width, height = _SCALE * (high - low)

    def points(outline: NDArray[np.float64]) -> str:
        return " ".join(
            f"{_SCALE * (x - low[0]):.1f},{_SCALE * (high[1] - y):.1f}" for x, y in outline
        )

    shapes = [
        f'<polygon points="{points(part.outline)}" fill="{part.colour}" stroke="#222" '
        'stroke-width="0.7"/>'
        for part in seen_from_above(model)
    ]
    outline = points(_outline(axis, body.radius))
    bar = f'<path d="M {_SCALE * _MARGIN:.0f} {height - 14:.0f} h {0.5 * _SCALE:.0f}"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
        f'viewBox="0 0 {width:.0f} {height:.0f}" font-family="sans-serif" font-size="11">\n'
        '<rect width="100%" height="100%" fill="#fff"/>\n'
        f'<polygon points="{outline}" fill="#eef2f7" stroke="#3b6ea5" stroke-dasharray="4 3"/>\n'
        + "\n".join(shapes)
        + f'\n{bar} stroke="#222" stroke-width="2"/>'
        f'<text x="{_SCALE * (_MARGIN + 0.52):.0f}" y="{height - 10:.0f}">0.5 m</text>\n</svg>\n'
    )


def _outline(axis: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    """A disc, a capsule or a polygon as a polygon."""
    if len(axis) > 2:
        return axis
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 33)
    half = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    front, rear = axis[np.argmax(axis[:, 0])], axis[np.argmin(axis[:, 0])]
    return np.concatenate([front + half, rear - half])


def pictures() -> dict[Path, str]:
    """Return file -> picture of every robot."""
    return {FOLDER / f"{kind}.svg": picture(kind) for kind in KINDS}
