"""Cards of metrics: declared cells and tables of parameters; scripts/generate.py writes them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pydantic.fields import FieldInfo

from crowdbot.core.registry.registry import discover
from scripts.write_reference import default_of, units_of

PAGES = Path(__file__).parent.parent / "docs" / "reference" / "metrics"
_HEAD = "| parameter | default | meaning |\n|---|---|---|\n"
_TABLE = re.compile(rf"{re.escape(_HEAD)}((?:\|.*\n)*)")


def with_declared(page: str, metric: str) -> str:
    """Return a card with symbol, category, unit and direction as the metric declares them."""
    declared: Any = discover(entry_points=False).components("metric")[metric]
    head = {
        "symbol": declared.symbol.replace("|", "\\|"),
        "category": declared.score_category,
        "unit": declared.unit,
        "better": declared.better,
    }
    for name, value in head.items():
        page = _with_first(page, rf"^\| {name} \| .* \|$", f"| {name} | {value} |")
    for name, variant in declared.variants.items():
        cells = f"| `{name}` | {variant.unit} | {variant.better} |"
        row = rf"^\| `{name}` \| [^|]* \| (?:lower|higher|reference|none) \|"
        page = _with_first(page, row, cells)
    return page


def _with_first(page: str, line: str, text: str) -> str:
    """Return a page whose first match of a regular expression is replaced by a text."""
    return re.sub(line, lambda _: text, page, count=1, flags=re.MULTILINE)


def with_parameters(page: str, metric: str) -> str:
    """Return a card with its table of parameters as the metric's spec has them."""
    fields = discover(entry_points=False).components("metric")[metric].spec.model_fields

    def table(found: re.Match[str]) -> str:
        return _HEAD + "".join(_rows(found[1].splitlines(), fields))

    return _TABLE.sub(table, page)


def _rows(lines: list[str], fields: dict[str, FieldInfo]) -> Iterator[str]:
    """Yield the rows; what says more than the field's default or description stays."""
    for line in lines:
        name, given, values = (cell.strip() for cell in line.strip("|").split("|", 2))
        field = fields[name.strip("`")]
        unit = ", ".join(units_of(field.annotation, field.metadata)).replace("^2", "²")
        meaning = re.sub(r", \S+$", "", (field.description or "").rstrip("."))
        meaning = values if values.startswith(meaning) or not meaning else meaning
        value = f"{default_of(field)} {unit}".strip()
        yield f"| {name} | {given if given.startswith(value) else value} | {meaning} |\n"
