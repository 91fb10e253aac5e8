"""Convert explicit agents in CSV to a list node; every cell knows its position.

The first line names the columns, which are the fields of an agent. A number is in SI units, text
such as ``80 cm/s`` has its own; an empty cell is a missing field. ``goals`` holds points as ``x y;
x y``, ``portals`` two names as ``a>b``. Lines that begin with ``#`` are comments. A spreadsheet may
separate cells by semicolons or tabs, with decimal commas.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from crowdbot.dsl.scenario.spawning import Agent
from crowdbot.dsl.text.diagnostics import Diagnostic, Mark, Source
from crowdbot.dsl.text.nodes import Entry, Node, Scalar
from crowdbot.errors import did_you_mean, nearest

#: Separator of cells -> a cell, in quotes or not, and what follows it.
_CELLS = {
    mark: re.compile(rf'[{blank}]*(?:"((?:[^"]|"")*)"|([^{mark}"]*?))[{blank}]*({mark}|$)')
    for mark, blank in ((",", r" \t"), (";", r" \t"), ("\t", " "))
}
_DECIMAL_COMMA = re.compile(r"(?<![\d,])([-+]?\d+),(\d+)(?![\d,])")
_INT = re.compile(r"[-+]?(?:0|[1-9][0-9]{0,18})")
_FLOAT = re.compile(r"[-+]?(?:(?:0|[1-9][0-9]*)(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
_TEXT_COLUMNS = ("policy", "at_goal", "look")
_REQUIRED = tuple(name for name, info in Agent.model_fields.items() if info.is_required())


@dataclass(frozen=True, slots=True)
class _Cell:
    text: str
    mark: Mark


def read_agents(text: str, source: Source, problems: list[Diagnostic]) -> Node:
    """Return the rows as a list of maps, as if they were written in the document.

    Args:
        text: lines end with a line feed.
        source: source of the marks.
        problems: errors are added here.
    """
    lines = text.split("\n")
    head = next((line for line in lines if _is_row(line)), "")
    mark = "," if "," in head else next((m for m in (";", "\t") if m in head), ",")
    return _Table(source, problems, mark).node(lines)


def _is_row(line: str) -> bool:
    return bool(line.strip()) and not line.lstrip().startswith("#")


@dataclass(frozen=True, slots=True)
class _Table:
    source: Source
    problems: list[Diagnostic]
    separator: str

    def node(self, lines: Sequence[str]) -> Node:
        """Return all rows; invalid ones are reported and left out."""
        top = Mark(self.source)
        rows = ((n, line) for n, line in enumerate(lines) if _is_row(line))
        number, first = next(rows, (0, ""))
        columns = self._columns(number, first)
        if columns is None:
            return Node(top, ())
        found = [row for n, line in rows if (row := self._row(n, line, columns)) is not None]
        if not found and not self.problems:
            self._add("the table has no agents", top)
        return Node(top, tuple(found))

    def _columns(self, number: int, line: str) -> list[str | None] | None:
        """Return column names, None for unusable ones; None for an invalid header."""
        if not line:
            self._add(
                "the table is empty", Mark(self.source), f"columns: {', '.join(_REQUIRED)}, …"
            )
            return None
        cells = self._cells(number, line)
        if cells is None:
            return None
        names = [cell.text for cell in cells]
        for i, cell in enumerate(cells):
            if cell.text not in Agent.model_fields:
                hint = did_you_mean(nearest(cell.text, Agent.model_fields)).removeprefix("; ")
                hint = hint or f"known: {', '.join(Agent.model_fields)}"
                self._add(f"unknown column '{cell.text[:60]}'", cell.mark, hint)
            elif cell.text in names[:i]:
                self._add(f"column '{cell.text}' is there twice", cell.mark)
        missing = [name for name in _REQUIRED if name not in names]
        if missing:
            self._add(f"missing column '{missing[0]}'", Mark(self.source, number))
            return None
        return [n if n in Agent.model_fields and n not in names[:i] else None
                for i, n in enumerate(names)]  # fmt: skip

    def _row(self, number: int, line: str, columns: Sequence[str | None]) -> Node | None:
        cells = self._cells(number, line)
        mark = Mark(self.source, number, 0, max(1, len(line)))
        if cells is None:
            return None
        if len(cells) != len(columns):
            self._add(f"{len(cells)} cells, the header has {len(columns)}", mark)
            return None
        entries = {
            name: Entry(cell.mark, node)
            for name, cell in zip(columns, cells, strict=True)
            if name and cell.text and (node := self._value(name, cell)) is not None
        }
        return Node(mark, entries)

    def _cells(self, number: int, line: str) -> list[_Cell] | None:
        """Return the cells of a line; None if its quotes do not match."""
        cells, at = [], 0
        while True:
            match = _CELLS[self.separator].match(line, at)
            if match is None:
                text = "a quote that is not closed on its line, or text beside one"
                self._add(text, Mark(self.source, number, at))
                return None
            group = 1 if match[1] is not None else 2
            start, end = match.span(group)
            mark = Mark(self.source, number, start, max(1, end - start))
            text = match[group].replace('""', '"')
            if self.separator != ",":
                text = _DECIMAL_COMMA.sub(r"\1.\2", text)
            cells.append(_Cell(text, mark))
            if not match[3]:
                return cells
            at = match.end()

    def _value(self, name: str, cell: _Cell) -> Node | None:
        if name == "goals":
            return self._goals(cell)
        if name == "portals":
            return self._portals(cell)
        if name == "pauses":
            return Node(
                cell.mark,
                tuple(_number(cell, at, text.strip()) for at, text in _parts(cell.text, ";")),
            )
        return Node(cell.mark, cell.text if name in _TEXT_COLUMNS else _scalar(cell.text))

    def _goals(self, cell: _Cell) -> Node | None:
        points = []
        for at, text in _parts(cell.text, ";"):
            words = [(at + m.start(), m[0]) for m in re.finditer(r"\S+", text)]
            if len(words) != 2:
                self._add(f"'{text.strip()[:60]}' is not a point", cell.mark, "write 'x y; x y'")
                return None
            points.append(Node(cell.mark, tuple(_number(cell, *word) for word in words)))
        return Node(cell.mark, tuple(points))

    def _portals(self, cell: _Cell) -> Node | None:
        names = [Node(_within(cell, at, text), text.strip()) for at, text in _parts(cell.text, ">")]
        if len(names) != 2 or not all(n.value for n in names):
            self._add(f"'{cell.text[:60]}' does not name two portals", cell.mark, "write 'a>b'")
            return None
        return Node(cell.mark, tuple(names))

    def _add(self, message: str, mark: Mark, hint: str = "") -> None:
        self.problems.append(Diagnostic("E015", message, mark, hint))


def _parts(text: str, separator: str) -> Iterator[tuple[int, str]]:
    """Yield the parts between separators, with their offsets."""
    at = 0
    for part in text.split(separator):
        yield at, part
        at += len(part) + len(separator)


def _number(cell: _Cell, at: int, text: str) -> Node:
    return Node(_within(cell, at, text), _scalar(text))


def _within(cell: _Cell, at: int, text: str) -> Mark:
    mark = cell.mark
    return Mark(mark.source, mark.line, mark.column + at, max(1, len(text)))


def _scalar(text: str) -> Scalar:
    """Return a number if it is one, else the text."""
    if _INT.fullmatch(text):
        return int(text)
    if _FLOAT.fullmatch(text) and math.isfinite(value := float(text)):
        return value
    return text
