"""Output of ``crowdbot results``: a table that fits the terminal, CSV or JSON."""

from __future__ import annotations

import os
import sys
import textwrap
from typing import TYPE_CHECKING, Any

from crowdbot.cli.output.say import say, say_json
from crowdbot.core.support.text import wrap_name

if TYPE_CHECKING:
    from crowdbot.core.statistics.groups import GroupSummary

#: Wide enough for every table; a terminal wraps longer lines.
_WIDTH = 240
#: Width of name columns in terminals narrower than the second number.
_NAME_WIDTH, _WHOLE_NAMES = 10, 80
#: Counts of runs without a value.
WITHOUT = ("undefined", "not_kept", "censored", "failed")


def line_of(summary: GroupSummary) -> dict[str, Any]:
    """Return a summary as one line."""
    return {
        **summary.group,
        "metric": summary.metric,
        "variant": summary.variant,
        "unit": summary.unit,
        "mean": summary.mean.value,
        "low": summary.mean.low,
        "high": summary.mean.high,
        "least": summary.bounds[0],
        "most": summary.bounds[1],
        "median": summary.median,
        "n": summary.counts.ok,
        "undefined": summary.counts.undefined - summary.unscored,
        "not_kept": summary.unscored,
        "censored": summary.counts.censored,
        "failed": summary.failed,
    }


def print_lines(lines: list[dict[str, Any]], *, as_csv: bool, as_json: bool) -> None:
    """Print lines that have the same columns, as a table, CSV or JSON."""
    if as_json:
        say_json(lines)
    elif as_csv:
        _print_csv(lines)
    elif lines:
        print_table(lines)


def _print_csv(lines: list[dict[str, Any]]) -> None:
    import csv
    import sys

    from crowdbot.core.scoring.scores_csv import safe_cell

    writer = csv.writer(sys.stdout)
    if lines:
        writer.writerow(map(safe_cell, lines[0]))
    for line in lines:
        cells = ["" if v is None else v for v in line.values()]
        writer.writerow([safe_cell(c) if isinstance(c, str) else c for c in cells])


def print_table(lines: list[dict[str, Any]]) -> None:
    """Print a table; on narrow terminals, some columns share one, or each line is a block."""
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    seen = sys.stdout.isatty() or "COLUMNS" in os.environ  # other outputs need no wrapping
    console = Console() if seen else Console(width=_WIDTH)

    def table_of(rows: list[dict[str, Any]], padding: int = 1) -> Table:
        table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, padding))
        for name in rows[0]:
            table.add_column(name, overflow="fold", no_wrap=not seen)
        for row in rows:
            table.add_row(*(Text(_shown(v)) for v in row.values()))
        return table

    if "mean" not in lines[0]:
        table = table_of(lines)
        if Console(width=9999).measure(table).maximum > console.width:
            say("\n".join(_block(line, console.width) for line in lines))
        else:
            console.print(table)
        return
    table = table_of([with_interval(line) for line in lines])
    if Console(width=9999).measure(table).maximum > console.width:
        rows = [_narrow(line) for line in lines]
        if console.width < _WHOLE_NAMES:
            rows = [_broken(row) for row in rows]
        table = table_of(rows, padding=0)
    console.print(table)


def _block(line: dict[str, Any], width: int) -> str:
    """Return a line that is too long for a table: names first, then indented name and value."""
    names = list(line)
    own = next((i for i, n in enumerate(names) if not isinstance(line[n], str)), len(names))
    # spaces within a pair must not break
    pairs = [f"{n}\0{_shown(line[n])}" for n in names[own:] if line[n] not in (None, "")]
    text = textwrap.fill(
        ", ".join(pairs), max(width, 20), initial_indent="  ", subsequent_indent="  ",
        break_long_words=False, break_on_hyphens=False,
    )  # fmt: skip
    return " · ".join(str(line[n]) for n in names[:own]) + "\n" + text.replace("\0", " ")


def with_interval(line: dict[str, Any]) -> dict[str, Any]:
    """Return a line of `line_of` with mean and interval in one cell, as in the report."""
    from crowdbot.core.statistics.estimate import Estimate
    from crowdbot.core.statistics.estimate_text import joined_text, range_text

    bounds = line["least"], line["most"]
    all_runs = "" if bounds == (line["mean"],) * 2 else range_text(bounds)
    mean = Estimate(value=line["mean"], low=line["low"], high=line["high"])
    cells = {
        "mean": {"mean [95 %]": joined_text(mean)}, "low": {}, "high": {}, "least": {},
        "most": {"mean of all": all_runs},
    }  # fmt: skip
    return {k: v for name, value in line.items() for k, v in cells.get(name, {name: value}).items()}


def _narrow(line: dict[str, Any]) -> dict[str, Any]:
    """Return a line of `line_of` with fewer columns, for narrow terminals."""
    shown = {"metric", "variant", "unit", "n", "median", "mean [95 %]", "mean of all", *WITHOUT}
    variant = "" if line["variant"] == "corrected" else f" {line['variant']}"
    unit = "" if line["unit"] == "1" else f", {line['unit']}"
    cells = with_interval(line)
    missing = [f"{line[name]} {name}" for name in WITHOUT if line[name]]
    if cells["mean of all"]:
        missing.append(f"mean of all {cells['mean of all']}")
    return {
        **{name: value for name, value in cells.items() if name not in shown},
        "metric": f"{line['metric']}{variant}{unit}",
        "mean [95 %]": cells["mean [95 %]"],
        "median": line["median"],
        "n": ", ".join([str(line["n"]), *missing]),
    }


def _broken(line: dict[str, Any]) -> dict[str, Any]:
    """Return a line whose texts are wrapped to narrow columns."""
    return {n: wrap_name(v, _NAME_WIDTH) if isinstance(v, str) else v for n, v in line.items()}


def _shown(value: Any) -> str:
    if value is None:
        return "–"
    return f"{value:.4g}" if isinstance(value, float) else str(value)
