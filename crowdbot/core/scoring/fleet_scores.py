"""Scores of several robots in one run: per robot, and for the fleet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from crowdbot.core.types.score import Score

#: Separator between a variant and its robot.
AT = "@"


def variant_of(variant: str, robot: str) -> str:
    """Return the name of a variant of one robot's score: ``rate@a``."""
    return f"{variant}{AT}{robot}"


def fleet_scores(by_robot: Mapping[str, Sequence[Score]]) -> list[Score]:
    """Return one fleet score for each score of its robots, followed by the robots' scores.

    The fleet's score is the mean over robots with a known score; the reason says if some are
    missing. If one is censored, so is the fleet's.

    Args:
        by_robot: name -> scores, of the same metrics and variants in the same order.
    """
    found: list[Score] = []
    for scores in zip(*by_robot.values(), strict=True):
        found.append(_of_fleet(dict(zip(by_robot, scores, strict=True))))
        found += [
            replace(score, variant=variant_of(score.variant, robot))
            for robot, score in zip(by_robot, scores, strict=True)
        ]
    return found


def _of_fleet(scores: Mapping[str, Score]) -> Score:
    first = next(iter(scores.values()))
    known = {robot: score for robot, score in scores.items() if score.status != "undefined"}
    if not known:
        reasons = dict.fromkeys(score.reason for score in scores.values())
        return replace(first, extras={}, reason="; ".join(reasons), lower=None, upper=None)
    reason = "" if len(known) == len(scores) else f"of {', '.join(known)} only"
    if any(score.status == "censored" for score in known.values()):
        lower = _mean([s.value if s.value is not None else s.lower for s in known.values()])
        upper = _mean([s.value if s.value is not None else s.upper for s in known.values()])
        by_robot = [f"{r}: {s.reason}" for r, s in known.items() if s.reason]
        return replace(
            first, status="censored", value=None, lower=lower, upper=upper, extras={},
            reason="; ".join([*by_robot, *([reason] if reason else [])]),
        )  # fmt: skip
    value = _mean([score.value for score in known.values()])
    return replace(
        first, status="ok", value=value, lower=None, upper=None, extras={}, reason=reason
    )


def _mean(numbers: Sequence[float | None]) -> float | None:
    """Return the mean, or None if a number is unknown."""
    known = [number for number in numbers if number is not None]
    return sum(known) / len(known) if known and len(known) == len(numbers) else None
