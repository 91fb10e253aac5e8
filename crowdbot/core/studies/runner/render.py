"""The page of a step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from crowdbot.core.studies.document import Study
from crowdbot.core.studies.forms import Question, questions_of
from crowdbot.core.studies.progress import StudyProgress
from crowdbot.core.studies.steps import Step
from crowdbot.core.support.html_page import Allowed, render_page

#: Headings of forms, and what stands before their questions.
_FORMS = {
    "nasa_tlx": ("Workload", "Think of the drives that you have just done. Choose one mark on "
                 "each scale."),
    "weights": ("What counted", "Of each two, which one contributed more to the workload of these "
                "drives?"),
    "use": ("Usability", "Think of the drives that you have just done. How far do you agree?"),
}  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveState:
    """The drive of the present step.

    Attributes:
        running: True while its process goes on.
        url: of the page on which it is driven; empty if there is none (yet).
        problem: why the last try failed; empty if it did not.
        command: that is run.
        synthetic: True if no person drives.
    """

    running: bool = False
    url: str = ""
    problem: str = ""
    command: str = ""
    synthetic: bool = False

    def text(self, step: Step) -> str:
        """Return the state as one text, which changes when the page has to."""
        how = "running" if self.running else "waiting"
        return f"drive:{step.name}:{how}:{bool(self.url)}:{bool(self.problem)}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Reply:
    """Errors of the last answer to the page.

    Attributes:
        problem: for the participant; empty if nothing was.
        given: answers so far.
        open_names: questions that need an answer.
    """

    problem: str = ""
    given: Mapping[str, str] = field(default_factory=dict)
    open_names: Sequence[str] = ()


def render_step(progress: StudyProgress, step: Step | None, drive: DriveState, reply: Reply) -> str:
    """Return the page of a participant's present step; None: all are done."""
    steps = progress.steps
    step = step or steps[-1]
    content: dict[str, Any] = {
        "title": progress.study.spec.title,
        "participant": progress.participant,
        "number": step.number,
        "count": len(steps),
        "step": step.name,
        "state": step.name,
        "problem": reply.problem,
        "given": reply.given,
        "open_names": reply.open_names,
        "open_questions": [],
        "questions": [],
        "paragraphs": [],
        "buttons": [("next", "Continue")],
        "form": True,
        "agree": "",
        "command": "",
        "link": "",
        "status": "",
        **_of_step(progress.study, step, drive),
    }
    questions: Sequence[Question] = content["questions"]
    content["open_questions"] = [(q.name, q.title) for q in questions if q.name in reply.open_names]
    content["problem"] = content["problem"] or drive.problem
    return render_page(
        __package__, scripts=("page.js",), allowed=Allowed(connect="'self'", forms=True), **content
    )


def _of_step(study: Study, step: Step, drive: DriveState) -> dict[str, Any]:
    spec = study.spec
    if step.kind == "consent":
        return {
            "heading": "Consent",
            "paragraphs": _paragraphs(spec.consent),
            "agree": "I have read this and agree to take part.",
        }
    if step.kind == "welcome":
        return {"heading": "Welcome", "paragraphs": _paragraphs(spec.welcome)}
    if step.kind == "end":
        text = spec.thanks or "That was all. Thank you for taking part."
        return {"heading": "The end", "paragraphs": _paragraphs(text), "form": False}
    if step.kind in ("practice", "trial"):
        return _of_drive(step, drive)
    heading, text = _FORMS[step.kind]
    return {
        "heading": f"{heading}, mode {step.shown}",
        "paragraphs": [text],
        "questions": questions_of(step.kind, study),
    }


def _of_drive(step: Step, drive: DriveState) -> dict[str, Any]:
    """Return the parts of the page that show a drive."""
    title = f"Drive {step.index}" if step.kind == "trial" else "Practice"
    parts: dict[str, Any] = {
        "heading": f"{title}, mode {step.shown}",
        "state": drive.text(step),
        "command": drive.command if drive.problem else "",  # it names the condition
    }
    if drive.running:
        text = "Drive on the page that opens by the button. This page goes on by itself afterwards."
        if drive.synthetic:
            text = "A synthetic user drives. This page goes on by itself afterwards."
        elif not drive.url:
            text = "The driving page is being prepared."
        return {**parts, "paragraphs": [text], "link": drive.url, "form": False,
                "status": "The drive goes on."}  # fmt: skip
    text = (
        "Get used to the robot and to this mode; this drive does not count."
        if step.kind == "practice"
        else "Drive to the goal as well as you can."
    )
    return {**parts, "paragraphs": [text], "buttons": [("start", "Start the drive")]}


def _paragraphs(text: str) -> list[str]:
    return [" ".join(part.split()) for part in text.split("\n\n") if part.strip()]
