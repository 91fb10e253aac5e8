"""A small figure as SVG: axes with ticks, lines, bands, marks, bodies seen from above."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from html import escape

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

WIDTH, HEIGHT = 440, 216
_LEFT, _RIGHT, _TOP, _BOTTOM = 46, 10, 40, 36
#: Colours that differ for all kinds of colour blindness (Okabe and Ito 2008), darkened on white.
ROBOT, PERSON, WITHOUT, BAD, QUIET = "#b34700", "#0a6aa6", "#6b6b6b", "#a3195b", "#9aa7b4"
BAND = "#f3e3a2"


class Figure:
    """What is drawn, in order; coordinates are data, x to the right and y up."""

    def __init__(
        self,
        title: str,
        x: tuple[str, float, float],
        y: tuple[str, float, float],
        *,
        equal: bool = False,
    ) -> None:
        """Axes, each with a label and its ends; ``equal``: one metre is as long on both."""
        self.title, self._x, self._y = title, x[0], y[0]
        self._low = np.array([x[1], y[1]])
        span = np.maximum(np.array([x[2], y[2]]) - self._low, 1e-9)
        room = np.array([WIDTH - _LEFT - _RIGHT, HEIGHT - _TOP - _BOTTOM], dtype=float)
        self._scale = room / span
        if equal:
            self._scale[:] = self._scale.min()
        self._size = self._scale * span
        self._shapes: list[str] = []
        self._keys: list[tuple[str, str]] = []
        #: Bars have names in place of ticks.
        self.bare = False

    def line(
        self, x: Array, y: Array, colour: str, label: str = "", *, dashed: bool = False,
        wide: float = 1.5,
    ) -> Figure:  # fmt: skip
        """A line that is interrupted where there is no value."""
        self._key(colour, label + (" (dashed)" if dashed and label else ""))
        dash = ' stroke-dasharray="5 3"' if dashed else ""
        d = "".join(self._pieces(np.asarray(x, float), np.asarray(y, float)))
        self._shapes.append(
            f'<path d="{d}" fill="none" stroke="{colour}" stroke-width="{wide:g}"{dash}/>'
        )
        return self

    def area(
        self, x: Array, low: Array, high: Array, label: str = "", colour: str = BAND
    ) -> Figure:
        """What lies between two lines, where the second is above the first."""
        self._key(colour, label)
        above = np.where(np.isfinite(high) & np.isfinite(low), np.maximum(high, low), low)
        points = [*zip(x, above, strict=True), *zip(x[::-1], low[::-1], strict=True)]
        text = " ".join(self._at(a, b) for a, b in points if math.isfinite(b))
        self._shapes.append(f'<polygon points="{text}" fill="{colour}" stroke="none"/>')
        return self

    def spans(self, x: Array, on: NDArray[np.bool_], label: str = "") -> Figure:
        """Bands over the whole height while something holds; ``on`` belongs to samples."""
        self._key(BAND, label)
        edge = np.diff(np.concatenate([[0], on.astype(int), [0]]))
        begins, ends = np.flatnonzero(edge > 0), np.flatnonzero(edge < 0)
        for a, b in zip(begins.tolist(), ends.tolist(), strict=True):
            self.band(float(x[a]), float(x[min(b, len(x) - 1)]))
        return self

    def band(self, left: float, right: float, colour: str = BAND, label: str = "") -> Figure:
        """One band over the whole height."""
        self._key(colour, label)
        x, width = self._pixel(left, 0)[0], max((right - left) * self._scale[0], 1.2)
        self._shapes.append(
            f'<rect x="{x:.1f}" y="{_TOP}" width="{width:.1f}" height="{self._size[1]:.1f}" '
            f'fill="{colour}"/>'
        )
        return self

    def level(self, y: float, label: str, colour: str = QUIET) -> Figure:
        """A dashed line across, with its name."""
        x0, py = _LEFT, self._pixel(0, y)[1]
        self._shapes.append(
            f'<path d="M{x0} {py:.1f}h{self._size[0]:.0f}" stroke="{colour}" '
            'stroke-dasharray="2 3" fill="none"/>'
            f'<text x="{x0 + self._size[0] - 3:.0f}" y="{py - 3:.1f}" text-anchor="end" '
            f'fill="#444" stroke="#fff" stroke-width="3" '
            f'paint-order="stroke">{escape(label)}</text>'
        )
        return self

    def dots(self, x: Sequence[float] | Array, y: Sequence[float] | Array, colour: str,
             label: str = "", radius: float = 3.5) -> Figure:  # fmt: skip
        """Marks at points."""
        self._key(colour, label)
        for a, b in zip(x, y, strict=True):
            px, py = self._pixel(float(a), float(b))
            self._shapes.append(
                f'<circle cx="{px:.1f}" cy="{py:.1f}" r="{radius:g}" fill="{colour}"/>'
            )
        return self

    def disc(self, x: float, y: float, radius: float, colour: str, *, full: bool = True) -> Figure:
        """A body of a radius in m."""
        px, py = self._pixel(x, y)
        fill = f'fill="{colour}" fill-opacity="0.75"' if full else 'fill="none"'
        self._shapes.append(
            f'<circle cx="{px:.1f}" cy="{py:.1f}" r="{radius * self._scale[0]:.1f}" {fill} '
            f'stroke="{colour}"/>'
        )
        return self

    def bars(self, names: Sequence[str], values: Sequence[float], colours: Sequence[str]) -> Figure:
        """Bars from 0 up, one a whole number of x, with their names below and values above."""
        base = self._pixel(0, 0)[1]
        for i, (name, value, colour) in enumerate(zip(names, values, colours, strict=True)):
            px, py = self._pixel(i, value)
            self._shapes.append(
                f'<rect x="{px - 17:.1f}" y="{min(py, base):.1f}" width="34" '
                f'height="{abs(base - py):.1f}" fill="{colour}"/>'
                f'<text x="{px:.1f}" y="{py - 3:.1f}" text-anchor="middle">{number(value)}</text>'
                f'<text x="{px:.1f}" y="{base + 12:.1f}" text-anchor="middle">{escape(name)}</text>'
            )
        return self

    def svg(self) -> str:
        """The whole file."""
        x_ticks = not self.bare
        top = _TOP + self._size[1]
        frame = (
            f'<rect x="{_LEFT}" y="{_TOP}" width="{self._size[0]:.1f}" '
            f'height="{self._size[1]:.1f}" fill="none" stroke="#888" stroke-width="0.7"/>'
        )
        x_label = (
            f'<text x="{_LEFT + self._size[0] / 2:.0f}" y="{top + 29:.0f}" '
            f'text-anchor="middle">{escape(self._x)}</text>'
        )
        middle = _TOP + self._size[1] / 2
        y_label = (
            f'<text transform="translate(11 {middle:.0f}) rotate(-90)" text-anchor="middle">'
            f"{escape(self._y)}</text>"
        )
        height = math.ceil(top + _BOTTOM)
        clip = (
            f'<clipPath id="c"><rect x="{_LEFT}" y="{_TOP}" width="{self._size[0]:.1f}" '
            f'height="{self._size[1] + (0 if x_ticks else 16):.1f}"/></clipPath>'
        )
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" '
            f'viewBox="0 0 {WIDTH} {height}" role="img" font-family="sans-serif" font-size="10">\n'
            f'<title>{escape(self.title)}</title><rect width="100%" height="100%" fill="#fff"/>'
            f'{clip}\n<text x="{_LEFT}" y="14" font-size="12" font-weight="bold">'
            f"{escape(self.title)}</text>\n{self._legend()}\n"
            f'<g clip-path="url(#c)">' + "\n".join(self._shapes) + "</g>\n"
            f"{frame}{''.join(self._ticks(x_ticks))}{x_label}{y_label}\n</svg>\n"
        )

    def _key(self, colour: str, label: str) -> None:
        if label and (colour, label) not in self._keys:
            self._keys.append((colour, label))

    def _legend(self) -> str:
        """Squares with words in one row above the axes."""
        x, parts = float(_LEFT), []
        for colour, label in self._keys:
            parts.append(
                f'<rect x="{x:.0f}" y="25" width="9" height="9" fill="{colour}"/>'
                f'<text x="{x + 13:.0f}" y="33">{escape(label)}</text>'
            )
            x += 13 + 5.1 * len(label) + 12
        return "".join(parts)

    def _ticks(self, x_ticks: bool) -> Iterator[str]:
        high = self._low + self._size / self._scale
        bottom = _TOP + self._size[1]
        for value in _round_numbers(self._low[0], high[0]) if x_ticks else ():
            px = self._pixel(value, 0)[0]
            yield (
                f'<path d="M{px:.1f} {bottom:.1f}v4" stroke="#888"/>'
                f'<text x="{px:.1f}" y="{bottom + 14:.1f}" text-anchor="middle">{value:g}</text>'
            )
        for value in _round_numbers(self._low[1], high[1], 4):
            py = self._pixel(0, value)[1]
            yield (
                f'<path d="M{_LEFT - 4} {py:.1f}h4" stroke="#888"/>'
                f'<text x="{_LEFT - 6}" y="{py + 3.5:.1f}" text-anchor="end">{_short(value)}</text>'
            )

    def _pieces(self, x: Array, y: Array) -> Iterator[str]:
        """Path data: absolute where a piece begins, then steps in tenths of a pixel."""
        px, py = (
            _LEFT + (x - self._low[0]) * self._scale[0],
            _TOP + self._size[1] - (y - self._low[1]) * self._scale[1],
        )
        last: tuple[int, int] | None = None
        for a, b in zip(px, py, strict=True):
            if not (math.isfinite(a) and math.isfinite(b)):
                last = None
                continue
            here = (
                round(float(np.clip(a, -2000, 4000)) * 10),
                round(float(np.clip(b, -2000, 4000)) * 10),
            )
            if last is None:
                yield f"M{here[0] / 10:g} {here[1] / 10:g}"
            elif here != last:
                yield f"l{(here[0] - last[0]) / 10:g} {(here[1] - last[1]) / 10:g}"
            last = here

    def _pixel(self, x: float, y: float) -> tuple[float, float]:
        return (
            _LEFT + (x - float(self._low[0])) * float(self._scale[0]),
            _TOP + float(self._size[1]) - (y - float(self._low[1])) * float(self._scale[1]),
        )

    def _at(self, x: float, y: float) -> str:
        px, py = self._pixel(float(x), float(y))
        return f"{px:.1f},{py:.1f}"


def number(value: float) -> str:
    """With three significant digits."""
    return f"{value:.3g}"


def _short(value: float) -> str:
    """Of a tick: thousands as k, or there is no room."""
    return f"{value / 1000:g}k" if abs(value) >= 10_000 else f"{value:g}"


def _round_numbers(low: float, high: float, wanted: int = 6) -> Array:
    """Multiples of 1, 2 or 5 times a power of ten between two ends."""
    step = 10.0 ** math.floor(math.log10((high - low) / wanted))
    step *= next(f for f in (1, 2, 5, 10) if f * step * wanted >= high - low)
    return np.round(
        np.arange(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1) * step, 9
    )
