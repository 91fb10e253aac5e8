"""``crowdbot results ladder``: what a planner loses by what it sees, and what by how it plans."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crowdbot.cli.output.results_lines import print_lines
from crowdbot.cli.shared.open_results import Altered, open_results, with_scales

if TYPE_CHECKING:
    from crowdbot.core.statistics.ladder import Ladder, Rung


def ladder(
    out: Annotated[
        Path, typer.Option("--runs", "--out", metavar="DIR", help="Root of the run directories.")
    ] = Path("runs"),
    metric: Annotated[
        str | None, typer.Option(metavar="NAME", help="The score; default: safe efficiency.")
    ] = None,
    variant: Annotated[str, typer.Option(metavar="NAME", help="Its variant.")] = "corrected",
    altered: Altered = False,
    as_csv: Annotated[bool, typer.Option("--csv", help="CSV on stdout.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="JSON on stdout.")] = False,
) -> None:
    """Show each planner's score on the rungs of the ladder of sensing.

    Example: crowdbot results ladder --runs runs
    """
    from crowdbot.core.statistics.ladder import ladders
    from crowdbot.core.statistics.table import Table
    from crowdbot.errors import InputError, UnknownNameError

    found = with_scales(open_results(out, altered))
    name = None if metric is None else (metric, variant)
    if name is not None and name not in (known := Table(found).names):
        raise UnknownNameError("score", ".".join(name), {".".join(n) for n in known})
    lines = [_line(one, rung) for one in ladders(found, name) for rung in one.rungs]
    if not lines:
        raise InputError(
            "no planner ran on two rungs of the ladder; run it again with "
            "--planner-set tracks=truth"
        )
    print_lines(lines, as_csv=as_csv, as_json=as_json)


def _line(ladder: Ladder, rung: Rung) -> dict[str, Any]:
    """Return one rung as a line."""
    gain = rung.gain
    return {
        "planner": ladder.kind,
        "people": rung.tracks,
        "place": rung.localisation,
        "runs": rung.runs,
        "score": rung.score.value,
        "low": rung.score.low,
        "high": rung.score.high,
        "gain": gain.by.value if gain else None,
        "gain low": gain.by.low if gain else None,
        "gain high": gain.by.high if gain else None,
        "pairs": gain.pairs if gain else None,
    }
