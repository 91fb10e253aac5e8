"""The document of a study: participants, conditions, trials, texts and forms."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from annotated_types import Ge, Le, MaxLen, MinLen
from pydantic import Field, StringConstraints, field_validator

from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.registry.registry import Registry
from crowdbot.core.scenarios.library import open_spec, select
from crowdbot.dsl.checks.pydantic_errors import mark_of
from crowdbot.dsl.checks.read_model import read_model
from crowdbot.dsl.spec.component_specs import PlannerDocument
from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.spec import Spec
from crowdbot.dsl.text.diagnostics import Diagnostic
from crowdbot.dsl.text.nodes import Node
from crowdbot.errors import CrowdbotError, InputError, SpecError

#: A pseudonym: up to three letters and a number, which no name is.
ParticipantId = Annotated[str, StringConstraints(pattern=r"^[a-z]{0,3}[0-9]{1,4}$")]
_Label = Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9_-]{0,39}$")]
_Text = Annotated[str, MaxLen(20_000)]
FormName = Literal["nasa_tlx", "use"]
#: Most participants.
_MOST = 500


class StudyTrial(Spec):
    """A scenario that is driven once in each condition."""

    suite: str = Field(description="A suite's file, relative to the study's, or its name.")
    scenario: str = Field(description="Id of a scenario of the suite.")


class StudyCondition(Spec):
    """A condition, which participants compare with others."""

    planner: PlannerDocument = Field(
        description="Planner that gets the user's commands: a document, a kind, or a file."
    )
    title: str = default("", "Name for reports; unset: its label.")
    shown: str = default("", "Name for participants; unset: A, B, … in the order of theirs.")


class StudySpec(Spec):
    """A study within participants: all of them drive in all conditions."""

    id: _Label = Field(description="Name of the study.")
    title: str = Field(description="Heading of its pages.")
    seed: Annotated[int, Ge(0), Le(2**31)] = default(
        0, "Seed of the runs, and of orders that are drawn."
    )
    participants: (
        Annotated[int, Ge(1), Le(_MOST)] | Annotated[tuple[ParticipantId, ...], Field(strict=False)]
    ) = Field(description="How many (p01, p02, …), or their pseudonyms, such as [p01, p02].")
    conditions: Annotated[dict[_Label, StudyCondition], MinLen(1)] = Field(
        description="Conditions by label; the first is what the others are compared with."
    )
    trials: Annotated[tuple[StudyTrial, ...], MinLen(1)] = Field(
        strict=False, description="Driven in each condition."
    )
    practice: StudyTrial | None = default(
        None, "Driven first in each condition, without being scored."
    )
    order: Literal["williams", "latin", "fixed"] = default(
        "williams",
        "Order of conditions: balanced for what came before (Williams), a Latin square, or as "
        "written.",
    )
    trial_order: Literal["fixed", "drawn"] = default(
        "fixed", "Order of trials within a condition: as written, or drawn."
    )
    consent: _Text = Field(description="Text that participants agree to; blank lines part it.")
    welcome: _Text = default("", "Text before the first drive.")
    thanks: _Text = default("", "Text at the end.")
    forms: tuple[FormName, ...] = default(
        ("nasa_tlx", "use"), "Asked after each condition.", strict=False
    )
    tlx_weights: Literal["each", "once", "none"] = default(
        "once", "When the 15 comparisons of NASA-TLX are asked."
    )
    use_wording: str = default("", "File with the 30 items of USE, one a line; unset: paraphrased.")
    synthetic: tuple[dict[str, Any], ...] = default(
        (),
        "Joysticks of synthetic participants, one after the other; unset: the scenarios' own.",
        strict=False,
    )

    @field_validator("participants")
    @classmethod
    def _apart(cls, value: int | tuple[str, ...]) -> int | tuple[str, ...]:
        if isinstance(value, tuple) and len(set(value)) < len(value):
            raise ValueError("two participants have the same pseudonym")
        if isinstance(value, tuple) and not 1 <= len(value) <= _MOST:
            raise ValueError(f"write 1 to {_MOST} participants")
        return value

    @property
    def people(self) -> tuple[str, ...]:
        """Return the pseudonyms."""
        if isinstance(self.participants, tuple):
            return self.participants
        width = max(2, len(str(self.participants)))
        return tuple(f"p{k:0{width}d}" for k in range(1, self.participants + 1))


class StudyDocument(Spec):
    """A file with a study."""

    crowdbot: Literal[1] = Field(description="Version of the format.")
    study: StudySpec = Field(description="The study.")


@dataclass(frozen=True, slots=True)
class Study:
    """A study and the file that describes it."""

    spec: StudySpec
    path: Path

    @property
    def digest(self) -> str:
        """Return the SHA-256 of its content."""
        text = json.dumps(self.spec.model_dump(mode="json"), sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()

    def beside(self, text: str) -> str:
        """Return the path of a file that the document names; other names are returned unchanged."""
        here = self.path.parent / text
        return str(here.resolve()) if text.endswith((".yaml", ".yml")) or "/" in text else text


def read_study(path: Path, registry: Registry | None = None) -> Study:
    """Return the study of a file.

    Args:
        registry: checks planners and scenarios, too.

    Raises:
        SpecError: the file is wrong; errors have their place in it.
    """
    made, tree = read_model(path, StudyDocument)
    study = Study(made.study, path)
    if registry is not None:
        problems = list(_problems(study, tree, registry))
        if problems:
            raise SpecError(problems)
    return study


def planner_text(study: Study, condition: StudyCondition, registry: Registry) -> str:
    """Return the value of ``--planner`` for a condition; its document lies beside the study.

    Raises:
        InputError: the planner is wrong.
    """
    planner = condition.planner
    if isinstance(planner, dict):
        if set(planner) != {"kind"}:
            raise InputError(
                "a planner with parameters needs a file of its own: write its fields there, and "
                "name the file here"
            )
        planner = str(planner["kind"])
    path, colon, name = planner.rpartition(":")
    text = f"{study.beside(path)}{colon}{name}" if path else study.beside(planner)
    resolve_planner(text, registry)
    return text


def _problems(study: Study, tree: Node, registry: Registry) -> Iterator[Diagnostic]:
    """Yield errors of planners, suites and scenarios that the study names, with their position."""
    for label, condition in study.spec.conditions.items():
        try:
            _check_planner(study, condition, registry)
        except CrowdbotError as error:
            yield _at(tree, error, "study", "conditions", label, "planner")
    named: list[tuple[StudyTrial, tuple[str | int, ...]]] = [
        (trial, ("study", "trials", k)) for k, trial in enumerate(study.spec.trials)
    ]
    if study.spec.practice is not None:
        named.append((study.spec.practice, ("study", "practice")))
    for trial, place in named:
        try:
            found = select(open_spec(study.beside(trial.suite), registry), trial.scenario)
        except CrowdbotError as error:
            yield _at(tree, error, *place, "suite")
            continue
        if len(found) != 1:
            text = f"{len(found)} scenarios of {trial.suite} fit '{trial.scenario}', not one"
            yield _at(tree, InputError(text), *place, "scenario")


def _check_planner(study: Study, condition: StudyCondition, registry: Registry) -> None:
    if isinstance(condition.planner, dict):
        document = dict(condition.planner)
        kind = document.pop("kind", None)
        if not isinstance(kind, str):
            raise InputError("'kind' is missing: which planner is it?")
        resolve_planner(kind, registry, [f"{k}={json.dumps(v)}" for k, v in document.items()])
    else:
        planner_text(study, condition, registry)


def _at(tree: Node, error: CrowdbotError, *place: str | int) -> Diagnostic:
    return Diagnostic("E115", str(error).strip(), mark_of(tree, *place))
