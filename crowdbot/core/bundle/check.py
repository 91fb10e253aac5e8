"""Check a bundle without simulating anything."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import metadata

from crowdbot.core.bundle.archive import Archive
from crowdbot.core.bundle.check_conditions import condition_problems
from crowdbot.core.bundle.check_edition import edition_problems
from crowdbot.core.bundle.check_planner import planner_problems
from crowdbot.core.bundle.check_recordings import recording_problems
from crowdbot.core.bundle.check_run import ClaimedRun, declared_problems, run_problems
from crowdbot.core.bundle.check_scores import recorded_score_problems
from crowdbot.core.bundle.manifest import LOCK, PLANNER_FILES, BundledRun, Manifest
from crowdbot.core.bundle.pack import read_json
from crowdbot.core.planning.files_of_spec import KEPT
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.planner_files_kept import digests_of_files
from crowdbot.core.runs.run_record import RunRecord, record_problems
from crowdbot.core.scenarios.lock_check import spec_of
from crowdbot.core.scoring.scores_csv import parse_scores
from crowdbot.core.support.text import plural
from crowdbot.dsl.identity.canonical import dump_scenario_yaml
from crowdbot.dsl.identity.crowd_likeness import fingerprint
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import InputError

__all__ = ["ClaimedRun", "check_members", "check_suite", "claimed_runs", "problems_of"]

#: Files in a bundle for each run, and for each calibration run.
_OF_A_RUN = (files.RECORD, files.SCENARIO, files.SCORES)
_REFERENCES = "runs/references/"


def problems_of(
    archive: Archive, expansion: Expansion, registry: Registry
) -> tuple[list[ClaimedRun], list[str]]:
    """Return all readable runs, and all problems of a bundle without duplicates."""
    problems = list(check_members(archive))
    runs, wrong = claimed_runs(archive)
    problems += wrong
    problems += check_suite(archive, expansion, registry)
    if not problems:  # damaged or inconsistent bundles need not be read to the end
        problems += recording_problems(archive, runs)
    if not problems:
        problems += recorded_score_problems(archive, runs, registry, expansion.metrics)
    return runs, list(dict.fromkeys(problems))


def check_members(archive: Archive) -> Iterator[str]:
    """Yield problems of the archive itself: members that are missing, extra, or changed."""
    listed, there = set(archive.manifest.members), archive.names
    yield from (f"{name} is missing" for name in sorted(listed - there))
    yield from (f"{name} is not in the manifest" for name in sorted(there - listed))
    for name in sorted(listed & there):
        try:
            archive.check(name)
        except InputError as error:
            yield _without(archive, error)
    yield from _strangers(archive.manifest, listed)


def claimed_runs(archive: Archive) -> tuple[list[ClaimedRun], list[str]]:
    """Return all readable runs, and the problems of the others."""
    found, problems = [], list(_list_problems(archive.manifest))
    for entry in archive.manifest.runs:
        try:
            run = _claimed(archive, entry)
        except InputError as error:
            problems.append(_without(archive, error))
            continue
        found.append(run)
        findings = (
            run_problems(run, archive.manifest),
            _digest_problems(archive, run),
            condition_problems(archive, run),
        )
        try:
            problems += [f"{entry.directory}: {text}" for texts in findings for text in texts]
        except InputError as error:
            problems.append(_without(archive, error))
    return found, problems


def check_suite(archive: Archive, expansion: Expansion, registry: Registry) -> Iterator[str]:
    """Yield scenarios of a bundle that differ from the installed ones or are missing."""
    yield from edition_problems(archive.manifest, expansion)
    known = {s.id: s for s in expansion.scenarios}
    for run in archive.manifest.runs:
        if run.scenario not in known:
            yield f"{run.scenario[:200]} is not a scenario of {expansion.suite_id}"
            continue
        yield from _scenario_problems(archive, run, expansion, registry)


def _claimed(archive: Archive, entry: BundledRun) -> ClaimedRun:
    name = f"{entry.directory}/{files.RECORD}"
    document = read_json(archive.text(name), name)
    if problems := record_problems(document):
        raise InputError("; ".join(f"{name}: {text}" for text in problems))
    table = f"{entry.directory}/{files.SCORES}"
    rows = parse_scores(archive.text(table), table)
    for row in rows:
        if (row.scenario, row.seed) != (entry.scenario, entry.seed):
            raise InputError(f"{table}: a score of another run: {row.scenario} seed {row.seed}")
    return ClaimedRun(
        entry=entry,
        record=RunRecord.parse(document, name),
        scores=tuple(r.score for r in rows),
        planners=frozenset(r.planner for r in rows),
    )


def _digest_problems(archive: Archive, run: ClaimedRun) -> Iterator[str]:
    """Yield files whose digest differs from the one in the run's record."""
    for file, sha in run.record.digests.items():
        member = archive.manifest.members.get(f"{run.entry.directory}/{file}")
        if member is not None and member.sha256 != sha:
            yield f"{file[:100]} was changed after the run: {files.RECORD} has another digest"


def _list_problems(manifest: Manifest) -> Iterator[str]:
    """Yield contradictions in the manifest: planner, duplicate runs, seeds, number of runs."""
    yield from planner_problems(manifest.planner)
    if not manifest.runs:
        yield "there is no run in it"
    for field in ("directory", "run_id"):
        if len({getattr(r, field) for r in manifest.runs}) < len(manifest.runs):
            yield f"two runs have the same {field}"
    if len({(r.scenario, r.seed) for r in manifest.runs}) < len(manifest.runs):
        yield "a run is listed twice"
    expected = manifest.edition.scenarios * len(manifest.seeds)
    if len(manifest.runs) + len(manifest.missing) != expected:
        lists = f"it lists {plural(len(manifest.runs), 'run')}"
        lists += f", and {len(manifest.missing)} as missing" if manifest.missing else ""
        yield f"{lists}; the edition has {expected}"
    for run in manifest.runs:
        if run.seed not in manifest.seeds:
            yield f"{run.scenario[:200]} seed-{run.seed} is not a run of the manifest's seeds"
            break


def _strangers(manifest: Manifest, names: set[str]) -> Iterator[str]:
    """Yield members that belong to no run, and missing files of planner or runs."""
    own = {f"{run.directory}/{name}" for run in manifest.runs for name in _OF_A_RUN}
    recordings = {f"{run.directory}/{files.RECORDING}" for run in manifest.runs}
    read = {f"{PLANNER_FILES}{d}{KEPT}": d for _, d in digests_of_files(manifest.planner)}
    for name in sorted(set(read) & names):
        if manifest.members[name].sha256 != read[name]:
            yield f"{name} is not the file that the planner read: its content differs"
    for name in sorted(set(read) - names):
        yield f"{name[:200]} is missing, which the planner reads"
    for name in sorted(names - own - recordings - {LOCK} - set(read)):
        if not name.startswith(_REFERENCES):
            yield f"{name[:200]} belongs to no run of the manifest"
    lacking = sorted(recordings - names)
    if lacking and len(lacking) < len(recordings):
        some = f"{lacking[0][:200]} is missing, and {len(lacking) - 1} more"
        yield f"recordings of some runs are there, not of all: {some}"


def _place_problems(run: ClaimedRun, scenario: Scenario, axes: Mapping[str, str]) -> Iterator[str]:
    """Yield axis labels and crowds that differ from the scenario's: intervals and orders use them.

    The crowd's fingerprint may change between versions.
    """
    record, crowd = run.record, scenario.crowd
    if record.axes != dict(axes):
        labels, expected = _labels(record.axes), _labels(dict(axes))
        yield f"its axes are {labels}; the scenario's are {expected}"
    claimed = record.crowd
    same = record.versions.get("crowdbot") == metadata.version("crowdbot")
    if same and claimed is not None and claimed != ("" if crowd is None else fingerprint(crowd)):
        yield f"its crowd is said to be {str(claimed)[:40]!r}, which the scenario's is not"


def _labels(axes: object) -> str:
    return str(axes)[:100] if axes else "{}"


def _scenario_problems(
    archive: Archive, run: BundledRun, expansion: Expansion, registry: Registry
) -> Iterator[str]:
    scenario = next(s for s in expansion.scenarios if s.id == run.scenario)
    name = f"{run.directory}/{files.SCENARIO}"
    try:
        claimed = _claimed(archive, run)
        text = archive.text(name)
    except InputError:
        return  # already reported
    yield from (f"{run.directory}: {text}" for text in declared_problems(claimed, registry))
    axes = expansion.axes.get(run.scenario, {})
    yield from (f"{run.directory}: {text}" for text in _place_problems(claimed, scenario, axes))
    hashes = claimed.record.hashes
    locked = scenario.locked.files.lock.scenarios.get(run.scenario) if scenario.locked else None
    if locked is not None and hashes.realisation != locked.realisation:
        yield f"{run.scenario}: its people are not those of the lock that is installed here"
    if hashes.spec != spec_of(scenario, registry):
        yield f"{run.scenario}: its hash is not that of the scenario that is installed here"
    elif text != dump_scenario_yaml(scenario, registry.spec_versions(scenario)):
        yield f"{name} is not the scenario that its hash stands for"


def _without(archive: Archive, error: InputError) -> str:
    return str(error).removeprefix(f"{archive.path}: ")
