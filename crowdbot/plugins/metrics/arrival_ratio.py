"""Alone over crowded, for a quantity that grows until the robot arrives: time, path, jerk."""

from __future__ import annotations

from collections.abc import Callable

from crowdbot.core.interfaces import References
from crowdbot.core.preprocess import cropped
from crowdbot.core.score import Score
from crowdbot.core.score_label import ScoreLabel
from crowdbot.core.trajectory import RobotTrack, Trajectories

#: Measures a cropped run.
Measure = Callable[[Trajectories, RobotTrack], float]


def arrival_ratio(
    label: ScoreLabel, measure: Measure, run: Trajectories, refs: References, zero_tol: float
) -> list[Score]:
    """Scores ``literal`` and ``corrected``; they differ in a run that never arrived.

    Then the literal ratio does not exist, while the corrected one is known from above: the
    quantity would only have grown.
    """
    reason = _obstacle(run, refs)
    if reason or run.robot is None or refs.robot_alone is None:
        return [label.undefined(variant, reason) for variant in ("literal", "corrected")]
    crowded, alone = _measured(measure, run), _measured(measure, refs.robot_alone)
    if run.robot.goal_time is not None:
        both = {"alone": alone, "crowded": crowded}
        return [label.ratio(v, alone, crowded, zero_tol, both) for v in ("literal", "corrected")]
    upper = alone / crowded if crowded > zero_tol else None
    return [
        label.undefined("literal", "goal_not_reached"),
        label.censored("corrected", "goal_not_reached", upper=upper),
    ]


def _obstacle(run: Trajectories, refs: References) -> str:
    """Why neither variant exists; empty when nothing is in the way."""
    if run.robot is None:
        return "invalid_no_robot"
    if refs.robot_alone is None or refs.robot_alone.robot is None:
        return "no_reference"
    if refs.robot_alone.robot.goal_time is None:
        return "reference_goal_not_reached"
    return ""


def _measured(measure: Measure, run: Trajectories) -> float:
    run = cropped(run)
    assert run.robot is not None
    return measure(run, run.robot)
