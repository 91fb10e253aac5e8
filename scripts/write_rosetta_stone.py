"""Write docs/reference/rosetta_stone.md: what each format of other programs keeps and loses.

It is made from the tables that the readers follow; ``make generate`` runs this.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from crowdbot.core.exchange.all_formats import FORMATS
from crowdbot.core.exchange.formats import SceneFormat
from crowdbot.core.exchange.rows import PartOutcome, RowTable

PAGE = Path(__file__).resolve().parent.parent / "docs" / "reference" / "rosetta_stone.md"
_HEAD = """\
# Rosetta stone: words of other simulators and ours

<!-- Written by make generate: change the tables of crowdbot/core/exchange, not this page. -->

[`crowdbot import`](commands.md#crowdbot-import) reads these formats;
[Import scenes of other simulators](../howto/import_scenes.md) shows how. Each line names parts of
a file and the fields of ours that they become. A part is *carried over* as it is, *interpreted* as
the note says, or *left out* for the reason given. The report of an import names each part that was
not carried over, with its line; what is in none of these tables is named there, too.

"""


def page() -> str:
    """Return the page."""
    parts = [_HEAD, "| format | carried over | interpreted | left out | has no place here |\n"]
    parts.append("|---|---|---|---|---|\n")
    for form in FORMATS.values():
        outcomes = [row.outcome for table in form.tables for row in table.rows]
        counts = " | ".join(str(outcomes.count(outcome)) for outcome in list(PartOutcome)[:3])
        parts.append(f"| [{form.title}](#{_anchor(form)}) | {counts} | {form.loses} |\n")
    for form in FORMATS.values():
        parts += ["\n", f"## {form.title[:1].upper()}{form.title[1:]}\n", *_tables(form.tables)]
    return "".join(parts)


def _anchor(form: SceneFormat) -> str:
    kept = "".join(c for c in form.title.lower() if c.isalnum() or c in " -_")
    return kept.replace(" ", "-")


@dataclass(slots=True)
class _Line:
    """Rows that are alike, as one line of a table."""

    elements: tuple[str, ...]
    theirs: list[str]
    ours: list[str]
    outcome: PartOutcome
    note: str

    @property
    def kind(self) -> tuple[tuple[str, ...], str, PartOutcome, str]:
        """What rows of one line share: elements, place of ours, outcome and note."""
        place = self.ours[0].rpartition(".")[0] if self.ours[0] else ""
        return self.elements, place, self.outcome, self.note

    def text(self) -> str:
        """Return the line in Markdown."""
        elements = ", ".join(f"`{name}`" for name in self.elements)
        parts = ", ".join(f"`{name}`" for name in self.theirs if name)
        first, *rest = dict.fromkeys(self.ours)
        place = f"{self.kind[1]}." if self.kind[1] else ""
        names = [first, *(name.removeprefix(place) for name in rest)] if first else []
        ours = ", ".join(f"`{name}`" for name in names)
        theirs = f"{elements}: {parts}" if parts else elements
        return f"| {theirs} | {ours} | {self.outcome.value} | {self.note} |\n"


def _tables(tables: Sequence[RowTable]) -> Iterator[str]:
    yield "\n| part | becomes | outcome | note |\n|---|---|---|---|\n"
    yield from (line.text() for line in _within(_across(tables)))


def _across(tables: Sequence[RowTable]) -> list[_Line]:
    """Return one line for the same row of several elements."""
    found: dict[tuple[str, str, PartOutcome, str], list[str]] = {}
    for table in tables:
        for row in table.rows:
            found.setdefault((row.theirs, row.ours, row.outcome, row.note), []).append(
                table.element
            )
    return [
        _Line(tuple(dict.fromkeys(elements)), [theirs], [ours], outcome, note)
        for (theirs, ours, outcome, note), elements in found.items()
    ]


def _within(lines: Sequence[_Line]) -> list[_Line]:
    """Return one line for those of the same elements that differ in names only."""
    found: dict[tuple[tuple[str, ...], str, PartOutcome, str], _Line] = {}
    for line in lines:
        if line.kind in found:
            found[line.kind].theirs += line.theirs
            found[line.kind].ours += line.ours
        else:
            found[line.kind] = line
    return list(found.values())
