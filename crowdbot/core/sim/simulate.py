"""simulate: one scenario, one planner, one seed: references, recording, scores, replay."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from crowdbot.core import provenance
from crowdbot.core import run_directory as files
from crowdbot.core.environments import build_environment
from crowdbot.core.evaluate import Scores, score
from crowdbot.core.lock import Population, population
from crowdbot.core.planner_source import resolve_planner, select_sensors
from crowdbot.core.recording import read_scans, read_trajectories
from crowdbot.core.registry import Registry
from crowdbot.core.replay import write_replay
from crowdbot.core.robots import build_robot
from crowdbot.core.scores_table import write_scores_csv
from crowdbot.core.sensing.guard import build_sensor
from crowdbot.core.sim.record import RunSetup, record_crowd, record_robot
from crowdbot.core.sim.request import Request, Run, read_references
from crowdbot.core.sim.runner import INTERRUPTED, PLANNER_FAILED, Outcome
from crowdbot.core.trajectory import Trajectories
from crowdbot.dsl.canonical import content_hash, dump_scenario_yaml
from crowdbot.dsl.scenario import Scenario
from crowdbot.errors import InputError, Interrupted, PlannerHungError

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
    keep = None
    if out is None:
        keep = tempfile.TemporaryDirectory(prefix="crowdbot-")
        out = Path(keep.name)
    request = Request(
        scenario=scenario, choice=choice, registry=registry, seed=seed, out=out, **options
    )
    if len(scenario.robots) != 1:
        raise InputError(
            f"{scenario.id} has {len(scenario.robots)} robots; this release simulates exactly one"
        )
    _check_needs(request)
    people = population(scenario, registry)
    identity = _identity(request, people)
    if not request.force and _reusable(request, identity):
        record = files.read_record(request.directory)
        assert record is not None
        return Run(request.directory, record, reused=True, _keep=keep)
    references = _references(request, people) if _wants_references(request) else {}
    record = _record_run(request, identity, people, references)
    return Run(request.directory, record, _keep=keep)


def _check_needs(request: Request) -> None:
    """Refuse what this robot, or this machine, cannot give before anything is written.

    Raises:
        InputError: the robot lacks a sensor that the planner needs, or its control mode does not
            fit its drive.
        PluginError: environment, robot or a sensor cannot be built.
        MissingLibraryError: colour images are wanted where they cannot be drawn.
    """
    (robot,) = request.scenario.robots.values()
    build_environment(request.registry, request.scenario.environment)
    build_robot(request.registry, robot)
    infos = {n: build_sensor(request.registry, x).info() for n, x in robot.sensors.items()}
    choice = request.choice
    visible = select_sensors(choice.needs, infos, choice.name, privileged=choice.privileged)
    cameras = [infos[n].camera for n in (infos if request.record == "all" else visible)]
    if any(camera is not None and camera.colour for camera in cameras):
        from crowdbot.core.sim.rendering import check_egl

        check_egl()


def _wants_references(request: Request) -> bool:
    """Without people a run is its own reference; there is nothing to compare."""
    return request.references and request.scenario.crowd is not None


def _identity(request: Request, people: Population) -> dict[str, Any]:
    """Everything that decides what happens in a run."""
    scenario, registry = request.scenario, request.registry
    return {
        "scenario": scenario.id,
        "suite": request.suite,
        "planner": {
            **request.choice.spec_dump,
            "name": request.choice.name,
            "label": request.choice.label,
        },
        "seed": request.seed,
        "hashes": {
            "spec": content_hash(scenario, registry.spec_versions(scenario)),
            "realisation": people.agents.hash,
        },
        "versions": provenance.versions(),
        "plugins": provenance.plugins(registry),
    }


def _reusable(request: Request, identity: Mapping[str, Any]) -> bool:
    record = files.read_record(request.directory)
    return (
        record is not None
        and record.get("run_id") == provenance.digest(identity)
        and record.get("recorded") == request.record
        and (bool(record.get("references")) or not _wants_references(request))
    )


# ------------------------------------------------------------------------ references
def _references(request: Request, people: Population) -> dict[str, Path]:
    """Recordings of the calibration runs, simulated where they are missing."""
    scenario = request.scenario
    alone = scenario.references.get("robot_alone") or scenario.model_copy(update={"crowd": None})
    crowd = scenario.references.get("crowd_alone") or scenario.model_copy(update={"robots": {}})
    (robot,) = scenario.robots.values()
    if (crowd.crowd, crowd.environment) != (scenario.crowd, scenario.environment):
        people = population(crowd, request.registry)  # else the same ones, also near the robot
    nobody = population(alone, request.registry)
    return {
        "robot_alone": _reference(
            request,
            "robot_alone",
            alone,
            nobody,
            {"planner": request.choice.spec_dump, "seed": request.seed},
            lambda setup: record_robot(setup),
        ),
        "crowd_alone": _reference(
            request,
            "crowd_alone",
            crowd,
            people,
            {"realisation": people.agents.hash, "duration": robot.task.time_limit},
            lambda setup: record_crowd(setup, robot.task.time_limit),
        ),
    }


def _reference(
    request: Request,
    name: str,
    scenario: Scenario,
    people: Population,
    depends_on: Mapping[str, Any],
    simulate_it: Callable[[RunSetup], Outcome],
) -> Path:
    """The recording of one reference, computed once for all runs that depend on the same."""
    spec = content_hash(scenario, request.registry.spec_versions(scenario))
    key = {"spec": spec, "versions": provenance.versions(), **depends_on}
    run_id = provenance.digest({"reference": name, **key})
    short = run_id.removeprefix("cb1-sha256:")[:16]
    final = request.out / "references" / f"{name}-{short}"
    failed = (files.read_record(final) or {}).get("status") == PLANNER_FAILED
    if failed or not files.is_complete(final, run_id):
        with _partial(final) as folder:
            outcome = simulate_it(_setup(request, scenario, people, folder, name))
            _check_interrupted(outcome, folder)
            _write_scenario(folder, scenario, request.registry)
            record = {"run_id": run_id, "reference": name, **key, **_ending(outcome)}
            files.write_json(folder / files.RECORD, record)
            files.publish(folder, final)
    return final / files.RECORDING


@contextmanager
def _partial(final: Path) -> Iterator[Path]:
    """A directory aside; a planner that hangs in it is told together with what is left."""
    with files.partial(final) as folder:
        try:
            yield folder
        except PlannerHungError as error:
            raise PlannerHungError(f"{error}; what was recorded: {folder}") from error


# --------------------------------------------------------------------------- the run
def _record_run(
    request: Request,
    identity: Mapping[str, Any],
    people: Population,
    references: Mapping[str, Path],
) -> dict[str, Any]:
    final = request.directory
    with _partial(final) as folder:
        outcome = record_robot(_setup(request, request.scenario, people, folder, "run"))
        _check_interrupted(outcome, folder)
        run = read_trajectories(folder / files.RECORDING)
        calibration = read_references(references)
        scores = score(
            request.registry,
            run,
            calibration.robot_alone,
            calibration.crowd_alone,
            metrics="*" if request.metrics is None else request.metrics,
        )
        record = _run_record(request, identity, references, outcome, run)
        record["agents"] = people.source
        _write_files(request, folder, run, scores, record)
        files.publish(folder, final)
    return record


def _run_record(
    request: Request,
    identity: Mapping[str, Any],
    references: Mapping[str, Path],
    outcome: Outcome,
    run: Trajectories,
) -> dict[str, Any]:
    hashes = {**identity["hashes"], "trajectory": provenance.trajectory_hash(run)}
    up = "/".join([".."] * len(request.directory.relative_to(request.out).parts))
    return {
        "run_id": provenance.digest(identity),
        **identity,
        "hashes": hashes,
        "pinned": request.choice.pinned,
        "recorded": request.record,
        **_ending(outcome),
        "references": {
            n: f"{up}/{p.relative_to(request.out).as_posix()}" for n, p in references.items()
        },
        "machine": provenance.machine(),
    }


def _write_files(
    request: Request, folder: Path, run: Trajectories, scores: Scores, record: Mapping[str, Any]
) -> None:
    scenario = request.scenario
    _write_scenario(folder, scenario, request.registry)
    write_scores_csv(folder / files.SCORES, scores, scenario.id, request.choice.label, request.seed)
    arrival = record["goal_time"]
    write_replay(
        folder / files.REPLAY,
        run,
        read_scans(folder / files.RECORDING, max_rate=_REPLAY_RATE),
        scores,
        title=f"{scenario.id} · {request.choice.label}",
        facts={
            "Suite": request.suite,
            "Scenario": scenario.id,
            "Planner": request.choice.label,
            "Seed": str(request.seed),
            "Status": record["status"],
            "Arrived at": "—" if arrival is None else f"{arrival:.2f} s",
            "Spec": record["hashes"]["spec"][:24],
        },
    )
    files.write_json(folder / files.RECORD, record)


def _setup(
    request: Request, scenario: Scenario, people: Population, folder: Path, stage: str
) -> RunSetup:
    return RunSetup(
        scenario=scenario,
        agents=people.agents,
        registry=request.registry,
        choice=request.choice,
        seed=request.seed,
        recording=folder / files.RECORDING,
        record=request.record if stage == "run" else "none",
        stage=stage.replace("_", " "),
        progress=request.progress,
        stop=request.stop,
        on_hang=request.on_hang,
    )


def _ending(outcome: Outcome) -> dict[str, Any]:
    return {
        "status": outcome.status,
        "reason": outcome.reason,
        "goal_time": outcome.goal_time,
        "sim_time": outcome.sim_time,
        "wall_time": round(outcome.wall_time, 3),
        "cpu_time": round(outcome.cpu_time, 3),
        "real_time_factor": round(outcome.real_time_factor, 2),
        "planner_step_time": outcome.planner_step_time,
        "clamped_commands": outcome.clamped,
    }


def _write_scenario(folder: Path, scenario: Scenario, registry: Registry) -> None:
    text = dump_scenario_yaml(scenario, registry.spec_versions(scenario))
    (folder / files.SCENARIO).write_text(text, encoding="utf-8")


def _check_interrupted(outcome: Outcome, folder: Path) -> None:
    if outcome.status == INTERRUPTED:
        raise Interrupted(f"interrupted at {outcome.sim_time:.2f} s; what was recorded: {folder}")
