"""Simulated participants: synthetic users drive, texts are skipped, forms stay unanswered."""

from __future__ import annotations

from collections.abc import Callable

from crowdbot.core.registry.registry import Registry
from crowdbot.core.studies.drives import Drive, drive_words, finished_run
from crowdbot.core.studies.progress import StudyProgress
from crowdbot.core.studies.steps import Step
from crowdbot.errors import InputError

#: Name of the driver of a trial in tables.
SYNTHETIC, PERSON = "synthetic", "person"


def finish_all(progress: StudyProgress, registry: Registry, say: Callable[[str], object]) -> None:
    """Finish all remaining steps.

    Args:
        say: called with a line before each step.

    Raises:
        InputError: a drive failed, or a file cannot be written.
    """
    while (step := progress.current()) is not None:
        say(f"{progress.participant}: {step.name}")
        progress.finish(step, _content(progress, step, registry))


def _content(progress: StudyProgress, step: Step, registry: Registry) -> dict[str, object]:
    if step.kind not in ("practice", "trial"):
        return {"driver": SYNTHETIC, "answers": None}
    if finished_run(progress, step) is None:
        drive = Drive(drive_words(progress, step, registry, synthetic=True))
        drive.start()
        try:
            drive.wait()
        finally:
            drive.stop()
    return trial_content(progress, step, SYNTHETIC)


def trial_content(progress: StudyProgress, step: Step, driver: str) -> dict[str, object]:
    """Return the stored result of a finished drive.

    Raises:
        InputError: its run directory is not there.
    """
    run = finished_run(progress, step)
    if run is None:
        raise InputError(f"{progress.participant}: {step.name}: the run is not complete")
    return {"driver": driver, "run": run.relative_to(progress.folder).as_posix()}
