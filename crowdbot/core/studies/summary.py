"""State of a study: steps done by each participant."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from crowdbot.core.studies.document import Study
from crowdbot.core.studies.orders import condition_order
from crowdbot.core.studies.progress import StudyProgress


@dataclass(frozen=True, slots=True, kw_only=True)
class ParticipantState:
    """Progress of one participant in a study.

    Attributes:
        participant: pseudonym.
        order: conditions in order.
        done, count: steps that are done, and all.
        next_step: name of the next step; empty if all are done.
    """

    participant: str
    order: tuple[str, ...]
    done: int
    count: int
    next_step: str


def participant_states(study: Study, folder: Path) -> list[ParticipantState]:
    """Return the state of each participant.

    Raises:
        InputError: a file of the data is damaged.
    """
    states = []
    for participant in study.spec.people:
        progress = StudyProgress(study, folder, participant)
        now, steps = progress.current(), progress.steps
        states.append(
            ParticipantState(
                participant=participant,
                order=tuple(condition_order(study, participant)),
                done=len(progress.done()),
                count=len(steps),
                next_step="" if now is None else now.name,
            )
        )
    return states
