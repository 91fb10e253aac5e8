"""The numbers of crowds and of recorded people, as rows of text."""

from __future__ import annotations

import numpy as np

from crowdbot.core.realism.bins import FEATURES
from crowdbot.core.realism.compare import ReportedErrors, beside
from crowdbot.core.realism.measure import DIAGRAM, LANES, PAIRS, Realism
from crowdbot.core.realism.reference import RealismReference

_NAMES = {
    "time_to_collision": "time to collision",
    DIAGRAM: "fundamental diagram",
    LANES: "lanes",
    PAIRS: "pair correlation",
}


def rows(realism: Realism) -> list[list[str]]:
    """Return rows: part, this crowd, recorded people, people without avoidance."""
    reference = realism.reference
    real, none = reference.ceiling, reference.floor
    out = [["score", _two(realism.score), _two(realism.ceiling), _two(realism.floor)]]
    for name in FEATURES:
        parts = [s.parts.get(name, np.nan) for s in (real, none)]
        out.append([_NAMES.get(name, name), _two(realism.parts[name]), *map(_two, parts)])
    between, ghosts = real_beside(reference), ghosts_beside(reference)
    for label, name in (
        ("error of the fundamental diagram", "diagram_error"),
        ("error of the lane order", "lane_error"),
        ("error of the pair correlation", "pair_error"),
    ):
        errors = [getattr(b, name) for b in (realism.beside, between, ghosts)]
        out.append([label, *map(_two, errors)])
    for k, percent in enumerate(("1 %", "5 %", "50 %")):
        distances = [float(b.nearest_error[k]) for b in (realism.beside, between, ghosts)]
        out.append([f"error of the {percent} nearest distance, m", *map(_two, distances)])
    out.append(["person-time overlapping", _percent(realism.beside.overlap), "–", "–"])
    return out


def real_beside(reference: RealismReference) -> ReportedErrors:
    """Return the errors of one half of the recordings against the other."""
    return beside(*reference.halves)


def ghosts_beside(reference: RealismReference) -> ReportedErrors:
    """Return the errors of people without avoidance."""
    return beside(reference.floors["avoid nobody"], reference.whole)


def _two(value: float) -> str:
    return f"{value:.3f}" if np.isfinite(value) else "–"


def _percent(value: float) -> str:
    return f"{100 * value:.2f} %" if np.isfinite(value) else "–"
