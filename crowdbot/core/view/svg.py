"""A drawing as SVG text with its own light and dark colours, without other files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from html import escape

from crowdbot.core.types.arrays import Point
from crowdbot.core.view.shapes import (
    DARK,
    LIGHT,
    STYLES,
    Disc,
    Drawing,
    Path,
    Shape,
    Style,
    Text,
)

FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif"


def to_svg(drawing: Drawing) -> str:
    """Return a whole file; equal drawings give equal bytes."""
    style = f"<style>{stylesheet()}</style>"
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{element(drawing, style)}\n'


def element(drawing: Drawing, style: str = "", name: str = "") -> str:
    """Return the ``svg`` element, for a standalone file or for a page with the style sheet.

    Args:
        drawing: what it shows.
        style: a ``style`` element for a standalone file.
        name: tells several elements of one page apart.
    """
    width, height = _number(drawing.width), _number(drawing.height)
    x, y, w, h = (_number(v) for v in drawing.map_box)
    lines = [
        f'<svg class="view" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'width="{width}" height="{height}" role="img" aria-labelledby="view-title{name}">',
        f'<title id="view-title{name}">{escape(drawing.title)}</title>',
        style,
        f'<clipPath id="map{name}"><rect x="{x}" y="{y}" width="{w}" height="{h}"/></clipPath>',
        *_shapes(drawing, f"map{name}"),
        "</svg>",
    ]
    return "\n".join(line for line in lines if line)


def stylesheet() -> str:
    """Return the classes of all roles; colours follow the reader's light or dark mode.

    Colours are written out, since many SVG viewers do not support variables.
    """
    rules = [
        f".view text {{ font-family: {FONT}; stroke: none; }}",
        ".view path { stroke-linejoin: round; stroke-linecap: round; }",
        *(f".view .{role} {{ {_form(look)} }}" for role, look in STYLES.items()),
    ]
    light, dark = _colours(LIGHT), _colours(DARK)
    return "\n".join([*rules, *light, "@media (prefers-color-scheme: dark) {", *dark, "}"])


def _form(look: Style) -> str:
    parts = []
    if look.opacity != 1.0:
        parts.append(f"{'fill' if look.fill else 'stroke'}-opacity: {look.opacity:g};")
    if look.stroke:
        parts.append(f"stroke-width: {look.width:g};")
    if look.dash:
        parts.append(f"stroke-dasharray: {' '.join(f'{d:g}' for d in look.dash)};")
    if look.bold:
        parts.append("font-weight: 600;")
    return " ".join(parts)


def _colours(palette: Mapping[str, str]) -> list[str]:
    """Return fill and stroke of each role, as CSS."""
    return [
        f".view .{role} {{ fill: {palette[look.fill] if look.fill else 'none'};"
        f"{f' stroke: {palette[look.stroke]};' if look.stroke else ''} }}"
        for role, look in STYLES.items()
    ]


def _shapes(drawing: Drawing, clip: str) -> Iterator[str]:
    """Yield the shapes; neighbours with the same clipping share one group."""
    open_group = False
    for shape in drawing.shapes:
        inside = not isinstance(shape, Text) and shape.inside
        if inside != open_group:
            yield f'<g clip-path="url(#{clip})">' if inside else "</g>"
            open_group = inside
        yield _shape(shape)
    if open_group:
        yield "</g>"


def _shape(shape: Shape) -> str:
    if isinstance(shape, Path):
        return f'<path class="{shape.role}" d="{_path(shape.points, closed=shape.closed)}"/>'
    if isinstance(shape, Disc):
        (x, y), radius = shape.centre, _number(shape.radius)
        start = f'<circle class="{shape.role}" cx="{_number(x)}" cy="{_number(y)}" r="{radius}"'
        return (
            f"{start}><title>{escape(shape.about)}</title></circle>"
            if shape.about
            else f"{start}/>"
        )
    x, y = shape.at
    turn = f' transform="rotate({_number(-shape.turned)} {_number(x)} {_number(y)})"'
    return (
        f'<text class="{shape.role}" x="{_number(x)}" y="{_number(y)}" '
        f'font-size="{_number(shape.size)}" text-anchor="{shape.anchor}"'
        f"{turn if shape.turned else ''}>{escape(shape.text)}</text>"
    )


def _path(points: tuple[Point, ...], *, closed: bool) -> str:
    steps = " L".join(f"{_number(x)} {_number(y)}" for x, y in points)
    return f"M{steps}{' Z' if closed else ''}"


def _number(value: float) -> str:
    return f"{round(value, 2) + 0.0:g}" if abs(value) < 1000 else f"{round(value, 1):.1f}"
