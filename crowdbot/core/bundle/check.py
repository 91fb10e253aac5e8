"""What can be told about a bundle without simulating anything."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from crowdbot.core.bundle.archive import Archive
from crowdbot.core.bundle.manifest import LOCK, BundledRun
from crowdbot.core.bundle.pack import is_privileged, read_json
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import provenance
from crowdbot.core.runs import run_directory as files
from crowdbot.core.scenarios.lock_check import spec_of
from crowdbot.core.scoring.scores_csv import parse_scores
from crowdbot.core.types.score import Score
from crowdbot.dsl.canonical import dump_scenario_yaml
from crowdbot.dsl.expand import Expansion
from crowdbot.dsl.scenario import Scenario
from crowdbot.errors import InputError

#: Keys of run.json that the run's id is the hash of; ``hashes`` without the trajectory.
_IDENTITY = ("scenario", "suite", "planner", "seed", "hashes", "versions", "plugins")


@dataclass(frozen=True, slots=True, kw_only=True)
class ClaimedRun:
    """One run as the bundle has it."""

    entry: BundledRun
    record: dict[str, Any] = field(repr=False)
    scores: tuple[Score, ...] = field(repr=False)

    @property
    def name(self) -> str:
        """For people."""
        return f"{self.entry.scenario} seed-{self.entry.seed}"


def check_members(archive: Archive) -> Iterator[str]:
    """Problems of the archive as such: members that are missing, more, or other than listed."""
    listed, there = set(archive.manifest.members), archive.names
    yield from (f"{name} is missing" for name in sorted(listed - there))
    yield from (f"{name} is not in the manifest" for name in sorted(there - listed))
    for name in sorted(listed & there):
        try:
            archive.check(name)
        except InputError as error:
            yield _without(archive, error)


def claimed_runs(archive: Archive) -> tuple[list[ClaimedRun], list[str]]:
    """All runs that can be read, and what is wrong with the others."""
    found, problems = [], []
    for entry in archive.manifest.runs:
        try:
            run = _claimed(archive, entry)
        except InputError as error:
            problems.append(_without(archive, error))
            continue
        found.append(run)
        problems += [f"{entry.directory}: {text}" for text in _run_problems(archive, run)]
    return found, problems


def check_suite(archive: Archive, expansion: Expansion, registry: Registry) -> Iterator[str]:
    """Where a bundle's scenarios are not those that are installed here, or not all of them."""
    known = {s.id: s for s in expansion.scenarios}
    manifest = archive.manifest
    there = {(r.scenario, r.seed) for r in manifest.runs}
    if len(there) != len(manifest.runs):
        yield "a run is listed twice"
    if not manifest.runs:
        yield "there is no run in it"
    lock = manifest.members.get(LOCK)
    if manifest.edition.lock != (lock.sha256 if lock else ""):
        yield f"the edition is not that of {LOCK}"
    for seed in manifest.seeds:
        lacking = [i for i in known if (i, seed) not in there]
        lacking = [i for i in lacking if f"{i} seed-{seed}" not in manifest.missing]
        if lacking:
            yield f"{len(lacking)} scenarios are missing that the manifest says are there: " \
                  f"{', '.join(lacking[:3])}"  # fmt: skip
    for run in manifest.runs:
        if run.scenario not in known:
            yield f"{run.scenario} is not a scenario of {expansion.suite_id}"
            continue
        yield from _scenario_problems(archive, run, known[run.scenario], registry)


def _claimed(archive: Archive, entry: BundledRun) -> ClaimedRun:
    name = f"{entry.directory}/{files.RECORD}"
    record = read_json(archive.text(name), name)
    table = f"{entry.directory}/{files.SCORES}"
    rows = parse_scores(archive.text(table), table)
    for row in rows:
        if (row.scenario, row.seed) != (entry.scenario, entry.seed):
            raise InputError(f"{table}: a score of another run: {row.scenario} seed {row.seed}")
    return ClaimedRun(entry=entry, record=record, scores=tuple(r.score for r in rows))


def _run_problems(archive: Archive, run: ClaimedRun) -> Iterator[str]:
    """Where record, manifest and hashes contradict each other."""
    record, entry, manifest = run.record, run.entry, archive.manifest
    hashes = record.get("hashes")
    hashes = hashes if isinstance(hashes, dict) else {}
    identity = {k: record.get(k) for k in _IDENTITY}
    identity["hashes"] = {k: v for k, v in hashes.items() if k != "trajectory"}
    if not record.get("run_id") == provenance.digest(identity) == entry.run_id:
        yield f"its run_id is not the hash of what {files.RECORD} says"
    if hashes.get("trajectory") != entry.trajectory:
        yield f"the trajectory's hash in {files.RECORD} is not that of the manifest"
    if (record.get("scenario"), record.get("seed")) != (entry.scenario, entry.seed):
        yield "its record is of another scenario or seed"
    if record.get("planner") != manifest.planner:
        yield "its planner is not that of the manifest"
    if record.get("versions") != manifest.versions:
        yield "its versions are not those of the manifest"
    if is_privileged(record) != (manifest.classed == "privileged"):
        yield f"the manifest says '{manifest.classed}', the run does not"
    yield from _ending_problems(run)


def _ending_problems(run: ClaimedRun) -> Iterator[str]:
    """Where status, time of arrival and success contradict each other."""
    arrived = run.record.get("goal_time") is not None
    if (run.record.get("status") == "arrived") > arrived:
        yield "its status is 'arrived', but it has no time of arrival"
    for score in run.scores:
        if (score.metric, score.status) == ("success", "ok") and score.value != arrived:
            yield f"its success is {score.value:g}, which its time of arrival contradicts"


def _scenario_problems(
    archive: Archive, run: BundledRun, scenario: Scenario, registry: Registry
) -> Iterator[str]:
    name = f"{run.directory}/{files.SCENARIO}"
    try:
        record = read_json(archive.text(f"{run.directory}/{files.RECORD}"), run.directory)
        text = archive.text(name)
    except InputError:
        return  # told already
    hashes = record.get("hashes")
    hashes = hashes if isinstance(hashes, dict) else {}
    locked = scenario.locked.files.lock.scenarios.get(run.scenario) if scenario.locked else None
    if locked is not None and hashes.get("realisation") != locked.realisation:
        yield f"{run.scenario}: its people are not those of the lock that is installed here"
    if hashes.get("spec") != spec_of(scenario, registry):
        yield f"{run.scenario}: its hash is not that of the scenario that is installed here"
    elif text != dump_scenario_yaml(scenario, registry.spec_versions(scenario)):
        yield f"{name} is not the scenario that its hash stands for"


def _without(archive: Archive, error: InputError) -> str:
    return str(error).removeprefix(f"{archive.path}: ")
