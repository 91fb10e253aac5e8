"""A drawing as PNG by matplotlib's Agg renderer, in the light colours."""

from __future__ import annotations

import io
from typing import Literal

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Polygon, Rectangle
from matplotlib.text import Text as Label

from crowdbot.core.view.shapes import LIGHT, STYLES, Disc, Drawing, Path, Style, Text

#: Pixels of the image per pixel of the drawing.
SCALE = 2.0
_INCH = 100.0  # px of the drawing per inch; points are 1/72 inch
_POINT = 72.0 / _INCH


def to_png(drawing: Drawing) -> bytes:
    """Return the PNG image; equal drawings give equal bytes with the same version of matplotlib."""
    figure = Figure(figsize=(drawing.width / _INCH, drawing.height / _INCH), dpi=_INCH * SCALE)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    axes.set_xlim(0.0, drawing.width)
    axes.set_ylim(drawing.height, 0.0)
    x, y, width, height = drawing.map_box
    box = Rectangle((x, y), width, height, transform=axes.transData)
    for order, shape in enumerate(drawing.shapes):
        artist = _artist(shape)
        artist.set_zorder(order)
        axes.add_artist(artist)
        if not isinstance(shape, Text) and shape.inside:
            artist.set_clip_path(box)
        else:
            artist.set_clip_on(False)
    stream = io.BytesIO()
    figure.savefig(stream, format="png", facecolor=LIGHT["page"], metadata={"Software": None})
    return stream.getvalue()


def _artist(shape: Path | Disc | Text) -> Line2D | Polygon | Circle | Label:
    look = STYLES[shape.role]
    if isinstance(shape, Text):
        return _label(shape, look)
    stroke = LIGHT[look.stroke] if look.stroke else "none"
    width = look.width * _POINT
    dashes: tuple[float, tuple[float, ...]] | Literal["solid"] = "solid"
    if look.dash:  # matplotlib measures dashes in line widths
        dashes = (0.0, tuple(d / look.width for d in look.dash))
    if isinstance(shape, Path) and not shape.closed:
        xs, ys = zip(*shape.points, strict=True)
        return Line2D(
            xs, ys, color=stroke, linewidth=width, linestyle=dashes,
            solid_capstyle="round", solid_joinstyle="round",
            alpha=None if look.fill else look.opacity,
        )  # fmt: skip
    face = to_rgba(LIGHT[look.fill], look.opacity) if look.fill else "none"
    if isinstance(shape, Disc):
        return Circle(
            shape.centre, shape.radius, facecolor=face, edgecolor=stroke,
            linewidth=width, linestyle=dashes,
        )  # fmt: skip
    return Polygon(
        shape.points, closed=True, facecolor=face, edgecolor=stroke, linewidth=width,
        linestyle=dashes,
    )  # fmt: skip


def _label(shape: Text, look: Style) -> Label:
    sides: dict[str, Literal["left", "center", "right"]]
    sides = {"start": "left", "middle": "center", "end": "right"}
    return Label(
        *shape.at, shape.text, color=LIGHT[look.fill], fontsize=shape.size * _POINT,
        fontweight="bold" if look.bold else "normal", fontfamily="DejaVu Sans",
        horizontalalignment=sides[shape.anchor], verticalalignment="baseline",
        rotation=shape.turned, rotation_mode="anchor", parse_math=False,
    )  # fmt: skip
