"""RunOptions: how runs are made, passed unchanged from the command line to the recorder."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

from crowdbot.core.planning.choice import ANYWHERE, PlannerPlace
from crowdbot.core.planning.watchdog import STEP_LIMIT
from crowdbot.core.support.arguments import number_of, whole_number_of
from crowdbot.errors import InputError

#: Duration of a run of people alone where none is given, and the longest one, s.
PEOPLE_ALONE, _LONGEST = 60.0, 24.0 * 3600.0
#: Most draws that may be replaced in one run.
MOST_REPLACED = 3
#: What is recorded, most first: what a run has holds all that the levels after it ask for.
Recorded = Literal["all", "used", "none"]


@dataclass(frozen=True, slots=True, kw_only=True)
class RunOptions:
    """Options of making a run that do not belong to its scenario or planner.

    Attributes:
        record: which sensors are simulated and recorded.
        replay: write the replay page.
        references: make calibration runs where they are missing.
        force: make a complete run again.
        retry_failed: make a complete run again whose planner failed.
        metrics: patterns of the metrics to score; None is all.
        step_budget: wall time that a planner step may take, s; None sets no limit.
        replace_draws: how many draws of a run may be replaced in which the robot is struck from
            behind without fault and topples.
        duration: of a run of people alone, s; None: `PEOPLE_ALONE`. Runs with robots end by their
            tasks.
        place: where the planner runs, and what its process may take.

    Raises:
        InputError: a value is wrong.
    """

    record: Recorded = "used"
    replay: bool = True
    references: bool = True
    force: bool = False
    retry_failed: bool = False
    metrics: Sequence[str] | None = None
    step_budget: float | None = None
    replace_draws: int = 0
    duration: float | None = None
    place: PlannerPlace = ANYWHERE

    def __post_init__(self) -> None:
        if self.record not in get_args(Recorded):
            choices = " or ".join(map(repr, get_args(Recorded)))
            raise InputError(f"record must be {choices}, not {self.record!r}")
        if not 0 <= whole_number_of("replace_draws", self.replace_draws) <= MOST_REPLACED:
            raise InputError(f"at most {MOST_REPLACED} draws may be replaced in a run")
        length = self.duration
        if length is not None and not 0.0 < number_of("duration", length) <= _LONGEST:
            raise InputError(f"duration {length:g} s must be above 0, at most {_LONGEST:g} s")
        budget = self.step_budget
        if budget is not None and not 0.0 < number_of("step_budget", budget) < STEP_LIMIT:
            raise InputError(
                f"the budget of a step must be above 0 and below {STEP_LIMIT:g} s, "
                f"after which it counts as hung; not {budget:g}"
            )


#: What is usual.
USUAL = RunOptions()
