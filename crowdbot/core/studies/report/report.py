"""Write the report of a study."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from markupsafe import Markup

from crowdbot.core.registry.registry import Registry
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.studies.document import Study
from crowdbot.core.studies.findings import StudyFinding, adjusted, compare, smallest_p
from crowdbot.core.studies.headless import SYNTHETIC
from crowdbot.core.studies.orders import balance, condition_order
from crowdbot.core.studies.report.dots import dots
from crowdbot.core.studies.table import Row
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.html_page import render_page
from crowdbot.core.support.text import plural
from crowdbot.errors import InputError, UnknownNameError

#: Scores that are compared unless others are named, as far as they are there.
USUAL = (
    "success.corrected", "contacts_at_fault.corrected", "collision_count.corrected",
    "relative_time_to_goal.corrected", "agreement.corrected", "fluency.corrected", "nasa_tlx.raw",
    "nasa_tlx.weighted", "use.usefulness", "use.ease_of_use", "use.ease_of_learning",
    "use.satisfaction",
)  # fmt: skip
_NOTES = {"higher": "Higher is better.", "lower": "Lower is better."}

ByScore = Mapping[str, Sequence[StudyFinding]]


def findings_of(
    study: Study, rows: Sequence[Row], scores: Sequence[str] = ()
) -> dict[str, list[StudyFinding]]:
    """Return score -> findings by condition.

    Args:
        scores: names; none: the usual ones that are there.

    Raises:
        InputError: nothing was driven yet.
        UnknownNameError: no drive has a score.
    """
    if not rows:
        raise InputError(f"{study.path}: there are no runs in it yet")
    there = {n for row in rows for n, v in row.items() if "." in n and v is not None}
    for name in scores:
        if name not in there:
            raise UnknownNameError("score", name, there)
    chosen = list(scores) or [name for name in USUAL if name in there]
    conditions = list(study.spec.conditions)
    found = adjusted([f for name in chosen for f in compare(rows, conditions, name)])
    return {name: [f for f in found if f.score == name] for name in chosen}


def as_document(findings: ByScore) -> list[dict[str, Any]]:
    """Return findings as JSON values."""
    return [asdict(f) for found in findings.values() for f in found]


def write_study_report(
    path: Path, study: Study, rows: Sequence[Row], findings: ByScore, registry: Registry
) -> None:
    """Write the page.

    Raises:
        InputError: it cannot be written.
    """
    people = sorted({str(row["participant"]) for row in rows})
    titles = [c.title or label for label, c in study.spec.conditions.items()]
    atomic_write(
        path,
        render_page(
            __package__,
            title=study.spec.title,
            lead=f"{plural(len(people), 'participant')}, {plural(len(rows), 'drive')}, "
            f"{plural(len(titles), 'condition')}.",
            synthetic=_synthetic(rows),
            first=titles[0],
            scores=[_score(name, found, titles, registry) for name, found in findings.items()],
            balance=_balance(study, people),
            orders=[
                (p, ", ".join(condition_order(study, p)),
                 str(sum(row["participant"] == p for row in rows)))
                for p in people
            ],
            methods=_methods(len(people)),
        ),
    )  # fmt: skip


def _score(
    name: str, findings: Sequence[StudyFinding], titles: Sequence[str], registry: Registry
) -> dict[str, Any]:
    metric, _, variant = name.partition(".")
    component: Any = registry.components("metric").get(metric)
    known = None if component is None else component.variants.get(variant)
    unit = "" if known is None or known.unit in ("", "1") else f", {known.unit}"
    note = "" if known is None else _NOTES.get(known.better, "")
    label = "; ".join(f"{t}: {_text(f.mean)}" for t, f in zip(titles, findings, strict=True))
    return {
        "name": name,
        "heading": f"{metric.replace('_', ' ')} ({variant.replace('_', ' ')}{unit})",
        "note": note,
        "svg": Markup(dots(findings, titles, f"{metric}: {label}")),  # noqa: S704 - it escapes
        "rows": [
            (
                title,
                _text(f.mean),
                str(len(f.values)),
                _text(f.gain) if f.pairs else "",
                str(f.pairs) if f.pairs else "",
                _p(f.p),
                _p(f.adjusted),
            )
            for title, f in zip(titles, findings, strict=True)
        ],
    }


def _text(estimate: Estimate) -> str:
    if estimate.value is None:
        return "none"
    if estimate.low is None or estimate.high is None:
        return f"{estimate.value:.3g}"
    return f"{estimate.value:.3g} [{estimate.low:.3g}, {estimate.high:.3g}]"


def _p(p: float | None) -> str:
    return "" if p is None else f"{p:.3g}"


def _synthetic(rows: Sequence[Row]) -> str:
    count = sum(row["driver"] == SYNTHETIC for row in rows)
    return f"{count} of {len(rows)} drives; they say nothing about people." if count else ""


def _balance(study: Study, people: Sequence[str]) -> str:
    places, after = balance([condition_order(study, p) for p in people])
    if places == after == 0:
        return "Each condition was as often in each place, and after each other one."
    return (
        f"Not balanced: counts of places differ by {places}, of successions by {after}. Practice "
        "and fatigue may count as differences of conditions."
    )


def _methods(people: int) -> str:
    return (
        "Participants are the random factor. A participant's value in a condition is the mean over "
        "its drives; means and differences within participants have intervals of Student's t over "
        "participants. p is that of a sign-flip test of the differences, exact for up to 13 "
        f"participants; with {plural(people, 'participant')} it cannot be below "
        f"{smallest_p(max(people, 1)):.2g}. Corrected p are Holm's, for all tests of this page. A "
        "drive without a value, such as the time to the goal where the robot did not arrive, is "
        "left out of that score; look at success first."
    )
