"""Writes the leaderboard: one offline page without a script, in the reader's light or dark."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any

from crowdbot.core.bundle.entries import LeaderboardEntry
from crowdbot.core.bundle.manifest import RULES, RULES_TEXT
from crowdbot.core.bundle.standings import Standings
from crowdbot.core.scoring.four_scores import FOUR_SCORES, is_main
from crowdbot.core.statistics import OUTCOMES, Estimate
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.html_page import render_page

_ARROWS = {"higher": "↑", "lower": "↓", "reference": "=", "none": ""}


def write_leaderboard(
    path: Path, tables: Sequence[Standings], left_out: Mapping[str, str], title: str
) -> None:
    """Write the page; equal input gives equal bytes.

    Raises:
        InputError: the path cannot be written.
    """
    text = render_page(
        __package__,
        title=title,
        tables=[_table(t) for t in tables],
        left_out=left_out,
        rules=RULES_TEXT,
        rules_number=RULES,
        version=metadata.version("crowdbot"),
    )
    atomic_write(path, text)


def _table(table: Standings) -> dict[str, Any]:
    return {
        "edition": table.edition,
        "title": table.entries[0].manifest.edition.title,
        "class": table.classed,
        "by": table.by,
        "ordered": bool(table.summary.ranks(table.by)),
        "entries": [_entry(table, e) for e in table.entries],
        "ranked": [e.name for e in table.entries if e.ranked],
        "groups": _groups(table),
        "findings": [(f.severity, str(f), f.accepted) for f in table.findings],
        "tests": table.summary.tests,
        "suspicion": table.suspicion,
        "crowds": table.crowds,
        "by_crowd": table.by_crowd,
        "audit": table.audit.text if table.audit else "nobody has audited this suite",
        "level": f"{table.summary.level:.0%}",
    }


def _entry(table: Standings, entry: LeaderboardEntry) -> dict[str, Any]:
    manifest = entry.manifest
    rank = table.rank(table.by, entry)
    return {
        "rank": "" if rank is None else f"{rank}{'=' * table.shares_rank(table.by, entry)}",
        "name": entry.name,
        "team": manifest.team or "—",
        "planner": manifest.label,
        "contact": manifest.contact,
        "runs": len(manifest.runs),
        "failed": entry.failed,
        "missing": len(manifest.missing),
        "pinned": manifest.pinned,
        "state": _state(entry),
        "hash": entry.sha256[:12],
        "crowdbot": manifest.versions.get("crowdbot", ""),
        "rescored": ", ".join(entry.rescored),
        "outdated": ", ".join(entry.outdated),
    }


def _state(entry: LeaderboardEntry) -> str:
    record = entry.verification
    if record is None:
        return "not verified"
    runs = record.get("runs")
    count = len(runs) if isinstance(runs, Mapping) else 0
    return f"{record.get('outcome', 'unknown')}, {count} of {len(entry.runs)} runs made again"


def _groups(table: Standings) -> dict[str, list[dict[str, Any]]]:
    """Category -> metrics, each with a cell for every ranked entry; the four scores first."""
    ranked = [e for e in table.entries if e.ranked]
    found: dict[str, list[dict[str, Any]]] = {}
    for metric in dict.fromkeys(s.metric for s in table.summary.scores):
        label = next(s for s in table.summary.scores if s.metric == metric)
        row = {
            "metric": metric,
            "variant": label.variant,
            "unit": "" if label.unit == "1" else label.unit,
            "arrow": _ARROWS[label.better],
            "better": label.better,
            "cells": [_cell(table, metric, e) for e in ranked],
        }
        main = is_main(metric, label.variant)
        found.setdefault(FOUR_SCORES if main else label.category, []).append(row)
    return dict(sorted(found.items(), key=lambda item: (item[0] != FOUR_SCORES, item[0])))


def _cell(table: Standings, metric: str, entry: LeaderboardEntry) -> dict[str, Any]:
    score, rank = table.score(metric, entry), table.rank(metric, entry)
    if score is None or metric in entry.outdated:
        return {"rank": "", "value": "—", "interval": "", "note": "an older version of the metric"}
    others = {k: getattr(score.counts, k) for k in OUTCOMES if k != "ok"}
    notes = [f"{n} {k}" for k, n in others.items() if n]
    if score.counts.censored:
        notes.append(f"mean of all runs {_number(score.bounds[0])} to {_number(score.bounds[1])}")
    notes += ["scored again"] * (metric in entry.rescored)
    return {
        "rank": "" if rank is None else f"{rank}{'=' * table.shares_rank(metric, entry)}",
        "value": _number(score.mean.value),
        "interval": _interval(score.mean),
        "note": ", ".join(notes),
    }


def _interval(found: Estimate) -> str:
    if found.low is None or found.high is None:
        return ""
    return f"{_number(found.low)} to {_number(found.high)}"


def _number(value: float | None) -> str:
    return "—" if value is None else f"{value:.4g}"
