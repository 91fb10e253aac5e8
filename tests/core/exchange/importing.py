"""Imports of small files, as plain data."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from crowdbot.core.exchange.importing import Imported, import_files
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.dsl.text.diagnostics import Source
from crowdbot.dsl.text.nodes import parse, to_data
from tests.paths import DATA

FILES = DATA / "exchange"


@cache
def registry() -> Registry:
    """The installed components."""
    return discover()


def imported(*files: Path | str, name: str = "imported") -> Imported:
    """An import of files, which are below the folder of this family's data."""
    return import_files([FILES / file for file in files], name, registry())


def document_of(found: Imported) -> Any:
    """The document as plain data."""
    text = "\n".join(line.text for line in found.lines)
    return to_data(parse(text, Source("imported"), []))


def notes(found: Imported, outcome: str) -> dict[str, str]:
    """The reasons in a report, by what they concern."""
    return {e.theirs or e.ours: e.note for e in found.report.entries if e.outcome.value == outcome}
