"""Tables of parameters on the cards of metrics; scripts/generate.py writes them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from pydantic.fields import FieldInfo

from crowdbot.core.registry.registry import discover
from scripts.write_reference import default_of, units_of

PAGES = Path(__file__).parent.parent / "docs" / "reference" / "metrics"
_HEAD = "| parameter | default | meaning |\n|---|---|---|\n"
_TABLE = re.compile(rf"{re.escape(_HEAD)}((?:\|.*\n)*)")


def with_parameters(page: str, metric: str) -> str:
    """Return a card with its table of parameters as the metric's spec has them."""
    fields = discover(entry_points=False).components("metric")[metric].spec.model_fields

    def table(found: re.Match[str]) -> str:
        return _HEAD + "".join(_rows(found[1].splitlines(), fields))

    return _TABLE.sub(table, page)


def _rows(lines: list[str], fields: dict[str, FieldInfo]) -> Iterator[str]:
    """Yield the rows; what says more than the field's default or description stays."""
    for line in lines:
        name, given, said = (cell.strip() for cell in line.strip("|").split("|", 2))
        field = fields[name.strip("`")]
        unit = ", ".join(units_of(field.annotation, field.metadata)).replace("^2", "²")
        meaning = re.sub(r", \S+$", "", (field.description or "").rstrip("."))
        meaning = said if said.startswith(meaning) or not meaning else meaning
        value = f"{default_of(field)} {unit}".strip()
        yield f"| {name} | {given if given.startswith(value) else value} | {meaning} |\n"
