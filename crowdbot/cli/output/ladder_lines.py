"""Lines of ``crowdbot results ladder``: the rungs of each planner, the lowest first."""

from __future__ import annotations

from typing import Any

from crowdbot.core.results.results import Results
from crowdbot.core.statistics.ladder import Ladder, Rung, ladders
from crowdbot.core.statistics.table import Name, Table
from crowdbot.errors import InputError, UnknownNameError


def lines_of(results: Results, name: Name | None) -> list[dict[str, Any]]:
    """Return a line for each rung of each planner.

    Args:
        results: comparable runs.
        name: the score; None: the primary one.

    Raises:
        UnknownNameError: no run has this score.
        InputError: no planner ran on two rungs.
    """
    table = Table(results)
    if name is not None and name not in table.names:
        raise UnknownNameError("score", ".".join(name), {".".join(n) for n in table.names})
    found = ladders(results, name, table=table)
    if not found:
        raise InputError(
            "no planner ran on two rungs of the ladder; run it again with "
            "--planner-set tracks=truth"
        )
    return [_line(one, rung) for one in found for rung in one.rungs]


def _line(ladder: Ladder, rung: Rung) -> dict[str, Any]:
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
