"""Run the calibration runs for scores, once for all runs that need them."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from crowdbot.core.runs import provenance
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.identity import CROWD_ALONE, Reference
from crowdbot.core.runs.make_record import ending, write_scenario
from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.runs.run import Request
from crowdbot.core.runs.run_record import ReferenceRecord
from crowdbot.core.sim.built_run import build_runs
from crowdbot.core.sim.gc_freeze import gc_frozen
from crowdbot.core.sim.run_setup import RunSetup, record_crowd
from crowdbot.core.types.ending import Ending
from crowdbot.errors import Interrupted, PluginError

_LOG = logging.getLogger("crowdbot")


def make_references(request: Request, references: Sequence[Reference]) -> dict[str, Path]:
    """Return recordings of the calibration runs by name, simulated if missing."""
    for reference in references:
        present = reference.finished if request.references_finished else reference.complete
        if not present:
            make_reference(request, reference)
    return {r.name: r.directory / files.RECORDING for r in references}


def make_reference(request: Request, reference: Reference) -> Outcome:
    """Simulate one calibration run.

    Raises:
        PlannerHungError: a planner step never returned; a ``.partial`` directory is left.
        Interrupted: ``request.stop`` returned True; a ``.partial`` directory is left.
    """
    with gc_frozen(), partial(reference.directory) as folder:
        setup = setup_of(request, reference, folder)
        if reference.name == CROWD_ALONE:
            outcome = record_crowd(setup, reference.identity.duration)
        else:
            outcome = _record_alone(setup)
        check_interrupted(outcome, folder)
        recorded = files.check_recorded(folder, outcome.written)
        if outcome.status == Ending.PLANNER_FAILED:
            _LOG.warning("%s: the planner failed: %s", reference.name, outcome.reason)
        write_scenario(folder, reference.trial.scenario, request.registry)
        ReferenceRecord(
            run_id=reference.run_id,
            **{n: getattr(reference.identity, n) for n in reference.identity.model_fields_set},
            **ending(outcome),
            files=files.sizes(folder),
            digests=files.digests(folder, recorded),
        ).write(folder)
        files.publish(folder, reference.directory)
    return outcome


def _record_alone(setup: RunSetup) -> Outcome:
    """Run separately, without the memory of sensors and planner from the run with people."""
    from crowdbot.core.sim.record import record_robots  # imports Drake

    builts = build_runs(setup.scenario, setup.registry, setup.choice, setup.options.record)
    return record_robots(setup, builts)


def setup_of(request: Request, reference: Reference, folder: Path) -> RunSetup:
    """Return the setup of a calibration run; only data for scores is recorded."""
    return RunSetup.of(
        request,
        reference.trial,
        recording=folder / files.RECORDING,
        stage=reference.name.replace("_", " "),
        options=replace(request.options, record="none"),
        hashes=provenance.recording_hashes(reference.identity),
    )


@contextmanager
def partial(final: Path) -> Iterator[Path]:
    """Yield a temporary directory; errors of plugins mention it."""
    with files.partial(final) as folder:
        try:
            yield folder
        except PluginError as error:
            if not (folder / files.RECORDING).exists():
                raise
            raise type(error)(f"{error}; what was recorded: {folder}") from error


def check_interrupted(outcome: Outcome, folder: Path) -> None:
    """Keep the directory if the user stopped the run.

    Raises:
        Interrupted: the user stopped the run.
    """
    if outcome.status == Ending.INTERRUPTED:
        raise Interrupted(f"interrupted at {outcome.sim_time:.2f} s; what was recorded: {folder}")
