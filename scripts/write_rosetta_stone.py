"""Write docs/reference/rosetta_stone.md: what each format of other programs keeps and loses.

It is made from the tables that the readers follow; ``make generate`` runs this.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from crowdbot.core.exchange.all_formats import FORMATS
from crowdbot.core.exchange.formats import SceneFormat
from crowdbot.core.exchange.rows import Fate, RowTable

PAGE = Path(__file__).resolve().parent.parent / "docs" / "reference" / "rosetta_stone.md"
_HEAD = """\
# Rosetta stone: words of other simulators and ours

<!-- Written by make generate: change the tables of crowdbot/core/exchange, not this page. -->

[`crowdbot import`](commands.md#crowdbot-import) reads these formats;
[Import scenes of other simulators](../howto/import_scenes.md) shows how. Each row names a part of
a file and the field of ours that it becomes. A part is *carried over* as it is, *interpreted* as
the note says, or *left out* for the reason given. The report of an import names each part that was
not carried over, with its line; what is in none of these tables is named there, too.

"""


def page() -> str:
    """Return the page."""
    parts = [_HEAD, "| format | carried over | interpreted | left out | has no place here |\n"]
    parts.append("|---|---|---|---|---|\n")
    for form in FORMATS.values():
        fates = [row.fate for table in form.tables for row in table.rows]
        counts = " | ".join(str(fates.count(fate)) for fate in list(Fate)[:3])
        parts.append(f"| [{form.title}](#{_anchor(form)}) | {counts} | {form.loses} |\n")
    for form in FORMATS.values():
        parts += ["\n", f"## {form.title[:1].upper()}{form.title[1:]}\n", *_tables(form.tables)]
    return "".join(parts)


def _anchor(form: SceneFormat) -> str:
    kept = "".join(c for c in form.title.lower() if c.isalnum() or c in " -_")
    return kept.replace(" ", "-")


def _tables(tables: Sequence[RowTable]) -> Iterator[str]:
    yield "\n| part | becomes | fate | note |\n|---|---|---|---|\n"
    for table in tables:
        for row in table.rows:
            theirs = f"{table.element} {row.theirs}" if row.theirs else table.element
            ours = f"`{row.ours}`" if row.ours else ""
            yield f"| {_shown(theirs)} | {ours} | {row.fate.value} | {row.note} |\n"


def _shown(text: str) -> str:
    return f"`{text.replace(' @', '@')}`"
