"""Results as a table with a column for each planner, in as many parts as the terminal needs."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from crowdbot.cli.output.results_lines import WITHOUT, with_interval
from crowdbot.cli.output.say import say
from crowdbot.core.support.text import wrap_name

if TYPE_CHECKING:
    from rich.table import Table

#: Widths: of names that are broken in narrow terminals, and where there is no terminal.
_NAME, _UNLIMITED = 16, 10_000
_VALUES = {"metric", "variant", "unit", "mean", "low", "high", "least", "most", "median", "n",
           *WITHOUT}  # fmt: skip


def print_by_planner(lines: Sequence[dict[str, Any]]) -> None:
    """Print lines of `line_of` that have a planner: a row for each metric and further group."""
    from rich.console import Console

    seen = sys.stdout.isatty() or "COLUMNS" in os.environ
    console = Console() if seen else Console(width=_UNLIMITED)
    planners = list(dict.fromkeys(str(line["planner"]) for line in lines))
    for part in _parts(lines, planners, console.width):
        console.print(_table(lines, part))
    if any(_without(line) for line in lines):
        say("in brackets: 95 %; +N: N runs without a value; crowdbot results --details counts them")


def _parts(lines: Sequence[dict[str, Any]], planners: list[str], width: int) -> Iterator[list[str]]:
    """Yield as many planners at a time as fit; at least one."""
    from rich.console import Console

    part: list[str] = []
    for planner in planners:
        wide = Console(width=9999).measure(_table(lines, [*part, planner])).maximum
        if part and wide > width:
            yield part
            part = []
        part.append(planner)
    yield part


def _table(lines: Sequence[dict[str, Any]], planners: Sequence[str]) -> Table:
    from rich.box import SIMPLE_HEAD
    from rich.table import Table
    from rich.text import Text

    groups = [name for name in lines[0] if name not in _VALUES and name != "planner"]
    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for name in ("metric", *groups):
        table.add_column(name, overflow="fold")
    for planner in planners:
        table.add_column(wrap_name(planner, _NAME), overflow="fold")
    rows: dict[tuple[str, ...], dict[str, str]] = {}
    for line in lines:
        head = (_metric(line), *(str(line[name]) for name in groups))
        rows.setdefault(head, {})[str(line["planner"])] = _cell(line)
    for head, cells in rows.items():
        table.add_row(*map(Text, (*head, *(cells.get(planner, "–") for planner in planners))))
    return table


def _metric(line: dict[str, Any]) -> str:
    variant = "" if line["variant"] == "corrected" else f" {line['variant']}"
    unit = "" if line["unit"] == "1" else f", {line['unit']}"
    return f"{line['metric']}{variant}{unit}"


def _cell(line: dict[str, Any]) -> str:
    """Return mean and interval, and the number of runs without a value."""
    mean = str(with_interval(line)["mean [95 %]"])
    missing = _without(line)
    if missing and missing == line["not_kept"] and not line["n"]:
        return "not kept"
    return f"{mean} +{missing}" if missing else mean


def _without(line: dict[str, Any]) -> int:
    return sum(line[name] for name in WITHOUT)
