"""Lines of ``crowdbot audit --adversaries``: the gain of each adversary by the ranking rule."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from crowdbot.cli.output.plugin_table import table
from crowdbot.core.results.results import Results
from crowdbot.core.statistics.ranking import SCORES, Ranked, rank
from crowdbot.core.statistics.table import Table
from crowdbot.errors import InputError


def adversary_lines(results: Results, seeing: Collection[str]) -> list[dict[str, Any]]:
    """Return the comparison of each adversary with each careful planner by the ranking rule.

    Args:
        results: runs of one suite.
        seeing: labels of planners that are careful besides the baselines.

    Raises:
        InputError: there is no adversary, or no careful planner.
    """
    roles = {run.planner: run.role for run in results.runs}
    adversaries = sorted(p for p, role in roles.items() if role == "adversary")
    careful = sorted(p for p, role in roles.items() if role == "baseline" or p in seeing)
    if not adversaries or not careful:
        missing = "adversary" if careful else "careful planner"
        raise InputError(f"no {missing} was run")
    pairs = [(a, b) for a in adversaries for b in careful]
    return [_line(found) for found in rank(Table(results), pairs)]


def _line(ranked: Ranked) -> dict[str, Any]:
    line: dict[str, Any] = {
        "adversary": ranked.planner, "careful": ranked.other, "standing": ranked.standing,
    }  # fmt: skip
    for aspect, one in ranked.aspects.items():
        line[aspect] = {
            "metric": f"{one.metric}.{one.variant}", "difference": one.difference.value,
            "low": one.difference.low, "high": one.difference.high, "verdict": one.verdict,
            "reason": one.reason, "pairs": one.pairs,
        }  # fmt: skip
    return line


def adversary_text(lines: Sequence[Mapping[str, Any]]) -> str:
    """Return the lines as a table, and the result as a sentence."""
    rows = [["adversary", "careful", *SCORES, "standing"]]
    for line in lines:
        cells = [_cell(line.get(aspect)) for aspect in SCORES]
        rows.append([line["adversary"], line["careful"], *cells, line["standing"]])
    ahead = [f"{x['adversary']} of {x['careful']}" for x in lines if x["standing"] == "ahead"]
    verdict = (
        f"ahead: {', '.join(ahead)}" if ahead else "no adversary is ahead of a careful planner"
    )
    return "\n".join([table(rows), "", verdict])


def _cell(aspect: Mapping[str, Any] | None) -> str:
    if aspect is None or aspect["difference"] is None:
        return "–" if aspect is None else aspect["verdict"]
    low, high = aspect["low"], aspect["high"]
    interval = "" if low is None or high is None else f" [{low:.3g}, {high:.3g}]"
    return f"{aspect['difference']:+.3g}{interval} {aspect['verdict']}"
