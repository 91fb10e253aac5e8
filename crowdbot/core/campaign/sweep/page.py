"""The page of a sweep: the best trial, sensitivities, and the best score on other people."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from markupsafe import Markup, escape

from crowdbot.core.campaign.sweep.axes import ParameterAxis
from crowdbot.core.campaign.sweep.search import Sweep, TrialResult, words
from crowdbot.core.statistics.estimate_text import joined_text
from crowdbot.core.support.html_page import render_page

_SHOWN = 50
_WIDTH, _HEIGHT, _EDGE = 300.0, 150.0, 34.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Sensitivity:
    """The dependence of the score on one parameter.

    Attributes:
        share: share of the scores' variance between its values, in at most five groups.
        at_end: True if the best value is an end of the range.
        picture: every trial as a dot.
    """

    name: str
    share: float | None
    at_end: bool
    best: str
    picture: Markup


def render(sweep: Sweep) -> str:
    """Return the page as text."""
    request = sweep.request
    return render_page(
        __package__,
        styles=("crowdbot.core.support:plain_page.css", "page.css"),
        title=f"Sweep of {request.planner} in {request.suite}",
        score=f"{request.metric} ({request.variant}, {request.better} is better)",
        lines=verdict(sweep),
        names=[axis.name for axis in request.axes],
        trials=sweep.tried[:_SHOWN],
        left=max(0, len(sweep.tried) - _SHOWN),
        usual=sweep.usual,
        checked=[t for t in (*sweep.tried, sweep.usual) if t is not None and t.elsewhere],
        sensitivities=list(sensitivities(sweep)),
        joined_text=joined_text,
        words=words,
        request=request,
    )


def verdict(sweep: Sweep) -> list[str]:
    """Return the result in sentences."""
    best, usual = sweep.best, sweep.usual
    if best is None:
        return ["No trial has a score."]
    lines = [f"Best of {len(sweep.tried)} trials: {words(best.trial)}, {joined_text(best.score)}."]
    if usual is not None and usual.score.value is not None:
        lines.append(f"The planner's defaults: {joined_text(usual.score)}.")
    lines += _fit(sweep, best)
    ends = [s.name for s in sensitivities(sweep) if s.at_end]
    if ends:
        lines.append(
            f"The best value of {', '.join(ends)} is an end of its range: a wider range may have "
            "better ones."
        )
    return lines


def _fit(sweep: Sweep, best: TrialResult) -> Iterator[str]:
    """Yield how much of the best trial's lead over the defaults remains with other people."""
    usual = sweep.usual
    if best.elsewhere is None or best.elsewhere.value is None or best.score.value is None:
        yield "It was not tried on other people: some of its lead may be chance."
        return
    if not best.met_others:
        yield "Every seed gives these scenarios the same people: nothing is known about others."
        return
    there = f"On people that the search did not see: {joined_text(best.elsewhere)}"
    if usual is None or usual.elsewhere is None or usual.elsewhere.value is None:
        yield f"{there}."
        return
    yield f"{there}; the defaults {joined_text(usual.elsewhere)}."
    if usual.score.value is None:
        return
    sign = 1.0 if sweep.request.better == "higher" else -1.0
    lead = sign * (best.score.value - usual.score.value)
    left = sign * (best.elsewhere.value - usual.elsewhere.value)
    if lead <= 0.0:
        yield "No trial is better than the defaults."
    elif left <= 0.0:
        yield "Nothing of its lead over the defaults is left there: it is fitted to the people."
    elif left < lead:
        yield f"{100 * left / lead:.0f} % of its lead over the defaults is left there."
    else:
        yield "Its lead over the defaults is as large there."


def sensitivities(sweep: Sweep) -> Iterator[Sensitivity]:
    """Yield the sensitivity to each parameter."""
    known = [t for t in sweep.tried if t.score.value is not None]
    best = sweep.best
    if best is None:
        return
    scores = np.array([t.score.value for t in known], np.float64)
    for axis in sweep.request.axes:
        values = [t.trial[axis.name] for t in known]
        yield Sensitivity(
            name=axis.name,
            share=_share(axis, values, scores),
            at_end=axis.is_end(best.trial[axis.name]),
            best=best.trial[axis.name],
            picture=_picture(axis, values, scores, known.index(best)),
        )


def _share(axis: ParameterAxis, values: Sequence[str], scores: np.ndarray) -> float | None:
    """Return the between-group share of the variance; None without spread or groups."""
    if axis.values:
        groups = np.array([axis.values.index(v) for v in values])
    else:
        numbers = np.array([float(v) for v in values])
        edges = np.unique(np.quantile(numbers, [0.2, 0.4, 0.6, 0.8]))
        groups = np.searchsorted(edges, numbers, side="right")
    total = float(((scores - scores.mean()) ** 2).sum())
    if len(set(groups.tolist())) < 2 or total <= 0.0 or len(scores) <= len(set(groups.tolist())):
        return None
    means = {g: scores[groups == g].mean() for g in set(groups.tolist())}
    between = sum(float((means[g] - scores.mean()) ** 2) for g in groups.tolist())
    return between / total


def _picture(axis: ParameterAxis, values: Sequence[str], scores: np.ndarray, best: int) -> Markup:
    places = [_place(axis, value) for value in values]
    low, high = float(scores.min()), float(scores.max())
    span = (high - low) or 1.0
    dots = []
    for i, (x, score) in enumerate(zip(places, scores.tolist(), strict=True)):
        cx = _EDGE + x * (_WIDTH - 2 * _EDGE)
        cy = _HEIGHT - _EDGE - (score - low) / span * (_HEIGHT - 2 * _EDGE)
        kind = "best" if i == best else "dot"
        dots.append(f'<circle class="{kind}" cx="{cx:.1f}" cy="{cy:.1f}" r="4"/>')
    ends = axis.values if axis.values else (axis.at(0.0), axis.at(1.0))
    base = _HEIGHT - _EDGE + 18.0
    texts = [
        f'<text x="{_EDGE}" y="{base}">{escape(ends[0])}</text>',
        f'<text x="{_WIDTH - _EDGE}" y="{base}" text-anchor="end">{escape(ends[-1])}</text>',
        f'<text x="4" y="{_HEIGHT - _EDGE}">{low:.3g}</text>',
        f'<text x="4" y="{_EDGE}">{high:.3g}</text>',
    ]
    about = f"{escape(axis.name)}: score of each trial by its value"
    return Markup(  # noqa: S704  names and values are escaped above
        f'<svg viewBox="0 0 {_WIDTH:.0f} {_HEIGHT:.0f}" role="img" aria-label="{about}">'
        f"{''.join(dots)}{''.join(texts)}</svg>"
    )


def _place(axis: ParameterAxis, value: str) -> float:
    if axis.values:
        return axis.values.index(value) / max(1, len(axis.values) - 1)
    number = float(value)
    if axis.log:
        return math.log(number / axis.low) / math.log(axis.high / axis.low)
    return (number - axis.low) / (axis.high - axis.low)


def as_json(sweep: Sweep) -> dict[str, Any]:
    """Return plain data for JSON."""
    from crowdbot.core.campaign.sweep.search import rows_of

    found = [
        {"parameter": s.name, "share": s.share, "at_end": s.at_end, "best": s.best}
        for s in sensitivities(sweep)
    ]
    *trials, usual = rows_of(sweep)
    return {
        "score": {"metric": sweep.request.metric, "variant": sweep.request.variant},
        "verdict": verdict(sweep), "trials": trials, "defaults": usual, "sensitivity": found,
    }  # fmt: skip
