"""Check that the scores of a bundled fleet run are consistent."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.scoring.fleet_scores import AT, fleet_scores
from crowdbot.core.types.score import Score

#: Rounding tolerance for sums of parsed numbers.
_ROUNDING = 1e-12


def arrivals(record: RunRecord) -> dict[str, bool]:
    """Return robot's name -> True if it arrived; a single robot has an empty name."""
    if not record.robots:
        return {"": record.goal_time is not None}
    return {name: one.goal_time is not None for name, one in record.robots.items()}


def fleet_problems(record: RunRecord, scores: Sequence[Score]) -> Iterator[str]:
    """Yield fleet scores that do not follow from its robots' scores."""
    robots = record.robots
    fleet: dict[tuple[str, str], Score] = {}
    by_robot: dict[str, dict[tuple[str, str], Score]] = {name: {} for name in robots}
    for score in scores:
        variant, _, robot = score.variant.partition(AT)
        if robot and robot not in by_robot:
            yield f"{score.metric[:60]}.{score.variant[:60]} is of a robot that {files.RECORD} " \
                  "does not name"  # fmt: skip
            continue
        (by_robot[robot] if robot else fleet)[score.metric, variant] = score
    for robot, found in by_robot.items():
        for metric, variant in sorted(fleet.keys() ^ found.keys()):
            yield f"{files.SCORES}: {metric[:60]}.{variant[:60]} is there of the fleet only, or " \
                  f"of robot {robot} only"  # fmt: skip
    if robots and all(found.keys() == fleet.keys() for found in by_robot.values()):
        yield from _contradictions(fleet, by_robot)


def _contradictions(
    fleet: Mapping[tuple[str, str], Score], by_robot: Mapping[str, Mapping[tuple[str, str], Score]]
) -> Iterator[str]:
    for (metric, variant), score in fleet.items():
        own = {
            name: [replace(found[metric, variant], variant=variant)]
            for name, found in by_robot.items()
        }
        expected = fleet_scores(own)[0]
        if score.status != expected.status or not all(
            _equal(a, b)
            for a, b in (
                (score.value, expected.value),
                (score.lower, expected.lower),
                (score.upper, expected.upper),
            )
        ):
            yield f"{metric}.{variant} of the fleet is not the mean over its robots"


def _equal(a: float | None, b: float | None) -> bool:
    if a is None or b is None:
        return a is b
    return math.isclose(a, b, rel_tol=_ROUNDING, abs_tol=_ROUNDING)
