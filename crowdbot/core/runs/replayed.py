"""The replay page's data of a run, from the simulation or from its directory."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.recording.reading.images import (
    REPLAY_IMAGE_RATE,
    REPLAY_IMAGE_WIDTH,
    ImageCollector,
    ReplayImages,
)
from crowdbot.core.recording.reading.scans import REPLAY_RATE
from crowdbot.core.registry.registry import Registry
from crowdbot.core.replay.other_track import OtherTrack
from crowdbot.core.replay.shown_run import Scenery, ShownRun
from crowdbot.core.robots.build import build_robot
from crowdbot.core.robots.look import seen_from_above
from crowdbot.core.runs import provenance
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.read_and_score import SeenRun, read_robots
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.runs.scenario_words import scenario_words
from crowdbot.core.runs.solids import solid_people, solids_of
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.scenarios.lock import population
from crowdbot.core.scoring.scores_csv import read_scores_csv
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.robot import RobotModel
from crowdbot.core.types.score import Score
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError, UsageError


def replay_facts(record: RunRecord) -> dict[str, str]:
    """Return the facts about a run that the page shows, name -> text."""
    arrival = record.goal_time
    return {
        "Suite": record.suite,
        "Scenario": record.scenario,
        "Planner": record.planner.label,
        **provenance.remarks(record),
        "Seed": str(record.seed),
        "Status": record.status,
        "Arrived at": "—" if arrival is None else f"{arrival:.2f} s",
        "Spec": record.hashes.spec[:24],
    }


def scenery(parts: EnvironmentParts, height: float) -> Scenery:
    """Return the obstacles for a robot of some height, m, and for people."""
    low = (parts.wall_heights[:, 0] < height) & ~parts.sides()
    stops = parts.solids_stop_crowd.tolist()
    solids = [
        (outline, crowd)
        for outline, (bottom, _), crowd in zip(
            parts.solids, parts.solid_heights.tolist(), stops, strict=True
        )
        if bottom < height
    ]
    return Scenery(
        walls=parts.walls[low],
        stops_robot=parts.stops_robot[low],
        stops_crowd=parts.stops_crowd[low],
        pillars=parts.pillars[parts.pillar_heights[:, 0] < height],
        blocks=tuple(outline for outline, crowd in solids if crowd),
        steps=tuple(outline for outline, crowd in solids if not crowd),
    )


def images_of_replay(recording: Path) -> ImageCollector:
    """Collect camera images for the page."""
    return ImageCollector(recording, REPLAY_IMAGE_RATE, REPLAY_IMAGE_WIDTH)


def replayed_runs(folders: Sequence[Path], registry: Registry) -> list[ShownRun]:
    """Return runs of one scenario, from their directories.

    Args:
        folders: run directories.
        registry: the installed components; they must include those of the scenario.

    Raises:
        InputError: a run is incomplete, or its scenario cannot be built.
        UsageError: the runs have different scenarios.
    """
    records = [_record(folder) for folder in folders]
    first = records[0]
    for folder, record in zip(folders, records, strict=True):
        if record.scenario != first.scenario:
            raise UsageError(
                f"{folder} is a run of {record.scenario}, {folders[0]} of {first.scenario}: "
                "only runs of one scenario can be shown beside each other"
            )
    labels = _labels(records)
    return [
        _replayed(folder, record, label, registry)
        for folder, record, label in zip(folders, records, labels, strict=True)
    ]


def _record(folder: Path) -> RunRecord:
    if not (folder / files.RECORD).is_file():
        raise InputError(f"{folder}: no run directory, there is no readable {files.RECORD} in it")
    record = RunRecord.read(folder)
    if damaged := files.damage(folder, record.document(), recording=True):
        raise InputError(f"{folder}: {damaged}")
    return record


def _labels(records: Sequence[RunRecord]) -> list[str]:
    """Return labels by planner; with the seed for several runs of a planner."""
    planners = [record.planner.label for record in records]
    return [
        planner if planners.count(planner) == 1 else f"{planner}, seed {record.seed}"
        for planner, record in zip(planners, records, strict=True)
    ]


def shown_run(
    scenario: Scenario,
    seen: Mapping[str, SeenRun],
    models: Mapping[str, RobotModel],
    parts: EnvironmentParts,
    record: RunRecord,
    scores: Sequence[Score],
    images: Sequence[ReplayImages],
    people: Realisation,
) -> ShownRun:
    """Return the page's data of a run with one or several robots.

    Args:
        scenario: the scenario of the run.
        seen, models: of each robot by name, in the scenario's order.
        scores: of the run.
        images: camera images.
        people: the agents.
    """
    # People are shown until the last robot has ended.
    last = max(seen, key=lambda name: len(seen[name].run.t))
    several = {} if len(seen) == 1 else {"Robot": last}
    looks = {
        name: [(part.outline, part.colour) for part in seen_from_above(model)]
        for name, model in models.items()
    }
    return ShownRun(
        run=seen[last].run,
        title=f"{scenario.id} · {record.planner.label}",
        label=record.planner.label,
        facts={**several, **replay_facts(record)},
        words=scenario_words(record, scenario),
        scans=seen[last].scans,
        images=images,
        drawings=seen[last].drawings,
        scores=scores,
        look=looks.get(last, ()),
        robot=last,
        others=[
            OtherTrack(
                name=name,
                run=one.run,
                look=looks[name],
                leaves=scenario.robots[name].task.when_ended == "leave",
            )
            for name, one in seen.items()
            if name != last
        ],
        scenery=scenery(parts, _height(scenario, models)),
        solids=solids_of(
            parts,
            {name: (models[name], seen[name].sensors) for name in _last_first(last, models)},
            solid_people(scenario, people),
        ),
    )


def _last_first(last: str, names: Iterable[str]) -> list[str]:
    """Return the robots' names in the order of the page: ``last`` comes first."""
    found = list(names)
    return [last, *(n for n in found if n != last)] if last in found else found


def _height(scenario: Scenario, models: Mapping[str, RobotModel]) -> float:
    """Return the height of the highest robot; without one, of people, m."""
    if not models:
        return 0.0 if scenario.crowd is None else scenario.crowd.body.height
    return max(model.height for model in models.values())


def _replayed(folder: Path, record: RunRecord, label: str, registry: Registry) -> ShownRun:
    scenario, recording = _scenario(folder, registry), folder / files.RECORDING
    images = images_of_replay(recording)
    shown = shown_run(
        scenario,
        read_robots(recording, tuple(scenario.robots) or ("",), REPLAY_RATE, images),
        {name: build_robot(registry, robot) for name, robot in scenario.robots.items()},
        build_environment(registry, scenario.environment),
        record,
        [row.score for row in read_scores_csv(folder / files.SCORES)],
        images.images(),
        population(scenario, registry).agents,
    )
    return replace(shown, label=label)


def _scenario(folder: Path, registry: Registry) -> Scenario:
    return pick(open_spec(str(folder / files.SCENARIO), registry), None)
