"""Makes the calibration runs that scores compare with, each once for all runs that need it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from crowdbot.core import run_directory as files
from crowdbot.core.sim.identity import CROWD_ALONE, Reference
from crowdbot.core.sim.outcome import INTERRUPTED, Outcome
from crowdbot.core.sim.record_crowd import RunSetup, record_crowd
from crowdbot.core.sim.request import Request
from crowdbot.core.sim.run_record import ending, write_scenario
from crowdbot.errors import Interrupted, PlannerHungError


def make_references(request: Request, references: Sequence[Reference]) -> dict[str, Path]:
    """Recordings of the calibration runs by name, simulated where they are missing."""
    for reference in references:
        there = reference.settled if request.settled else reference.complete
        if not there:
            make_reference(request, reference)
    return {r.name: r.directory / files.RECORDING for r in references}


def make_reference(request: Request, reference: Reference) -> Outcome:
    """Simulate one calibration run.

    Raises:
        PlannerHungError: a planner step never returned; a ``.partial`` directory is left.
        Interrupted: ``request.stop`` said so; a ``.partial`` directory is left.
    """
    with partial(reference.directory) as folder:
        setup = setup_of(request, reference, folder)
        if reference.name == CROWD_ALONE:
            outcome = record_crowd(setup, reference.key["duration"])
        else:
            from crowdbot.core.sim.record import record_robot  # imports Drake

            outcome = record_robot(setup)
        check_interrupted(outcome, folder)
        write_scenario(folder, reference.trial.scenario, request.registry)
        names = {"run_id": reference.run_id, "reference": reference.name}
        files.write_json(folder / files.RECORD, {**names, **reference.key, **ending(outcome)})
        files.publish(folder, reference.directory)
    return outcome


def setup_of(request: Request, reference: Reference, folder: Path) -> RunSetup:
    """What recording a calibration run needs; only what scores read is recorded."""
    return RunSetup(
        scenario=reference.trial.scenario,
        agents=reference.trial.people.agents,
        registry=request.registry,
        choice=request.choice,
        seed=request.seed,
        recording=folder / files.RECORDING,
        record="none",
        stage=reference.name.replace("_", " "),
        progress=request.progress,
        stop=request.stop,
        on_hang=request.on_hang,
    )


@contextmanager
def partial(final: Path) -> Iterator[Path]:
    """A directory aside; a planner that hangs in it is told together with what is left."""
    with files.partial(final) as folder:
        try:
            yield folder
        except PlannerHungError as error:
            raise PlannerHungError(f"{error}; what was recorded: {folder}") from error


def check_interrupted(outcome: Outcome, folder: Path) -> None:
    """Leave the directory as it is when the user stopped the run.

    Raises:
        Interrupted: he did.
    """
    if outcome.status == INTERRUPTED:
        raise Interrupted(f"interrupted at {outcome.sim_time:.2f} s; what was recorded: {folder}")
