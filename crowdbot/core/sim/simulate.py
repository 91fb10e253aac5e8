"""simulate: one scenario, one planner, one seed: references, recording, scores, replay."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from crowdbot.core import provenance
from crowdbot.core import run_directory as files
from crowdbot.core.evaluate import Scores, score
from crowdbot.core.planner_source import resolve_planner
from crowdbot.core.recording import read_cones, read_scans, read_trajectories
from crowdbot.core.registry import Registry
from crowdbot.core.replay import write_replay
from crowdbot.core.scores_table import write_scores_csv
from crowdbot.core.sim.collector import settled_objects
from crowdbot.core.sim.identity import (
    Prepared,
    prepare,
    references_of,
    reusable_record,
    run_identity,
)
from crowdbot.core.sim.needs import check_needs
from crowdbot.core.sim.record import record_robot
from crowdbot.core.sim.record_crowd import RunSetup
from crowdbot.core.sim.references import check_interrupted, make_references, partial
from crowdbot.core.sim.request import Request, Run, read_references
from crowdbot.core.sim.run_record import run_record, write_scenario
from crowdbot.core.trajectory import Trajectories
from crowdbot.core.watchdog import STEP_LIMIT
from crowdbot.dsl.scenario import Scenario
from crowdbot.errors import InputError

_REPLAY_RATE = 8.0  # scans per second that the replay page holds, Hz


def simulate(
    scenario: Scenario,
    registry: Registry,
    *,
    planner: str = "dwa",
    planner_settings: Sequence[str] = (),
    seed: int = 0,
    out: Path | None = None,
    **options: Any,
) -> Run:
    """Simulate and score one run; a complete run with the same hashes is reused.

    Args:
        scenario: from an expanded suite.
        registry: the installed components.
        planner: kind, YAML file or ``file.py:Class``.
        planner_settings: ``key=value`` texts.
        seed: run seed: sensor noise and planner.
        out: root of the run directories; None uses a temporary one that lives as long as the
            result.
        options: further fields of `Request`.

    Raises:
        InputError: the scenario has no robot, the planner or the folder is wrong, or the lock
            of the suite does not fit it any more.
        PlannerHungError: a planner step never returned; a ``.partial`` directory is left.
        Interrupted: ``stop`` said so; a ``.partial`` directory is left.
    """
    choice = resolve_planner(planner, registry, planner_settings)
    check_budget(options.get("step_budget"))
    keep = None
    if out is None:
        keep = tempfile.TemporaryDirectory(prefix="crowdbot-")
        out = Path(keep.name)
    request = Request(
        scenario=scenario, choice=choice, registry=registry, seed=seed, out=out, **options
    )
    return make_run(request, prepare(scenario, registry, references=request.references), keep)


def check_budget(seconds: float | None) -> None:
    """Refuse a budget of planner steps that can never be used up, or is no time at all.

    Raises:
        InputError: it is one.
    """
    if seconds is not None and not 0.0 < seconds < STEP_LIMIT:
        raise InputError(
            f"the budget of a step must be above 0 and below {STEP_LIMIT:g} s, "
            f"after which it counts as hung; not {seconds:g}"
        )


def make_run(request: Request, prepared: Prepared, keep: object = None) -> Run:
    """Simulate and score one run whose scenario is prepared; see `simulate`.

    Args:
        request: what is wanted.
        prepared: its scenario.
        keep: lives as long as the result.
    """
    check_needs(request)
    identity = run_identity(request, prepared.run)
    references = references_of(request, prepared)
    if not request.force:
        run_id = provenance.digest(identity)
        record = reusable_record(request, run_id, compared=bool(references))
        if record is not None:
            return Run(request.directory, record, reused=True, _keep=keep)
    with settled_objects():
        paths = make_references(request, references)
        record = _record_run(request, prepared, identity, paths)
    return Run(request.directory, record, _keep=keep)


# --------------------------------------------------------------------------- the run
def _record_run(
    request: Request,
    prepared: Prepared,
    identity: Mapping[str, Any],
    references: Mapping[str, Path],
) -> dict[str, Any]:
    final = request.directory
    with partial(final) as folder:
        outcome = record_robot(_setup(request, prepared, folder))
        check_interrupted(outcome, folder)
        run = read_trajectories(folder / files.RECORDING)
        calibration = read_references(references)
        scores = score(
            request.registry,
            run,
            calibration.robot_alone,
            calibration.crowd_alone,
            metrics="*" if request.metrics is None else request.metrics,
        )
        record = run_record(request, identity, references, outcome, run, scores)
        record["agents"] = prepared.run.people.source
        _write_files(request, folder, run, scores, record)
        files.publish(folder, final)
    return record


def _write_files(
    request: Request, folder: Path, run: Trajectories, scores: Scores, record: Mapping[str, Any]
) -> None:
    scenario = request.scenario
    write_scenario(folder, scenario, request.registry)
    write_scores_csv(folder / files.SCORES, scores, scenario.id, request.choice.label, request.seed)
    if request.replay:
        _write_replay(request, folder, run, scores, record)
    files.write_json(folder / files.RECORD, record)


def _write_replay(
    request: Request, folder: Path, run: Trajectories, scores: Scores, record: Mapping[str, Any]
) -> None:
    scenario, arrival = request.scenario, record["goal_time"]
    recording = folder / files.RECORDING
    write_replay(
        folder / files.REPLAY,
        run,
        [*read_scans(recording, max_rate=_REPLAY_RATE), *read_cones(recording, _REPLAY_RATE)],
        scores,
        title=f"{scenario.id} · {request.choice.label}",
        facts={
            "Suite": request.suite,
            "Scenario": scenario.id,
            "Planner": request.choice.label,
            **provenance.remarks(record),
            "Seed": str(request.seed),
            "Status": record["status"],
            "Arrived at": "—" if arrival is None else f"{arrival:.2f} s",
            "Spec": record["hashes"]["spec"][:24],
        },
    )


def _setup(request: Request, prepared: Prepared, folder: Path) -> RunSetup:
    return RunSetup(
        scenario=request.scenario,
        agents=prepared.run.people.agents,
        registry=request.registry,
        choice=request.choice,
        seed=request.seed,
        recording=folder / files.RECORDING,
        record=request.record,
        stage="run",
        progress=request.progress,
        stop=request.stop,
        on_hang=request.on_hang,
        step_budget=request.step_budget,
    )
