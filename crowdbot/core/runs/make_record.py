"""Makes the record of a run from its request and its outcome."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from crowdbot.core.planning.choice import PlannerChoice
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import provenance
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.identity import planner_part
from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.runs.read_and_score import reference_hashes, trajectory_of
from crowdbot.core.runs.realised_density import mean_density
from crowdbot.core.runs.record_parts import (
    HashesPart,
    MetricPart,
    MomentPart,
    RobotPart,
)
from crowdbot.core.runs.run import Request
from crowdbot.core.runs.run_record import RunIdentity, RunRecord
from crowdbot.core.scenarios.lock import Population
from crowdbot.core.scoring.evaluate import Scores
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.trajectories.worst_moment import worst_moment
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.identity.canonical import dump_scenario_yaml
from crowdbot.dsl.identity.crowd_likeness import fingerprint
from crowdbot.dsl.scenario.robot_response import RobotResponse
from crowdbot.dsl.scenario.scenario import Scenario


def make_record(
    request: Request,
    identity: RunIdentity,
    people: Population,
    references: Mapping[str, Path],
    outcome: Outcome,
    runs: Mapping[str, Trajectories],
    scores: Scores,
    *,
    parts: EnvironmentParts,
) -> RunRecord:
    """Return the record of a run with one robot or several, without the sizes of its files."""
    scenario, registry = request.scenario, request.registry
    run = max(runs.values(), key=lambda one: len(one.t))  # sees the people to the end
    hashes = HashesPart(
        spec=identity.hashes.spec,
        realisation=identity.hashes.realisation,
        trajectory=trajectory_of(runs),
    )
    up = "/".join([".."] * len(request.directory.relative_to(request.out).parts))
    decided = {name: getattr(identity, name) for name in identity.model_fields_set}
    return RunRecord(
        run_id=identity.id(),
        **{**decided, "hashes": hashes},
        axes=dict(request.entry.axes),
        axis_words={axis: list(words) for axis, words in request.entry.words.items()},
        position=request.entry.position,
        altered=list(request.entry.altered),
        pinned=request.pinned,
        privileged=request.choice.privileged,
        role=request.choice.role,
        planner_process=request.choice.process,
        **_containment(request.choice),
        allowed_plugins=None if registry.allowed is None else list(registry.allowed),
        recorded=request.options.record,
        **ending(outcome),
        **_robots(request, outcome, runs),
        references={
            n: f"{up}/{p.relative_to(request.out).as_posix()}" for n, p in references.items()
        },
        reference_hashes=reference_hashes(references),
        density=mean_density(run, scenario, parts),
        conditions=_conditions(scenario, runs),
        crowd="" if scenario.crowd is None else fingerprint(scenario.crowd),
        metrics=_metrics(registry, scores),
        suite_metrics=_named(request.options.metrics, scores),
        worst_moment=_worst(runs.values()),
        machine=provenance.machine(),
        agents=people.source,
    )


def _containment(choice: PlannerChoice) -> dict[str, Any]:
    return {} if choice.contained is None else {"planner_contained": choice.contained}


def _robots(request: Request, outcome: Outcome, runs: Mapping[str, Trajectories]) -> dict[str, Any]:
    """Return the ending of each of several robots; empty for a single robot."""
    if not outcome.robots:
        return {}
    found = {}
    for name, one in outcome.robots.items():
        choice = request.choice.of(name)
        found[name] = RobotPart(
            planner=planner_part(choice),
            **_ended(one),
            trajectory=provenance.trajectory_hash(runs[name]),
        )
    return {"robots": found}


def ending(outcome: Outcome) -> dict[str, Any]:
    """Return the ending of a run and the computing time it took."""
    return {
        **_ended(outcome),
        "wall_time": round(outcome.wall_time, 3),
        "cpu_time": round(outcome.cpu_time, 3),
        "real_time_factor": round(outcome.real_time_factor, 2),
    }


def _ended(outcome: Outcome) -> dict[str, Any]:
    """Return the ending of a run or robot; ``toppled_time`` only if the robot toppled."""
    fallen = {} if outcome.toppled_time is None else {"toppled_time": outcome.toppled_time}
    return {
        "status": outcome.status,
        "reason": outcome.reason,
        "goal_time": outcome.goal_time,
        **fallen,
        "sim_time": outcome.sim_time,
        "planner_step_time": dict(outcome.planner_step_time),
        "clamped_commands": outcome.clamped,
    }


def write_scenario(folder: Path, scenario: Scenario, registry: Registry) -> None:
    """Write the scenario with all defaults."""
    text = dump_scenario_yaml(scenario, registry.spec_versions(scenario))
    (folder / files.SCENARIO).write_text(text, encoding="utf-8")


def _conditions(scenario: Scenario, runs: Mapping[str, Trajectories]) -> dict[str, str]:
    """Return conditions that must be equal in compared runs, regardless of their axes."""
    conditions = {f"rates.{name}": f"{rate:g} Hz" for name, rate in scenario.rates}
    radii = [run.robot.radius for run in runs.values() if run.robot is not None]
    if scenario.crowd is not None and radii:
        response = scenario.crowd.robot_response
        perceived = dict.fromkeys(f"{radius + response.margin:.10g} m" for radius in radii)
        conditions["perceived_radius"] = ", ".join(perceived)
        share = f" {response.ignoring:g}" if response.ignoring_fraction is not None else ""
        words = _own_words(response), f"{response.reaction}{share}", f"velocity {response.velocity}"
        conditions["people_and_robot"] = ", ".join(words)
    return conditions


def _own_words(response: RobotResponse) -> str:
    """Return the kind of a response, and its values that are not default."""
    elsewhere = {"kind", "reaction", "ignoring_fraction", "velocity", "margin"}  # elsewhere
    fields = {n: f for n, f in type(response).model_fields.items() if n not in elsewhere}
    given = {n: getattr(response, n) for n, f in fields.items()}
    changed = [f"{n} {value:g}" for n, value in given.items() if value != fields[n].default]
    return ", ".join([response.kind, *changed])


def _worst(runs: Iterable[Trajectories]) -> MomentPart | None:
    """Return the moment at which the run is worst, to the millisecond and millimetre."""
    moments = [found for found in map(worst_moment, runs) if found is not None]
    if not moments:
        return None
    found = min(moments, key=lambda m: math.inf if m.clearance is None else m.clearance)
    clearance = None if found.clearance is None else round(found.clearance, 3)
    return MomentPart(t=round(found.t, 3), what=found.what, clearance=clearance)


def _named(patterns: Sequence[str] | None, scores: Scores) -> list[str]:
    """Return metrics that the suite names, in its order; empty if it names none."""
    known = dict.fromkeys(s.metric for s in scores)
    chosen = [m for p in patterns or () if p != "*" for m in known if fnmatchcase(m, p)]
    return list(dict.fromkeys(chosen))


def _metrics(registry: Registry, scores: Scores) -> dict[str, MetricPart]:
    """Return metric -> version, and the parameters of the score."""
    known = registry.components("metric")
    return {
        s.metric: MetricPart(spec_version=known[s.metric].spec_version, **s.parameters)
        for s in scores
    }
