"""The steps that a participant goes through, one after the other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from crowdbot.core.studies.document import Study, StudyTrial
from crowdbot.core.studies.orders import condition_order, trial_order

StepKind = Literal["consent", "welcome", "practice", "trial", "nasa_tlx", "weights", "use", "end"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """A step of a participant: a form, a practice drive or a trial.

    Attributes:
        number: from 1 on.
        kind: what it is.
        condition: label; empty outside of conditions.
        position: of the condition in the participant's order, from 1 on; 0 outside.
        trial: the scenario that is driven, if one is.
        index: of the trial in the document, from 1 on; 0 for practice and others.
        shown: name of the condition for participants.
    """

    number: int
    kind: StepKind
    condition: str = ""
    position: int = 0
    trial: StudyTrial | None = None
    index: int = 0
    shown: str = ""

    @property
    def name(self) -> str:
        """Return the name of its file, without an ending."""
        inner = f"-{self.condition}" if self.condition else ""
        return f"{self.number:03d}-{self.kind}{inner}" + (f"-{self.index}" if self.index else "")


def steps_of(study: Study, participant: str) -> list[Step]:
    """Return all steps of a participant, in order."""
    return [
        Step(number=k, **step)  # type: ignore[arg-type]
        for k, step in enumerate(_steps(study, participant), start=1)
    ]


def _steps(study: Study, participant: str) -> Iterator[dict[str, object]]:
    spec = study.spec
    yield {"kind": "consent"}
    if spec.welcome:
        yield {"kind": "welcome"}
    for position, label in enumerate(condition_order(study, participant), start=1):
        shown = spec.conditions[label].shown or chr(ord("A") + position - 1)
        block = {"condition": label, "position": position, "shown": shown}
        if spec.practice is not None:
            yield {"kind": "practice", "trial": spec.practice, **block}
        for index, trial in trial_order(study, participant, label):
            yield {"kind": "trial", "trial": trial, "index": index, **block}
        for form in spec.forms:
            yield {"kind": form, **block}
            with_tlx = spec.tlx_weights == "each" or (spec.tlx_weights == "once" and position == 1)
            if form == "nasa_tlx" and with_tlx:
                yield {"kind": "weights", **block}
    yield {"kind": "end"}
