"""Write the report page."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import Any

import crowdbot.core.report.provenance as provenance
import crowdbot.core.report.tables as tables
from crowdbot.core.report.cards import reference
from crowdbot.core.report.contents import Contents
from crowdbot.core.report.encode import encode_runs, encode_scores
from crowdbot.core.report.figures import FIELDS, VERDICTS
from crowdbot.core.report.lead import main_columns, verdict
from crowdbot.core.report.markdown import alike, chance, family, markdown
from crowdbot.core.report.methods import methods
from crowdbot.core.report.packing import pack, pack_document, pack_whole
from crowdbot.core.results.rows import RunRow, processes
from crowdbot.core.statistics.estimate_text import estimate_text, joined_text
from crowdbot.core.support.atomic_write import atomic_parts, atomic_write
from crowdbot.core.support.html_page import Allowed, render_page
from crowdbot.core.support.text import plural
from crowdbot.core.types.ending import ending_style, shown

_SCRIPTS = (
    "element", "words", "data", "filters", "scale", "table", "cards", "dots", "save",
    "distribution", "strips", "curves", "scores", "parameters", "pairs", "differences",
    "explorer", "app",
)  # fmt: skip


def write_report(path: Path, contents: Contents) -> dict[str, Path]:
    """Write the page, and the same as CSV and Markdown; equal input gives equal bytes.

    Args:
        path: path of the page; the tables have other suffixes.
        contents: contents of the report.

    Returns:
        ``html``, ``csv`` and ``md``: paths of the files.

    Raises:
        InputError: they cannot be written there.
    """
    paths = {"html": path, "csv": path.with_suffix(".csv"), "md": path.with_suffix(".md")}
    page = render(contents)
    atomic_parts(paths["csv"], tables.csv_parts(contents))
    atomic_write(paths["md"], markdown(contents))
    atomic_write(path, page)
    return paths


def render(contents: Contents) -> str:
    """Return the page as text."""
    states, blobs = encode_scores(contents.results, contents.attempts, contents.series)
    figures, runs = contents.figures, contents.results.runs
    blobs |= {name: pack(getattr(figures, name)) for name in ("pairs", "effects")}
    blobs["intervals"] = pack_whole(figures.intervals)  # equal to the numbers on other pages
    blobs["meta"] = pack_document({**_meta(contents), "states": states})
    return render_page(
        __package__,
        more_style=ending_style(),
        endings=shown(contents.statuses),
        scripts=[f"{name}.js" for name in _SCRIPTS],
        allowed=Allowed(images="blob:"),  # saving as PNG draws the picture once more
        heading=contents.heading,
        contents=contents,
        planners=[_planner(contents, p) for p in contents.planners],
        hashes=contents.hashes,
        facts=contents.facts,
        scenarios=provenance.scenarios(runs),
        scenario_count=len({a.scenario for a in contents.attempts}),
        methods=methods(contents),
        summary=figures.headline,
        chance=chance(figures.headline),
        alike=alike,
        estimate_text=estimate_text,
        lead_columns=main_columns(figures.headline),
        lead_verdict=verdict(figures.headline, contents.sample, useless=bool(contents.suspicion)),
        note_words=_note_words(contents),
        joined_text=joined_text,
        blobs=blobs,
    )


def _note_words(contents: Contents) -> str:
    """Return the heading of the folded notes."""
    heading = contents.heading
    behind = [c.planner for c in contents.floors if c.leads and not c.beats_all | bool(c.undecided)]
    parts = [
        "the suite cannot distinguish planners" if contents.suspicion else "",
        "too few crowds" if contents.sample and contents.sample.too_small else "",
        f"{', '.join(behind)}: not better than the floors" if behind else "",
        plural(len(heading.accepted), "accepted difference") if heading.accepted else "",
        plural(len(heading.warnings), "warning") if heading.warnings else "",
    ]
    listed = "; ".join(filter(None, parts))
    return f"Notes and warnings: {listed}" if listed else "Notes"


def _planner(contents: Contents, planner: str) -> dict[str, Any]:
    tried = contents.of(planner)
    return {
        "label": planner,
        "count": len(tried),
        "counts": contents.counts(tried),
        "privileged": contents.is_privileged(planner),
        "person": contents.is_person(planner),
        "pinned": contents.is_pinned(planner),
        "process": processes(a.provenance["process"] for a in tried if isinstance(a, RunRow)),
        "reference": planner in contents.heading.references,
        "role": contents.role(planner),
        "facts": provenance.planner_facts([a for a in tried if isinstance(a, RunRow)]),
    }


def _meta(contents: Contents) -> dict[str, Any]:
    """Return the data that the script reads, apart from the columns of numbers."""
    marks = {metric: reference(card) for metric, card in contents.cards.items()}
    series = [{**s._asdict(), "reference": marks.get(s.metric)} for s in contents.series]
    return {
        "suite": contents.heading.suite,
        "planners": [{"label": planner} for planner in contents.planners],
        "seeds": contents.seeds,
        "axes": contents.axes,
        "series": series,
        "first": _first(contents),
        "cards": contents.cards,
        "stats": _stats(contents),
        **encode_runs(contents.attempts, contents.planners, contents.axes, contents.replays),
    }


def _first(contents: Contents) -> int:
    """Return the series shown first: the primary score, or the first one without it."""
    known = {(s.metric, s.variant) for s in contents.figures.headline.scores}
    liked = [i for i, s in enumerate(contents.series) if s.name in known]
    return next(iter(liked), 0)


def _stats(contents: Contents) -> dict[str, Any]:
    figures = contents.figures
    places = range(len(contents.planners))
    return {
        "level": round(100 * figures.headline.level, 6),
        "alpha": figures.headline.alpha,
        "tests": figures.headline.tests,
        "family": family(figures.headline),
        "selections": figures.selections,
        "pairs": list(combinations(places, 2)),
        "fields": FIELDS,
        "verdicts": VERDICTS,
        "whys": figures.whys,
    }
