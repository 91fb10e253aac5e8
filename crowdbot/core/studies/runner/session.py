"""Handling of a participant's answers: they finish steps and start drives."""

from __future__ import annotations

import threading
from collections.abc import Mapping

from crowdbot.core.registry.registry import Registry
from crowdbot.core.studies.drives import Drive, drive_words, finished_run, shown_command
from crowdbot.core.studies.forms import checked_answers, questions_of, weights_of
from crowdbot.core.studies.headless import PERSON, SYNTHETIC, trial_content
from crowdbot.core.studies.progress import StudyProgress
from crowdbot.core.studies.runner.render import DriveState, Reply, render_step
from crowdbot.core.studies.steps import Step
from crowdbot.errors import CrowdbotError

_DRIVEN = ("practice", "trial")


class RunnerSession:
    """One participant in front of the page; requests come one at a time.

    Args:
        progress: the participant's.
        synthetic: True if synthetic users drive.
    """

    def __init__(self, progress: StudyProgress, registry: Registry, *, synthetic: bool) -> None:
        self._progress, self._registry, self._synthetic = progress, registry, synthetic
        self._drive: Drive | None = None
        self._reply = Reply()
        self._problem = ""
        self._lock = threading.Lock()

    @property
    def is_over(self) -> bool:
        """Return True if all steps are finished."""
        step = self._progress.current()
        return step is None or step.kind == "end"

    def page(self) -> str:
        """Return the page of the present step."""
        with self._lock:
            step = self._advance()
            reply, self._reply = self._reply, Reply()
            return render_step(self._progress, step, self._state(step), reply)

    def state(self) -> str:
        """Return the state of the present drive; the step's name if there is none."""
        with self._lock:
            step = self._advance()
            if step is None:
                return "end"
            return self._state(step).text(step) if step.kind in _DRIVEN else step.name

    def answer(self, given: Mapping[str, str]) -> None:
        """Handle an answer of the participant; one for an earlier step is ignored."""
        with self._lock:
            step = self._advance()
            if step is None or given.get("step") != step.name:
                return
            if step.kind in _DRIVEN:
                self._start(step)
            elif step.kind == "consent" and given.get("agree") != "yes":
                self._reply = Reply(problem="Taking part needs your agreement.")
            elif step.kind in ("nasa_tlx", "weights", "use"):
                self._answer(step, given)
            elif step.kind != "end":
                self._progress.finish(step, {"driver": self._driver})

    def close(self) -> None:
        """End a running drive."""
        with self._lock:
            if self._drive is not None:
                self._drive.stop()

    @property
    def _driver(self) -> str:
        return SYNTHETIC if self._synthetic else PERSON

    def _answer(self, step: Step, given: Mapping[str, str]) -> None:
        answers, open_ones = checked_answers(questions_of(step.kind, self._progress.study), given)
        if open_ones:
            count = "One question is" if len(open_ones) == 1 else f"{len(open_ones)} questions are"
            self._reply = Reply(
                problem=f"{count} still open:", given=answers, open_names=tuple(open_ones)
            )
            return
        content: dict[str, object] = {"driver": self._driver, "answers": answers}
        if step.kind == "weights":
            content = {**content, "answers": weights_of(answers), "pairs": answers}
        self._progress.finish(step, content)

    def _advance(self) -> Step | None:
        """Finish the present step if it is a completed drive; return the next step."""
        step = self._progress.current()
        while step is not None and step.kind in _DRIVEN and finished_run(self._progress, step):
            if self._drive is not None and self._drive.ended() is None:
                return step
            self._drive, self._problem = None, ""
            self._progress.finish(step, trial_content(self._progress, step, self._driver))
            step = self._progress.current()
        if step is not None and step.kind == "end":
            self._progress.finish(step, {"driver": self._driver})
        return step

    def _start(self, step: Step) -> None:
        if self._drive is not None and self._drive.ended() is None:
            return
        self._problem = ""
        try:
            self._drive = Drive(self._words(step))
            self._drive.start()
        except (CrowdbotError, OSError) as error:
            self._drive, self._problem = None, f"The drive did not begin: {error}"

    def _words(self, step: Step) -> list[str]:
        return drive_words(self._progress, step, self._registry, synthetic=self._synthetic)

    def _state(self, step: Step | None) -> DriveState:
        if step is None or step.kind not in _DRIVEN:
            return DriveState()
        drive, problem = self._drive, self._problem
        code = None if drive is None else drive.ended()
        if drive is not None and code is not None:
            problem = f"The drive ended before it was complete. {drive.problem(code)}"
        running = drive is not None and code is None
        return DriveState(
            running=running,
            url=drive.url if drive is not None and running else "",
            problem=problem,
            command=shown_command(self._words(step)),
            synthetic=self._synthetic,
        )
