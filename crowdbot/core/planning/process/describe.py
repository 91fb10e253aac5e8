"""Ask a planner for its description, in a short-lived process."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import NoReturn

from crowdbot.core.planning.containment.declared import with_data
from crowdbot.core.planning.description import PlannerDescription
from crowdbot.core.planning.planner import Planner
from crowdbot.core.planning.process.process_plan import ProcessPlan, check_sealed
from crowdbot.core.planning.process.process_planner import (
    ProcessDiedError,
    ProcessLostError,
    ProcessPlanner,
)
from crowdbot.errors import PlannerError


@dataclass(frozen=True, slots=True)
class NotLoaded:
    """Builder in place of a planner that could not be loaded; it fails when it is called.

    Attributes:
        text: the error.
        died: the error if its process died, so that a new attempt may succeed; else empty.
    """

    text: str
    died: str = ""

    def __call__(self) -> NoReturn:
        """Raise the original error.

        Raises:
            PlannerError: always.
        """
        raise PlannerError(self.text)


def describe(
    plan: ProcessPlan, *, lenient: bool = False
) -> tuple[PlannerDescription, Callable[[], Planner]]:
    """Return a planner's description, from a short-lived process, and its builder.

    A planner whose process dies or hangs on loading is accepted and fails in every run.

    Args:
        plan: the program.
        lenient: accept also a planner that raises.

    Raises:
        InputError: it is missing, or its description is invalid.
        PlannerError: it cannot be loaded.
    """
    try:
        planner = ProcessPlanner(plan)
    except PlannerError as error:
        if not (lenient or isinstance(error, ProcessLostError)):
            raise
        died = str(error) if isinstance(error, ProcessDiedError) else ""
        return PlannerDescription(needs=()), NotLoaded(str(error), died)
    planner.close()
    description = planner.description
    if plan.beside is not None and description.data:
        plan = replace(plan, needs=with_data(plan.needs, plan.beside, description.data))
        check_sealed(plan)
    return description, partial(ProcessPlanner, plan)
