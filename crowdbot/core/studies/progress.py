"""The progress of one participant: a file for each finished step, written atomically."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from crowdbot.core.studies.document import Study
from crowdbot.core.studies.steps import Step, steps_of
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.errors import InputError, UnknownNameError

#: Name of the file that says which study a folder belongs to.
STUDY = "study.json"


@dataclass(frozen=True, slots=True)
class StudyProgress:
    """The steps of a participant and their stored results.

    Attributes:
        study: the study.
        folder: of the study's data.
        participant: pseudonym.
    """

    study: Study
    folder: Path
    participant: str

    @property
    def home(self) -> Path:
        """Return the participant's folder."""
        return self.folder / self.participant

    @property
    def runs(self) -> Path:
        """Return the root of all run directories of the study."""
        return self.folder / "runs"

    @property
    def steps(self) -> list[Step]:
        """Return all steps."""
        return steps_of(self.study, self.participant)

    def done(self) -> dict[str, dict[str, Any]]:
        """Return name -> content of the finished steps.

        Raises:
            InputError: a file is damaged.
        """
        found = {}
        for step in self.steps:
            path = self._file(step)
            if not path.is_file():
                break
            try:
                found[step.name] = json.loads(path.read_text(encoding="utf-8"))
            except (OSError, ValueError) as error:
                raise InputError(f"{path}: damaged: {error}") from None
        return found

    def current(self) -> Step | None:
        """Return the first unfinished step; None if all are finished."""
        done = self.done()
        return next((step for step in self.steps if step.name not in done), None)

    def finish(self, step: Step, content: Mapping[str, Any]) -> None:
        """Store the result of a step; that of a finished step stays unchanged.

        Raises:
            InputError: it is not its turn, or the file cannot be written.
        """
        now = self.current()
        if now is None or step.number < now.number:
            return
        if step != now:
            raise InputError(f"{self.participant}: '{now.name}' comes before '{step.name}'")
        document = {"step": step.name, "kind": step.kind, "condition": step.condition, **content}
        text = json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False)
        atomic_write(self._file(step), f"{text}\n")

    def _file(self, step: Step) -> Path:
        return self.home / "steps" / f"{step.name}.json"


def open_progress(study: Study, folder: Path, participant: str) -> StudyProgress:
    """Return the progress of a participant; the folder is marked as the study's.

    Raises:
        InputError: the folder belongs to another study, or to another version of this one.
        UnknownNameError: there is no such participant.
    """
    if participant not in study.spec.people:
        raise UnknownNameError("participant", participant, study.spec.people)
    claim_folder(study, folder)
    return StudyProgress(study, folder, participant)


def claim_folder(study: Study, folder: Path) -> None:
    """Mark a folder as the data of a study.

    Raises:
        InputError: it is that of another one, or cannot be written.
    """
    path, mark = folder / STUDY, {"id": study.spec.id, "sha256": study.digest}
    if not path.is_file():
        atomic_write(path, json.dumps(mark, indent=2) + "\n")
        folder.chmod(0o700)  # answers of people
        return
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: damaged: {error}") from None
    if found != mark:
        raise InputError(
            f"{folder} holds the data of study '{found.get('id')}' as it was; the document "
            "differs from it: take another folder (--data)"
        )
