"""Comparison of conditions: participants are the random factor, each is one unit.

A participant's value in a condition is the mean over trials. Means have Student's t over
participants; differences are within participants, with the sign-flip test of `statistics`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from crowdbot.core.statistics.clusters import Clusters, Floats, mean
from crowdbot.core.statistics.estimate import NOTHING, Estimate
from crowdbot.core.statistics.sign_flip import holm, least_p, p_value
from crowdbot.core.studies.table import Row


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyFinding:
    """One score in one condition, and its difference from the first condition.

    Attributes:
        score: ``metric.variant``.
        condition: label.
        values: participant -> mean over trials.
        mean: over participants.
        gain: mean difference from the first condition, within participants; nothing for that one.
        p: of no difference, two-sided; None for the first condition, or with one participant.
        adjusted: the same after Holm's correction for all tests of a report.
        pairs: participants with a value in both.
    """

    score: str
    condition: str
    values: dict[str, float]
    mean: Estimate
    gain: Estimate = NOTHING
    p: float | None = None
    adjusted: float | None = None
    pairs: int = 0


def compare(rows: Sequence[Row], conditions: Sequence[str], score: str) -> list[StudyFinding]:
    """Return the findings of one score, by condition.

    Args:
        rows: of `study_rows`.
        conditions: labels; the others are compared with the first.
    """
    values = {c: _by_participant(rows, c, score) for c in conditions}
    first = values[conditions[0]]
    found = []
    for condition in conditions:
        own = values[condition]
        pairs = [p for p in own if p in first] if condition != conditions[0] else []
        gains = np.array([own[p] - first[p] for p in pairs])
        test = len(pairs) > 1
        found.append(
            StudyFinding(
                score=score,
                condition=condition,
                values=own,
                mean=_mean(np.array(list(own.values())), list(own)),
                gain=_mean(gains, pairs) if pairs else NOTHING,
                p=p_value(gains, Clusters.of(pairs)) if test else None,
                pairs=len(pairs),
            )
        )
    return found


def smallest_p(participants: int) -> float:
    """Return the smallest p that this many participants can give."""
    return least_p(participants)


def adjusted(findings: Sequence[StudyFinding]) -> list[StudyFinding]:
    """Return findings with Holm's correction for all tests among them."""
    tested = [k for k, f in enumerate(findings) if f.p is not None]
    p_values = np.array([findings[k].p for k in tested], dtype=np.float64)
    by_index = dict(zip(tested, holm(p_values).tolist() if tested else [], strict=True))
    return [replace(f, adjusted=by_index.get(k)) for k, f in enumerate(findings)]


def _by_participant(rows: Sequence[Row], condition: str, score: str) -> dict[str, float]:
    """Return participant -> mean over trials with a value."""
    values: dict[str, list[float]] = {}
    for row in rows:
        if row["condition"] == condition and row.get(score) is not None:
            values.setdefault(str(row["participant"]), []).append(float(row[score]))
    return {p: float(np.mean(v)) for p, v in values.items()}


def _mean(values: Floats, names: Sequence[str]) -> Estimate:
    if not len(values):
        return NOTHING
    return mean(values, Clusters.of(names))
