"""A drawing as pixels by Pillow: quick enough for the hundreds of pictures of a film."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import lru_cache
from itertools import pairwise
from pathlib import Path as File

import matplotlib as mpl
from PIL import Image, ImageColor, ImageDraw, ImageFont

from crowdbot.core.types.arrays import Point
from crowdbot.core.view.shapes import LIGHT, STYLES, Disc, Drawing, Path, Shape, Text

#: Shapes are drawn this much larger, then reduced, which smooths their edges.
_FINER = 2
_Colour = tuple[int, int, int, int]
_FONTS = File(mpl.get_data_path()) / "fonts" / "ttf"


def to_image(
    drawing: Drawing, colours: Mapping[str, str] = LIGHT, ground: Image.Image | None = None
) -> Image.Image:
    """Return an image of the drawing's size.

    Args:
        colours: `LIGHT` or `DARK`.
        ground: what `ground_of` returns for the same size: the shapes are painted over it.
    """
    size = _even(drawing.width), _even(drawing.height)
    large = ground.copy() if ground is not None else ground_of(drawing, colours, ())
    _paint(large, drawing.shapes, drawing.map_box, colours)
    return large.resize(size, Image.Resampling.BOX)


def ground_of(
    drawing: Drawing, colours: Mapping[str, str], shapes: tuple[Shape, ...]
) -> Image.Image:
    """Return the large image of shapes that stay the same in all pictures of a film."""
    size = _FINER * _even(drawing.width), _FINER * _even(drawing.height)
    image = Image.new("RGB", size, colours["page"])
    _paint(image, shapes, drawing.map_box, colours)
    return image


def _even(pixels: float) -> int:
    """Return a size that video encoders accept."""
    return max(2, 2 * round(pixels / 2))


def _paint(
    image: Image.Image,
    shapes: tuple[Shape, ...],
    box: tuple[float, float, float, float],
    colours: Mapping[str, str],
) -> None:
    x, y, width, height = (round(_FINER * v) for v in box)
    inner = image.crop((x, y, x + width, y + height))
    pens = {False: ImageDraw.Draw(image, "RGBA"), True: ImageDraw.Draw(inner, "RGBA")}
    origins = {False: (0.0, 0.0), True: (float(x), float(y))}
    pasted = False
    for shape in shapes:
        inside = not isinstance(shape, Text) and shape.inside
        if not inside and not pasted and isinstance(shape, Text):
            image.paste(inner, (x, y))  # texts stand over the map
            pasted = True
        at = origins[inside and not pasted]
        _draw(pens[inside and not pasted], shape, at, colours)
    if not pasted:
        image.paste(inner, (x, y))


def _draw(
    pen: ImageDraw.ImageDraw, shape: Shape, origin: Point, colours: Mapping[str, str]
) -> None:
    look = STYLES[shape.role]
    fill = _colour(colours, look.fill, look.opacity)
    stroke = _colour(colours, look.stroke, 1.0 if look.fill else look.opacity)
    width = max(1, round(_FINER * look.width))
    if isinstance(shape, Text):
        x, y = _at(shape.at, origin)
        anchor = {"start": "ls", "middle": "ms", "end": "rs"}[shape.anchor]
        pen.text((x, y), shape.text, fill, _font(shape.size, look.bold), anchor)
    elif isinstance(shape, Disc):
        x, y = _at(shape.centre, origin)
        pen.circle((x, y), _FINER * shape.radius, fill, stroke, width if stroke else 0)
    else:
        _path(pen, shape, [_at(p, origin) for p in shape.points], (fill, stroke, width, look.dash))


def _path(
    pen: ImageDraw.ImageDraw,
    shape: Path,
    points: list[Point],
    look: tuple[_Colour | None, _Colour | None, int, tuple[float, ...]],
) -> None:
    fill, stroke, width, dash = look
    if shape.closed and len(points) > 2:
        pen.polygon(points, fill)
        points = [*points, points[0]]
    if stroke is None or len(points) < 2:
        return
    for part in _dashed(points, [_FINER * d for d in dash]) if dash else [points]:
        pen.line(part, stroke, width, joint="curve")


def _dashed(points: list[Point], dash: list[float]) -> Iterator[list[Point]]:
    """Yield the pieces of a dashed line."""
    step, left, on = 0, dash[0], True
    for (x0, y0), (x1, y1) in pairwise(points):
        length, done = math.hypot(x1 - x0, y1 - y0), 0.0
        while done < length:
            here = min(left, length - done)
            ends = [done / length, (done + here) / length]
            if on:
                yield [(x0 + f * (x1 - x0), y0 + f * (y1 - y0)) for f in ends]
            done, left = done + here, left - here
            if left <= 0.0:
                step, on = (step + 1) % len(dash), not on
                left = max(dash[step], 1.0)


def _at(point: Point, origin: Point) -> Point:
    return _FINER * point[0] - origin[0], _FINER * point[1] - origin[1]


@lru_cache(maxsize=256)
def _rgb(colour: str) -> tuple[int, int, int]:
    red, green, blue = ImageColor.getrgb(colour)[:3]
    return red, green, blue


def _colour(colours: Mapping[str, str], name: str, opacity: float) -> _Colour | None:
    return (*_rgb(colours[name]), round(255 * opacity)) if name else None


@lru_cache(maxsize=32)
def _font(size: float, bold: bool) -> ImageFont.FreeTypeFont:
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(_FONTS / name, _FINER * size)
