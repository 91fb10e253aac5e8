"""What decides what happens in a run, and where it goes. Nothing here simulates or knows Drake."""

from __future__ import annotations

import json
import logging
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

from crowdbot.core.planning.choice import IN_PROCESS, MEMORY
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import provenance
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.record_model import record_problems
from crowdbot.core.runs.run import Recorded, Request
from crowdbot.core.scenarios.lock import Population, population
from crowdbot.core.types.ending import has_failed
from crowdbot.dsl.identity.canonical import content_hash
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError

_LOG = logging.getLogger("crowdbot")

ROBOT_ALONE, CROWD_ALONE = "robot_alone", "crowd_alone"
#: What can be a part of a topic, and of a frame.
_ROS_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
#: How the people of a scenario are found.
Populate = Callable[[Scenario, Registry], Population]


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """A scenario, or one of its calibration runs, with its people.

    Attributes:
        spec, realisation: hashes of its words and of its people.
    """

    scenario: Scenario
    people: Population
    spec: str
    realisation: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Prepared:
    """Everything about a scenario that neither planner nor seed change.

    Attributes:
        run: the scenario.
        alone, crowd: its calibration runs; None where there is nobody to compare with.
    """

    run: Trial
    alone: Trial | None
    crowd: Trial | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Reference:
    """One calibration run.

    Attributes:
        name: ``robot_alone`` or ``crowd_alone``.
        key: all that it depends on; part of its record.
        run_id: hash of name and key.
        directory: where it goes, shared by all runs that depend on the same.
    """

    name: str
    trial: Trial
    key: Mapping[str, Any]
    run_id: str
    directory: Path

    @property
    def finished(self) -> bool:
        """Whether it is complete, perhaps with a planner that failed."""
        return files.is_complete(self.directory, self.run_id)

    @property
    def complete(self) -> bool:
        """Whether it is there and no planner failed in it, which may have a passing cause."""
        record = files.read_record(self.directory) or {}
        return self.finished and not has_failed(str(record.get("status")))


def prepare(
    scenario: Scenario,
    registry: Registry,
    *,
    references: bool = True,
    populate: Populate = population,
) -> Prepared:
    """Find the people of a scenario and of its calibration runs.

    Args:
        scenario: from an expanded suite.
        registry: the installed components.
        references: False leaves the calibration runs out.
        populate: finds people; a caller with many scenarios remembers them.

    Raises:
        InputError: it has no robot, one of several has no name for topics, or its lock does not
            fit it any more.
    """
    if not scenario.robots:
        raise InputError(
            f"scenario '{scenario.id}' has no robot to drive; "
            "`crowdbot docs simulate_a_crowd` shows how to let people walk alone"
        )
    for name in scenario.robots if len(scenario.robots) > 1 else ():
        if not _ROS_NAME.fullmatch(name):
            raise InputError(
                f"{scenario.id}: robot '{name}' needs a name for its topics: letters, digits and "
                "'_', a letter first"
            )

    def trial(of: Scenario, people: Population) -> Trial:
        spec = content_hash(of, registry.spec_versions(of))
        return Trial(scenario=of, people=people, spec=spec, realisation=people.hash)

    run = trial(scenario, populate(scenario, registry))
    if not references or scenario.crowd is None:  # without people a run is its own reference
        return Prepared(run=run, alone=None, crowd=None)
    alone = scenario.references.get(ROBOT_ALONE) or scenario.model_copy(update={"crowd": None})
    crowd = scenario.references.get(CROWD_ALONE) or scenario.model_copy(update={"robots": {}})
    same = (crowd.crowd, crowd.environment) == (scenario.crowd, scenario.environment)
    people = run.people if same else populate(crowd, registry)  # the same, also near the robot
    return Prepared(
        run=run, alone=trial(alone, populate(alone, registry)), crowd=trial(crowd, people)
    )


def run_identity(request: Request, run: Trial) -> dict[str, Any]:
    """Everything that decides what happens in a run; its digest is the run's id."""
    return {
        "scenario": run.scenario.id,
        "suite": request.suite,
        "planner": {
            **request.choice.spec_dump,
            "name": request.choice.name,
            "label": request.choice.label,
        },
        **_budget(request),
        "seed": request.seed,
        "hashes": {"spec": run.spec, "realisation": run.realisation},
        "versions": provenance.versions(),
        "plugins": provenance.plugins(request.registry),
    }


def references_of(request: Request, prepared: Prepared) -> tuple[Reference, ...]:
    """The calibration runs of a run, whether they are there or not."""
    if prepared.alone is None or prepared.crowd is None:
        return ()
    by_planner = {"planner": request.choice.spec_dump, "seed": request.seed, **_budget(request)}
    by_people = {
        "realisation": prepared.crowd.realisation,
        "duration": longest(prepared.run.scenario),
    }
    return (
        _reference(request, ROBOT_ALONE, prepared.alone, by_planner),
        _reference(request, CROWD_ALONE, prepared.crowd, by_people),
    )


def longest(scenario: Scenario) -> float:
    """The longest that a run may last, s."""
    return max(robot.task.time_limit for robot in scenario.robots.values())


def _budget(request: Request) -> dict[str, float | None]:
    """What a planner may take, where that is not the usual."""
    found: dict[str, float | None] = {}
    if request.step_budget is not None:
        found["step_budget"] = request.step_budget
    if not request.choice.in_process and request.choice.memory != MEMORY:
        found["planner_memory"] = request.choice.memory
    return found


def _reference(
    request: Request, name: str, trial: Trial, depends_on: Mapping[str, Any]
) -> Reference:
    others = provenance.third_parties(request.registry)
    key = {"spec": trial.spec, "versions": provenance.versions(), **others, **depends_on}
    run_id = provenance.digest({"reference": name, **key})
    short = run_id.removeprefix("cb1-sha256:")[:16]
    directory = request.out / "references" / f"{name}-{short}"
    return Reference(name=name, trial=trial, key=key, run_id=run_id, directory=directory)


def reusable_record(request: Request, run_id: str, *, compared: bool) -> dict[str, Any] | None:
    """The record of the run if it is complete and holds as much as is wanted now.

    Args:
        request: what is wanted.
        run_id: from `run_identity`.
        compared: whether it must have calibration runs.
    """
    record = files.read_record(request.directory)
    if record is None or record.get("run_id") != run_id:
        if record is None and request.directory.is_dir():
            _LOG.warning("%s: run.json is missing or cut; it is made again", request.directory)
        return None
    if wrong := files.damage(request.directory, record) or next(iter(record_problems(record)), ""):
        _LOG.warning("%s: %s; it is made again", request.directory, wrong)
        return None
    if record.get("planner_process", IN_PROCESS) != request.choice.process:
        return None
    if not _holds(record, request) or (compared and not record.get("references")):
        return None
    if request.replay and not (request.directory / files.REPLAY).exists():
        return None
    return record


def _holds(record: Mapping[str, Any], request: Request) -> bool:
    """Whether as much was recorded as is wanted, or more."""
    levels = get_args(Recorded)
    return record.get("recorded") in levels[: levels.index(request.record) + 1]


def recorded_otherwise(request: Request, identity: Mapping[str, Any]) -> tuple[str, ...]:
    """In what the run that is there now differs from the one that is wanted, by dotted keys.

    Empty where none is there, or the very same.
    """
    before = files.read_record(request.directory)
    if before is None:
        return ()
    keys = (*identity, *(k for k in ("step_budget",) if k in before and k not in identity))
    wanted = json.loads(json.dumps({**identity, "recorded": request.record}))
    found = []
    for key in (*keys, "recorded"):
        a, b = _flat(key, before.get(key)), _flat(key, wanted.get(key))
        if key == "hashes":
            a.pop("hashes.trajectory", None)
        found += sorted(name for name in a.keys() | b.keys() if a.get(name) != b.get(name))
    return tuple(found)


def _flat(name: str, value: Any) -> dict[str, Any]:
    """A document as dotted key -> value; lists are values, as JSON says them."""
    if isinstance(value, Mapping):
        return {k: v for key in value for k, v in _flat(f"{name}.{key}", value[key]).items()}
    return {name: list(value) if isinstance(value, (list, tuple)) else value}
