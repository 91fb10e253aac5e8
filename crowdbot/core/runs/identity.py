"""The identity of a run and its directory, without simulation or Drake."""

from __future__ import annotations

import logging
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

from crowdbot.core.planning.choice import MEMORY
from crowdbot.core.planning.resolve import PlannerChoice
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import provenance
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.record_parts import IdentityHashes, PlannerPart, PluginPart
from crowdbot.core.runs.run import Request
from crowdbot.core.runs.run_options import PEOPLE_ALONE, Recorded
from crowdbot.core.runs.run_record import (
    ReferenceIdentity,
    ReferenceRecord,
    RunIdentity,
    RunRecord,
)
from crowdbot.core.scenarios.lock import Population, population
from crowdbot.core.types.ending import has_failed
from crowdbot.dsl.identity.canonical import content_hash
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError

_LOG = logging.getLogger("crowdbot")

ROBOT_ALONE, CROWD_ALONE = "robot_alone", "crowd_alone"
#: Allowed names in topics and frames.
_ROS_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
#: Function that finds the people of a scenario.
Populate = Callable[[Scenario, Registry], Population]


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """A scenario, or one of its calibration runs, with its people.

    Attributes:
        spec, realisation: hashes of the scenario and of its people.
    """

    scenario: Scenario
    people: Population
    spec: str
    realisation: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Prepared:
    """The parts of a run that do not depend on planner and seed.

    Attributes:
        run: the scenario.
        alone, crowd: its calibration runs; None if there is nothing to compare.
    """

    run: Trial
    alone: Trial | None
    crowd: Trial | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Reference:
    """A calibration run that a run is compared with: robot or crowd alone.

    Attributes:
        name: ``robot_alone`` or ``crowd_alone``.
        identity: all that it depends on; part of its record.
        directory: where it goes, shared by all runs that depend on the same.
    """

    name: str
    trial: Trial
    identity: ReferenceIdentity
    directory: Path

    @property
    def run_id(self) -> str:
        """Return the id of the calibration run."""
        return self.identity.id()

    @property
    def finished(self) -> ReferenceRecord | None:
        """Return the record if the run is complete, even if the planner failed; else None."""
        record = ReferenceRecord.find(self.directory)
        if record is None or record.run_id != self.run_id:
            return None
        document = record.document()
        wrong = files.damage(self.directory, document, scores=False, recording=True)
        return None if wrong else record

    @property
    def complete(self) -> ReferenceRecord | None:
        """Return the record if the run is complete and its planner did not fail; else None.

        A failure may have a temporary cause.
        """
        record = self.finished
        return None if record is None or has_failed(record.status) else record


def prepare(
    scenario: Scenario,
    registry: Registry,
    *,
    references: bool = True,
    populate: Populate = population,
    people_alone: bool = False,
) -> Prepared:
    """Find the people of a scenario and of its calibration runs.

    Args:
        scenario: from an expanded suite.
        registry: the installed components.
        references: False omits the calibration runs.
        populate: function that finds people; a caller with many scenarios can cache them.
        people_alone: True if a scenario without a robot is fine.

    Raises:
        InputError: it has no robot, one of several has no name for topics, or its lock is out of
            date.
    """
    if not scenario.robots and scenario.crowd is None:
        raise InputError(f"scenario '{scenario.id}' has neither a robot nor people")
    if not scenario.robots and not people_alone:
        raise InputError(
            f"scenario '{scenario.id}' has no robot to drive; "
            "`crowdbot simulate` lets its people walk alone"
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
    compared = references and bool(scenario.robots)
    if not compared or scenario.crowd is None:  # without people a run is its own reference
        return Prepared(run=run, alone=None, crowd=None)
    about_people = any(robot.task.person for robot in scenario.robots.values())
    alone = scenario.references.get(ROBOT_ALONE) or scenario.model_copy(update={"crowd": None})
    crowd = scenario.references.get(CROWD_ALONE) or scenario.model_copy(update={"robots": {}})
    same = (crowd.crowd, crowd.environment) == (scenario.crowd, scenario.environment)
    people = run.people if same else populate(crowd, registry)  # equal, also near the robot
    return Prepared(
        run=run,
        alone=None if about_people else trial(alone, populate(alone, registry)),
        crowd=trial(crowd, people),
    )


def run_identity(request: Request, run: Trial) -> RunIdentity:
    """Return everything that determines the course of a run."""
    return RunIdentity(
        scenario=run.scenario.id,
        suite=request.entry.suite,
        planner=planner_part(request.choice),
        **_budget(request),
        seed=request.seed,
        hashes=IdentityHashes(spec=run.spec, realisation=run.realisation),
        versions=provenance.versions(),
        plugins=[PluginPart(**plugin) for plugin in provenance.plugins(request.registry)],
    )


def planner_part(choice: PlannerChoice) -> PlannerPart:
    """Return the planner's entry in a record."""
    return PlannerPart(**{**choice.spec_dump, "name": choice.name, "label": choice.label})


def references_of(request: Request, prepared: Prepared) -> tuple[Reference, ...]:
    """Return the calibration runs of a run, existing or not."""
    found = []
    if prepared.alone is not None:
        by_planner = {"planner": request.choice.spec_dump, "seed": request.seed, **_budget(request)}
        found.append(_reference(request, ROBOT_ALONE, prepared.alone, by_planner))
    if prepared.crowd is not None:
        by_people = {
            "realisation": prepared.crowd.realisation,
            "duration": longest(prepared.run.scenario),
        }
        found.append(_reference(request, CROWD_ALONE, prepared.crowd, by_people))
    return tuple(found)


def longest(scenario: Scenario) -> float:
    """Return the longest possible duration of a run, s."""
    return max(robot.task.time_limit for robot in scenario.robots.values())


def _budget(request: Request) -> dict[str, Any]:
    """Return the planner's limits that differ from the defaults."""
    found: dict[str, Any] = {}
    if request.options.step_budget is not None:
        found["step_budget"] = request.options.step_budget
    if not request.choice.in_process and request.choice.memory != MEMORY:
        found["planner_memory"] = request.choice.memory
    if request.options.replace_draws and request.scenario.crowd is not None:
        found["replace_draws"] = request.options.replace_draws
    if not request.scenario.robots:
        found["duration"] = request.options.duration or PEOPLE_ALONE
    return found


def _reference(
    request: Request, name: str, trial: Trial, depends_on: Mapping[str, Any]
) -> Reference:
    others = provenance.third_parties(request.registry)
    identity = ReferenceIdentity.model_validate(
        {
            "reference": name,
            "spec": trial.spec,
            "versions": provenance.versions(),
            **others,
            **depends_on,
        }
    )
    short = identity.id().removeprefix("cb1-sha256:")[:16]
    directory = request.out / "references" / f"{name}-{short}"
    return Reference(name=name, trial=trial, identity=identity, directory=directory)


def reusable_record(request: Request, run_id: str, *, compared: bool) -> RunRecord | None:
    """Return the run's record if it is complete and holds all that is requested now, else None.

    Args:
        request: what is wanted.
        run_id: of the run that is wanted.
        compared: True if it must have calibration runs.
    """
    place = request.directory
    if not place.is_dir():
        return None
    try:
        document = files.checked_record(place)
    except InputError:
        _LOG.warning("%s: run.json is missing or cut; it is made again", place)
        return None
    if document.get("run_id") != run_id:
        return None
    try:
        record = RunRecord.parse(document, files.RECORD)
        files.check_whole(place, document)
    except InputError as error:
        _LOG.warning("%s: %s; it is made again", place, error)
        return None
    if record.planner_process != request.choice.process:
        return None
    if not _holds(record, request) or (compared and not record.references):
        return None
    if request.options.replay and not (place / files.REPLAY).exists():
        return None
    return record


def _holds(record: RunRecord, request: Request) -> bool:
    """Return True if a run recorded at least as much as is requested."""
    levels = get_args(Recorded)
    return record.recorded in levels[: levels.index(request.options.record) + 1]


def recorded_otherwise(request: Request, identity: RunIdentity) -> tuple[str, ...]:
    """Return the differences between the existing run and the requested one, as dotted keys.

    Empty if there is no run, or an equal one.
    """
    before = RunRecord.find(request.directory)
    if before is None:
        return ()
    there, expected = before.identity(), identity.identity()
    found = []
    for key in dict.fromkeys([*expected, *there]):
        a, b = _flat(key, there.get(key)), _flat(key, expected.get(key))
        found += sorted(name for name in a.keys() | b.keys() if a.get(name) != b.get(name))
    return (*found, *["recorded"] * (before.recorded != request.options.record))


def _flat(name: str, value: Any) -> dict[str, Any]:
    """Return a document as dotted key -> value; lists count as JSON values."""
    if isinstance(value, Mapping):
        return {k: v for key in value for k, v in _flat(f"{name}.{key}", value[key]).items()}
    return {name: list(value) if isinstance(value, (list, tuple)) else value}
