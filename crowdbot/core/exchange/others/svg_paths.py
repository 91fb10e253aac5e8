"""Points of SVG shapes: rectangles, circles, polygons and paths."""

from __future__ import annotations

import math
import re

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.others.shapes import Corners
from crowdbot.core.exchange.report import Report

_NUMBER = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_TOKEN = re.compile(rf"([A-Za-z])|({_NUMBER})|[\s,]+|(.)", re.DOTALL)
#: Command -> how many numbers each of its steps has.
_NUMBERS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7}
_ROUND = 16


def points_of(item: Item, report: Report) -> Corners:
    """Return the corners or way points of a drawn element, m.

    Raises:
        SpecError: E402, an attribute is missing or cannot be read.
    """
    if item.name == "rect":
        x, y = (_or_zero(item, name) for name in ("@x", "@y"))
        w, h = item.need("@width").number(1e-9), item.need("@height").number(1e-9)
        return [[x, y], [x + w, y], [x + w, y + h], [x, y + h]]
    if item.name in ("circle", "ellipse"):
        rx = item.need("@r" if item.name == "circle" else "@rx").number(1e-9)
        ry = item.need("@r" if item.name == "circle" else "@ry").number(1e-9)
        x, y = _or_zero(item, "@cx"), _or_zero(item, "@cy")
        turns = [2.0 * math.pi * k / _ROUND for k in range(_ROUND)]
        return [[x + rx * math.cos(a), y + ry * math.sin(a)] for a in turns]
    if item.name == "line":
        ends = [(item.need(f"@x{k}").number(), item.need(f"@y{k}").number()) for k in (1, 2)]
        return [list(end) for end in ends]
    if item.name in ("polygon", "polyline"):
        given = item.need("@points")
        numbers = [float(text) for text in re.findall(_NUMBER, given.text())]
        return [list(p) for p in zip(numbers[::2], numbers[1::2], strict=False)]
    return _path(item.need("@d"), report)


def _or_zero(item: Item, name: str) -> float:
    part = item.find(name)
    return part.number() if part else 0.0


def _path(item: Item, report: Report) -> Corners:
    command = ""
    numbers: list[float] = []
    at, start, points = [0.0, 0.0], [0.0, 0.0], []
    curved = False
    for letter, value, other in _TOKEN.findall(item.text()):
        if other or (letter and letter.upper() not in {**_NUMBERS, "Z": 0}):
            item.refuse(f"a path with {other or letter!r}, which is not a command")
        if letter:
            if numbers:
                item.refuse(f"a path whose '{command}' lacks numbers")
            command = letter
            if letter.upper() == "Z":
                at = list(start)
        elif value:
            if not command or command.upper() == "Z":
                item.refuse("a path with numbers before a command")
            numbers.append(Item(item.name, item.mark, value).number())
            if len(numbers) == _NUMBERS[command.upper()]:
                at = _step(command, numbers, at)
                curved = curved or command.upper() in "CSQTA"
                if command in "Mm":
                    start, command = list(at), "L" if command == "M" else "l"
                points.append(list(at))
                numbers = []
    if numbers:
        item.refuse(f"a path whose '{command}' lacks numbers")
    if curved:
        report.interpreted(item, "points", "curves are taken as straight lines between their ends")
    return points


def _step(command: str, numbers: list[float], at: list[float]) -> list[float]:
    base = at if command.islower() else [0.0, 0.0]
    kind = command.upper()
    if kind == "H":
        return [base[0] + numbers[0], at[1]]
    if kind == "V":
        return [at[0], base[1] + numbers[0]]
    return [base[0] + numbers[-2], base[1] + numbers[-1]]
