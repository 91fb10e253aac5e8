"""run.json: what a run says about itself."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import provenance
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.runs.read_and_score import trajectory_of
from crowdbot.core.runs.realised_density import mean_density
from crowdbot.core.runs.run import Request
from crowdbot.core.scoring.evaluate import Scores
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.trajectories.worst_moment import worst_moment
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.identity.canonical import dump_scenario_yaml
from crowdbot.dsl.identity.crowd_likeness import fingerprint
from crowdbot.dsl.scenario.robot_response import RobotResponse
from crowdbot.dsl.scenario.scenario import Scenario


def run_record(
    request: Request,
    identity: Mapping[str, Any],
    references: Mapping[str, Path],
    outcome: Outcome,
    runs: Mapping[str, Trajectories],
    scores: Scores,
    *,
    parts: EnvironmentParts,
) -> dict[str, Any]:
    """The record of a run of one robot or of several, but for how its people were found."""
    scenario, registry = request.scenario, request.registry
    run = max(runs.values(), key=lambda one: len(one.t))  # sees the people to the end
    hashes = {**identity["hashes"], "trajectory": trajectory_of(runs)}
    up = "/".join([".."] * len(request.directory.relative_to(request.out).parts))
    return {
        "run_id": provenance.digest(identity),
        **identity,
        "axes": dict(request.axes),
        "axis_words": {axis: list(words) for axis, words in request.words.items()},
        "position": request.position,
        "hashes": hashes,
        "pinned": request.pinned,
        "privileged": request.choice.privileged,
        "role": request.choice.role,
        "planner_process": request.choice.process,
        "allowed_plugins": request.registry.allowed,
        "recorded": request.record,
        **ending(outcome),
        **_robots(request, outcome, runs),
        "references": {
            n: f"{up}/{p.relative_to(request.out).as_posix()}" for n, p in references.items()
        },
        "density": mean_density(run, scenario, parts),
        "conditions": _conditions(scenario, runs),
        "crowd": "" if scenario.crowd is None else fingerprint(scenario.crowd),
        "metrics": _metrics(registry, scores),
        "suite_metrics": _named(request.metrics, scores),
        "worst_moment": _worst(runs.values()),
        "machine": provenance.machine(),
    }


def _robots(request: Request, outcome: Outcome, runs: Mapping[str, Trajectories]) -> dict[str, Any]:
    """What became of each of several robots; nothing of one."""
    if not outcome.robots:
        return {}
    kept = (
        "status", "reason", "goal_time", "toppled_time", "sim_time", "planner_step_time",
        "clamped_commands",
    )  # fmt: skip
    found = {}
    for name, one in outcome.robots.items():
        choice, end = request.choice.of(name), ending(one)
        found[name] = {
            "planner": {**choice.spec_dump, "name": choice.name, "label": choice.label},
            **{key: end[key] for key in kept if key in end},
            "trajectory": provenance.trajectory_hash(runs[name]),
        }
    return {"robots": found}


def ending(outcome: Outcome) -> dict[str, Any]:
    """How a run ended, and what it took; ``toppled_time`` only of a robot that toppled."""
    fallen = {} if outcome.toppled_time is None else {"toppled_time": outcome.toppled_time}
    return {
        "status": outcome.status,
        "reason": outcome.reason,
        "goal_time": outcome.goal_time,
        **fallen,
        "sim_time": outcome.sim_time,
        "wall_time": round(outcome.wall_time, 3),
        "cpu_time": round(outcome.cpu_time, 3),
        "real_time_factor": round(outcome.real_time_factor, 2),
        "planner_step_time": outcome.planner_step_time,
        "clamped_commands": outcome.clamped,
    }


def write_scenario(folder: Path, scenario: Scenario, registry: Registry) -> None:
    """Write the scenario with every default."""
    text = dump_scenario_yaml(scenario, registry.spec_versions(scenario))
    (folder / files.SCENARIO).write_text(text, encoding="utf-8")


def _conditions(scenario: Scenario, runs: Mapping[str, Trajectories]) -> dict[str, str]:
    """What of a scenario must be equal in runs that are compared, whatever their axes are."""
    found = {f"rates.{name}": f"{rate:g} Hz" for name, rate in scenario.rates}
    radii = [run.robot.radius for run in runs.values() if run.robot is not None]
    if scenario.crowd is not None and radii:
        response = scenario.crowd.robot_response
        perceived = dict.fromkeys(f"{radius + response.margin:.10g} m" for radius in radii)
        found["perceived_radius"] = ", ".join(perceived)
        share = f" {response.ignoring:g}" if response.ignoring_fraction is not None else ""
        words = _own_words(response), f"{response.reaction}{share}", f"velocity {response.velocity}"
        found["people_and_robot"] = ", ".join(words)
    return found


def _own_words(response: RobotResponse) -> str:
    """The kind of a response, and what of it is not as usual."""
    told = {"kind", "reaction", "ignoring_fraction", "velocity", "margin"}  # elsewhere
    fields = {n: f for n, f in type(response).model_fields.items() if n not in told}
    given = {n: getattr(response, n) for n, f in fields.items()}
    changed = [f"{n} {value:g}" for n, value in given.items() if value != fields[n].default]
    return ", ".join([response.kind, *changed])


def _worst(runs: Iterable[Trajectories]) -> dict[str, Any] | None:
    """When the run is worst, to the millisecond and millimetre."""
    moments = [found for found in map(worst_moment, runs) if found is not None]
    if not moments:
        return None
    found = min(moments, key=lambda m: math.inf if m.clearance is None else m.clearance)
    clearance = None if found.clearance is None else round(found.clearance, 3)
    return {"t": round(found.t, 3), "what": found.what, "clearance": clearance}


def _named(patterns: Sequence[str] | None, scores: Scores) -> list[str]:
    """Metrics that the suite names, in its order; none where it leaves that open."""
    known = dict.fromkeys(s.metric for s in scores)
    chosen = [m for p in patterns or () if p != "*" for m in known if fnmatchcase(m, p)]
    return list(dict.fromkeys(chosen))


def _metrics(registry: Registry, scores: Scores) -> dict[str, Any]:
    """Metric -> version of its words, and the parameters it was computed with."""
    known = registry.components("metric")
    return {
        s.metric: {"spec_version": known[s.metric].spec_version, **s.parameters} for s in scores
    }
