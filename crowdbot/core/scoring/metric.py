"""Input and output of a metric."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from crowdbot.core.trajectories.commands import Commands
    from crowdbot.core.trajectories.questionnaires import Questionnaires
    from crowdbot.core.trajectories.trajectories import Trajectories
    from crowdbot.core.types.score import Score


@dataclass(frozen=True, slots=True, kw_only=True)
class References:
    """References for a run, and its other recordings; all may be missing.

    Attributes:
        robot_alone: the same robot without people.
        crowd_alone: the same people without robot.
        commands: the user's and the final commands of this run.
        commands_baseline: commands of the same user's drive without shared control.
        questionnaires: what the user answered after this run.
    """

    robot_alone: Trajectories | None = None
    crowd_alone: Trajectories | None = None
    commands: Commands | None = None
    commands_baseline: Commands | None = None
    questionnaires: Questionnaires | None = None


class Metric(Protocol):
    """A pure function of trajectories."""

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Return one score per variant; a status instead of NaN."""
        ...
