"""Write the leaderboard: one offline, sortable page in the reader's light or dark mode."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any
from urllib.parse import quote

from crowdbot.core.bundle.entries import LeaderboardEntry
from crowdbot.core.bundle.manifest import RULES, RULES_TEXT
from crowdbot.core.bundle.standings import Standings
from crowdbot.core.bundle.verification import JUDGED
from crowdbot.core.results.rows import place_of, processes
from crowdbot.core.runs import run_directory as files
from crowdbot.core.scoring.four_scores import FOUR_SCORES, beside_main, name_of
from crowdbot.core.statistics.estimate import OUTCOMES
from crowdbot.core.statistics.estimate_text import NOTHING, estimate_text, range_text
from crowdbot.core.statistics.pareto import label_heights, pareto
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.html_page import render_page

_NO_AUDIT = "no audit tells if this suite separates careful planners from blind ones"
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
        scripts=["sort.js"],
        title=title,
        tables=[_table(t, path.resolve().parent) for t in tables],
        left_out=left_out,
        rules=RULES_TEXT,
        rules_number=RULES,
        version=metadata.version("crowdbot"),
    )
    atomic_write(path, text)


def _table(table: Standings, here: Path) -> dict[str, Any]:
    groups = _groups(table)
    main = groups.get(FOUR_SCORES, [])
    points = pareto(table.summary)
    names = [f"{row['name']} {row['arrow']}".strip() for row in main]
    return {
        "heads": ["Rank", "Team", "Planner", *names, "Runs", "Verification", "Code", "Bundle"],
        "edition": table.edition,
        "title": table.entries[0].manifest.edition.title,
        "class": table.classed,
        "by": table.by,
        "ordered": bool(table.ranks(table.by)),
        "orders": table.orders,
        "entries": [
            {**_entry(table, e, here), "mains": _mains(table, e, main, names)}
            for e in table.entries
        ],
        "ranked": [e.name for e in table.entries if e.ranked],
        "groups": groups,
        "findings": [(f.severity, str(f), f.accepted) for f in table.findings],
        "tests": table.summary.tests,
        "suspicion": table.suspicion,
        "too_small": table.too_small,
        "crowds": table.crowds,
        "by_crowd": table.by_crowd,
        "pareto": points,
        "heights": label_heights(points),
        "audit": table.audit.text if table.audit else _NO_AUDIT,
        "level": f"{table.summary.level:.0%}",
    }


def _mains(
    table: Standings, entry: LeaderboardEntry, rows: Sequence[Mapping[str, Any]], names: list[str]
) -> list[dict[str, str]]:
    """Return name, value, interval and sort key of each of an entry's four main scores."""
    ranked = [e.name for e in table.entries if e.ranked]
    mains = []
    for name, row in zip(names, rows, strict=True):
        cell = row["cells"][ranked.index(entry.name)] if entry.name in ranked else {}
        mains.append({
            "name": name, "value": cell.get("value", NOTHING),
            "interval": cell.get("interval", ""), "sort": cell.get("sort", ""),
        })  # fmt: skip
    return mains


def _runs(entry: LeaderboardEntry, here: Path) -> list[dict[str, str]]:
    """Return every run, with a link if the bundle is unpacked in a folder of its name beside it."""
    unpacked = entry.path.with_suffix("")
    listed = []
    for run in entry.runs:
        places = (unpacked / run.entry.directory / n for n in (files.REPLAY, files.SCORES))
        page = next((p for p in places if p.is_file()), None)
        status, time = run.record.status, run.record.goal_time
        ending = status if time is None else f"{status} after {time:.1f} s"
        listed.append({
            "name": run.name, "ending": ending, "href": _link(page, here) if page else "",
        })  # fmt: skip
    return listed


def _link(file: Path, here: Path) -> str:
    """Return the address of a file relative to the page's folder."""
    relative = Path(os.path.relpath(file.resolve(), here)).as_posix()
    return quote(relative if relative.startswith(".") else f"./{relative}")


def _entry(table: Standings, entry: LeaderboardEntry, here: Path) -> dict[str, Any]:
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
        "unranked": entry.unranked,
        "outcome": str((entry.verification or {}).get("outcome", "")).split(" ")[0],
        "late": entry.late,
        "pinned": manifest.pinned,
        "process": processes(place_of(run.record) for run in entry.runs),
        "state": _state(entry),
        "hash": entry.sha256[:12],
        "file": entry.path.name,
        "href": _link(entry.path, here),
        "listed": _runs(entry, here),
        "crowdbot": manifest.versions.get("crowdbot", ""),
        "rescored": ", ".join(entry.rescored),
        "outdated": ", ".join(entry.outdated),
    }


def _state(entry: LeaderboardEntry) -> str:
    """Return who computed an entry, and how many of its runs an organiser repeated."""
    record = entry.verification
    if record is None:
        return "computed by the team, not verified"
    if record.get("outcome") == JUDGED:
        return f"judged: the organisers made all {len(entry.runs)} runs"
    runs = record.get("runs")
    count = len(runs) if isinstance(runs, Mapping) else 0
    trusted = ", ".join(map(str, record.get("trusted") or ()))
    trusting = f", trusting the plugin {trusted}" if trusted else ""
    outcome = record.get("outcome", "unknown")
    made = f"{count} of {len(entry.runs)} runs made again"
    return f"computed by the team; {outcome}, {made}{trusting}"


def _groups(table: Standings) -> dict[str, list[dict[str, Any]]]:
    """Return category -> metrics, with a cell per ranked entry; the four main scores first."""
    ranked = [e for e in table.entries if e.ranked]
    found: dict[str, list[dict[str, Any]]] = {}
    for metric in dict.fromkeys(s.metric for s in table.summary.scores):
        label = next(s for s in table.summary.scores if s.metric == metric)
        row = {
            "name": name_of(metric, label.variant),
            "variant": _variant(metric, label.variant),
            "unit": "" if label.unit == "1" else label.unit,
            "arrow": _ARROWS[label.better],
            "better": label.better,
            "cells": [_cell(table, metric, e) for e in ranked],
        }
        main = beside_main(metric, label.variant)
        found.setdefault(FOUR_SCORES if main else label.category, []).append(row)
    return dict(sorted(found.items(), key=lambda item: (item[0] != FOUR_SCORES, item[0])))


def _variant(metric: str, variant: str) -> str:
    """Return the variant; ``metric.variant`` if the score is shown under a name of its own."""
    return variant if name_of(metric, variant) == metric else f"{metric}.{variant}"


def _cell(table: Standings, metric: str, entry: LeaderboardEntry) -> dict[str, Any]:
    score, rank = table.score(metric, entry), table.rank(metric, entry)
    if score is None or metric in entry.outdated:
        return {
            "rank": "", "value": NOTHING, "interval": "", "sort": "",
            "note": "an older version of the metric",
        }  # fmt: skip
    if score.mean.value is None:
        rank = None  # nothing to rank by
    others = {k: getattr(score.counts, k) for k in OUTCOMES if k != "ok"}
    notes = [f"{n} {k}" for k, n in others.items() if n]
    if score.counts.censored and any(end is not None for end in score.bounds):
        notes.append(f"mean of all runs {range_text(score.bounds)}")
    notes += ["scored again"] * (metric in entry.rescored)
    value, interval = estimate_text(score.mean)
    return {
        "rank": "" if rank is None else f"{rank}{'=' * table.shares_rank(metric, entry)}",
        "value": value,
        "interval": interval,
        "sort": "" if score.mean.value is None else repr(score.mean.value),
        "note": ", ".join(notes),
    }
