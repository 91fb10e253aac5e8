"""simulate: run one scenario with one planner and seed: references, recording, scores, replay."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

from crowdbot.core.crowd.compile_ahead import crowd_compiled_ahead
from crowdbot.core.environments.build import build_environment
from crowdbot.core.planning.choice import NO_ROBOT
from crowdbot.core.planning.given_planner import GivenPlanner, choose_planner
from crowdbot.core.recording.container.own_file import Written
from crowdbot.core.recording.reading.images import ImageCollector
from crowdbot.core.recording.reading.scans import REPLAY_RATE
from crowdbot.core.recording.watcher import Watcher
from crowdbot.core.registry.registry import Registry
from crowdbot.core.replay.page import write_replay
from crowdbot.core.runs import provenance
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.excused import excuse_of, with_draw
from crowdbot.core.runs.identity import (
    Prepared,
    prepare,
    recorded_otherwise,
    references_of,
    reusable_record,
    run_identity,
)
from crowdbot.core.runs.make_record import make_record, write_scenario
from crowdbot.core.runs.outcome import Outcome, Progress
from crowdbot.core.runs.planner_files_kept import keep_planner_files
from crowdbot.core.runs.read_and_score import (
    read_robots,
    references_by_robot,
    score_robots,
)
from crowdbot.core.runs.record_parts import ExcusedPart
from crowdbot.core.runs.replayed import images_of_replay, shown_run
from crowdbot.core.runs.run import Request, Run
from crowdbot.core.runs.run_options import USUAL, RunOptions
from crowdbot.core.runs.run_record import RunIdentity, RunRecord
from crowdbot.core.scoring.evaluate import metric_specs
from crowdbot.core.scoring.scores_csv import write_scores_csv
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.gc_freeze import gc_frozen
from crowdbot.core.sim.preflight import preflight
from crowdbot.core.sim.record import record_robots
from crowdbot.core.sim.references import check_interrupted, make_references, partial
from crowdbot.core.sim.run_setup import RunSetup, record_crowd
from crowdbot.core.support.arguments import expect, expect_function, whole_number_of
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.suite_entry import IN_NO_SUITE, SuiteEntry
from crowdbot.dsl.text.path_names import path_problem
from crowdbot.errors import InputError

_USUAL_PLANNER = "dwa"


def simulate(
    scenario: Scenario,
    registry: Registry,
    *,
    planner: GivenPlanner = _USUAL_PLANNER,
    planner_settings: Sequence[str] | Mapping[str, object] = (),
    seed: int = 0,
    out: Path | None = None,
    entry: SuiteEntry = IN_NO_SUITE,
    options: RunOptions = USUAL,
    progress: Callable[[Progress], None] | None = None,
    stop: Callable[[], bool] = lambda: False,
    on_hang: Callable[[], object] | None = None,
    watchers: Sequence[Watcher] = (),
) -> Run:
    """Simulate and score one run; a complete run with the same hashes is reused.

    Args:
        scenario: from an expanded suite; without a robot, its people walk alone.
        registry: the installed components.
        planner, planner_settings: arguments of `choose_planner`; runs of an object or function are
            never reused.
        seed: run seed: sensor noise and planner.
        out: root of the run directories; None uses a temporary one that lives as long as the
            result.
        entry, options: as in `Request`.
        progress, stop, on_hang, watchers: as in `Request`.

    Raises:
        InputError: the scenario has neither robot nor people, or no robot for a planner; planner,
            folder or an option is wrong, or the suite's lock is out of date.
        UnknownNameError: no metric matches a pattern.
        PlannerHungError: a step of a planner in this process never returned; a ``.partial``
            directory is left.
        Interrupted: ``stop`` returned True; a ``.partial`` directory is left.
    """
    seed = whole_number_of("seed", seed)
    _check_suite(entry.suite)
    _check_callbacks(progress, stop)
    if scenario.robots:
        _check_duration(scenario, options)
        choice = choose_planner(planner, registry, planner_settings, options.place)
    else:
        _check_people_alone(scenario, planner, planner_settings, watchers)
        choice = NO_ROBOT
    if options.metrics is not None:
        metric_specs(registry, options.metrics, {})  # a wrong name ends the run before it begins
    keep = None
    if out is None:
        keep = tempfile.TemporaryDirectory(prefix="crowdbot-")
        out = Path(keep.name)
    request = Request(
        scenario=scenario,
        choice=choice,
        registry=registry,
        seed=seed,
        out=out,
        entry=entry,
        options=replace(options, force=options.force or not choice.repeatable),
        progress=progress,
        stop=stop,
        on_hang=on_hang,
        watchers=watchers,
    )
    with crowd_compiled_ahead() if scenario.crowd else nullcontext():
        prepared = prepare(scenario, registry, references=options.references, people_alone=True)
        return make_run(request, prepared, keep)


def _check_duration(scenario: Scenario, options: RunOptions) -> None:
    """Refuse the option ``duration`` if the scenario has robots, whose tasks end the run."""
    if options.duration is not None:
        raise InputError(
            f"{scenario.id} has a robot, whose task ends the run; a duration is for people alone. "
            "Change robots.NAME.task.time_limit instead"
        )


def _check_people_alone(
    scenario: Scenario, planner: object, settings: object, watchers: Sequence[Watcher]
) -> None:
    """Refuse what needs a robot where there is none.

    Raises:
        InputError: there is a planner other than the default one, settings for it, or a watcher.
    """
    if planner != _USUAL_PLANNER or settings:
        raise InputError(f"{scenario.id} has no robot, so there is nothing for a planner to drive")
    if watchers:
        raise InputError(f"{scenario.id} has no robot; live views show runs of robots")


def _check_callbacks(progress: object, stop: object) -> None:
    """Refuse callbacks that are not callable.

    Raises:
        InputError: one is not callable.
    """
    if progress is not None:
        expect_function("progress", progress)
    expect_function("stop", stop)


def _check_suite(suite: str) -> None:
    """Check that the name of a suite can be the name of a folder.

    Raises:
        InputError: it cannot.
    """
    expect("suite", suite, str)
    if suite != Path(suite).name or path_problem(suite):
        raise InputError(f"suite '{suite}' must be usable as the name of a folder")


def make_run(
    request: Request,
    prepared: Prepared,
    keep: object = None,
    builts: Mapping[str, BuiltRun] | None = None,
) -> Run:
    """Simulate and score one run of a prepared scenario; see `simulate`.

    Args:
        prepared: its scenario.
        keep: object kept alive with the result.
        builts: result of `preflight` for the request, if the caller has it; not reusable.
    """
    if builts is None:
        builts = preflight(request) if request.scenario.robots else {}
    identity = run_identity(request, prepared.run)
    references = references_of(request, prepared)
    if not request.options.force:
        record = reusable_record(request, identity.id(), compared=bool(references))
        if record is not None:
            return Run(request.directory, record, reused=True, _keep=keep)
    replaced = recorded_otherwise(request, identity)
    with gc_frozen():
        record = _counted_run(request, prepared, builts, identity)
    return Run(request.directory, record, replaced=replaced, _keep=keep)


# --------------------------------------------------------------------------- the run
def _counted_run(
    request: Request, prepared: Prepared, builts: Mapping[str, BuiltRun], identity: RunIdentity
) -> RunRecord:
    """Make the run; repeat it with the next draw while it is excused and draws may be replaced."""
    excused: list[ExcusedPart] = []
    while True:
        paths = make_references(request, references_of(request, prepared))
        found = _record_run(request, prepared, builts, identity, paths, excused)
        if isinstance(found, RunRecord):
            return found
        excused.append(found)
        scenario = with_draw(request.scenario, len(excused))
        compared = request.options.references
        prepared = prepare(scenario, request.registry, references=compared)
        builts = preflight(replace(request, scenario=scenario))


def _record_run(
    request: Request,
    prepared: Prepared,
    builts: Mapping[str, BuiltRun],
    identity: RunIdentity,
    references: Mapping[str, Path],
    excused: Sequence[ExcusedPart],
) -> RunRecord | ExcusedPart:
    final = request.directory
    parts = _parts(request, builts)
    with partial(final) as folder:
        setup = _setup(request, prepared, folder, identity)
        outcome = record_robots(setup, builts) if builts else record_crowd(setup, identity.duration)
        check_interrupted(outcome, folder)
        files.check_recorded(folder, outcome.written)
        images = _images(request, builts, folder / files.RECORDING)
        names = tuple(builts) or ("",)
        seen = read_robots(folder / files.RECORDING, names, REPLAY_RATE, images)
        runs = {name: one.run for name, one in seen.items()}
        excuse = _new_excuse(request, outcome, runs, prepared.run.realisation, excused)
        if excuse is not None:
            shutil.rmtree(folder)
            return excuse
        scores = score_robots(
            request.registry,
            runs,
            references_by_robot(references, names),
            metrics="*" if request.options.metrics is None else request.options.metrics,
        )
        record = make_record(
            request, identity, prepared.run.people, references, outcome, runs, scores, parts=parts
        )
        if excused:
            record = record.model_copy(update={"excused": list(excused)})
        write_scenario(folder, request.scenario, request.registry)
        label = request.choice.label
        write_scores_csv(folder / files.SCORES, scores, request.scenario.id, label, request.seed)
        if request.options.replay:
            models = {name: built.model for name, built in builts.items()}
            shown = [] if images is None else images.images()
            agents = prepared.run.people.agents
            page = shown_run(request.scenario, seen, models, parts, record, scores, shown, agents)
            write_replay(folder / files.REPLAY, page)
        record = _finish(folder, record, outcome.written)
        files.publish(folder, final)
    keep_planner_files(request.out, request.choice.all_files)
    return record


def _new_excuse(
    request: Request,
    outcome: Outcome,
    runs: Mapping[str, Trajectories],
    realisation: str,
    excused: Sequence[ExcusedPart],
) -> ExcusedPart | None:
    """Return why another draw replaces this run, if it may, and no draw like it was replaced."""
    if len(excused) >= request.options.replace_draws:
        return None
    excuse = excuse_of(outcome, runs, realisation, len(excused))
    known = {e.realisation for e in excused}
    return None if excuse is None or excuse.realisation in known else excuse


def _parts(request: Request, builts: Mapping[str, BuiltRun]) -> EnvironmentParts:
    """Return the environment of the robots, or of people alone."""
    if builts:
        return next(iter(builts.values())).parts
    return build_environment(request.registry, request.scenario.environment)


def _images(
    request: Request, builts: Mapping[str, BuiltRun], recording: Path
) -> ImageCollector | None:
    """Return a collector of images for the page; None if it shows none."""
    infos = [info for built in builts.values() for info in built.infos.values()]
    options = request.options
    shows = options.replay and options.record != "none" and any(info.camera for info in infos)
    return images_of_replay(recording) if shows else None


def _finish(folder: Path, record: RunRecord, written: Written | None) -> RunRecord:
    """Write the record, with sizes and digests of the other files."""
    ending = files.attach_files(folder, record.document())
    recorded = {} if written is None else {files.RECORDING: written.with_ending(ending)}
    listed = {"files": files.sizes(folder), "digests": files.digests(folder, recorded)}
    whole = record.model_copy(update=listed)
    whole.write(folder)
    return whole


def _setup(request: Request, prepared: Prepared, folder: Path, identity: RunIdentity) -> RunSetup:
    return RunSetup.of(
        request,
        prepared.run,
        recording=folder / files.RECORDING,
        stage="run",
        hashes=provenance.recording_hashes(identity),
        watchers=request.watchers,
        on_crowd=request.on_crowd,
    )
