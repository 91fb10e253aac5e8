"""Pack a bundle from run directories."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path, PurePosixPath
from typing import Any

from crowdbot.core.bundle.archive import members_of, write_archive
from crowdbot.core.bundle.check_edition import missing_runs
from crowdbot.core.bundle.manifest import (
    BUNDLE,
    LOCK,
    PLANNER_FILES,
    RULES,
    BundledRun,
    Edition,
    Manifest,
    name_problem,
)
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.planner_files_kept import digests_of_files, kept_file
from crowdbot.core.runs.run_record import RunRecord, record_problems
from crowdbot.core.scenarios.lock_check import spec_of
from crowdbot.core.scoring.scores_csv import read_scores_csv
from crowdbot.core.support.source_digest import file_digest
from crowdbot.core.support.strict_json import parse_json
from crowdbot.core.types.ending import Ending
from crowdbot.dsl.scenario.lock import LockFiles
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.suite.round import Round
from crowdbot.errors import InputError, UnknownNameError, printable

_OF_A_RUN = (files.RECORD, files.SCENARIO, files.SCORES)
_SHOWN = 10


@dataclass(frozen=True, slots=True, kw_only=True)
class Submission:
    """The runs, texts and options of a bundle: the arguments of `pack`.

    Attributes:
        root: root of the run directories.
        planner: name of the planner's folders.
        team, contact: texts for the leaderboard; may be empty.
        partial: True to allow an incomplete set, and a planner that failed in all runs.
        failing: True to allow the latter only.
        recordings: True to include recordings.
    """

    root: Path
    planner: str
    team: str = ""
    contact: str = ""
    partial: bool = False
    failing: bool = False
    recordings: bool = False


@dataclass(frozen=True, slots=True)
class _CompleteRun:
    """One complete run: name of its folder below the root, its record, and the suite's axes."""

    folder: PurePosixPath
    record: RunRecord
    axes: Mapping[str, str]


def pack(
    submission: Submission,
    expansion: Expansion,
    lock: LockFiles,
    registry: Registry,
    out: Path,
) -> Manifest:
    """Write the bundle of one planner.

    Args:
        submission: the selection to pack.
        expansion, lock: the suite and its lock.
        registry: the installed components.
        out: the archive, written atomically.

    Raises:
        InputError: runs are missing, belong to another version of the suite, or are inconsistent;
            or reading or writing fails.
        UnknownNameError: there is no run of this planner.
    """
    for option, text in (("--team", submission.team), ("--contact", submission.contact)):
        if problem := name_problem(text):
            raise InputError(f"{option} {printable(text[:60])!r}: {problem}")
    found = _runs(submission, expansion)
    missing = missing_runs(expansion, {(f.record.scenario, f.record.seed) for f in found})
    if missing and not submission.partial:
        some = "\n".join(f"  {name}" for name in missing[:_SHOWN])
        more = f"\n  … and {len(missing) - _SHOWN} more" if len(missing) > _SHOWN else ""
        raise InputError(
            f"{len(missing)} of {len(missing) + len(found)} runs are missing:\n{some}{more}\n"
            "run them, or pack what is there with --partial"
        )
    _check_fits(found, expansion, registry)
    _check_alike(found)
    _check_driven(submission, found)
    members = _members(submission, found)
    if lock.lock_path.exists():
        members[LOCK] = lock.lock_path.read_bytes()
    manifest = _manifest(submission, expansion, found, missing, members)
    write_archive(out, manifest, members)
    return manifest


# ------------------------------------------------------------------------ finding
def _runs(submission: Submission, expansion: Expansion) -> list[_CompleteRun]:
    """Return complete runs of the planner, in the suite's order."""
    base = submission.root / expansion.suite
    labels = {p.parent.name for p in base.glob("*/*/seed-*") if p.is_dir()}
    if submission.planner not in labels:
        if not labels:
            raise InputError(f"{base}: no runs of {expansion.suite_id} there")
        raise UnknownNameError("planner among the runs", submission.planner, labels)
    runs = []
    for scenario in expansion.scenarios:
        folder = base / scenario.id / submission.planner
        for seed in expansion.run_seeds:
            place = folder / f"seed-{seed}"
            record = _record(place)
            if record is not None:
                name = PurePosixPath(place.relative_to(submission.root).as_posix())
                axes = expansion.axes.get(scenario.id, {})
                runs.append(_CompleteRun(name, record, axes))
    if not runs:
        seeds = other_seeds(submission, expansion)
        if seeds:
            raise InputError(
                f"{base}: there are runs with seeds {', '.join(map(str, seeds[:_SHOWN]))} only; "
                f"those of {expansion.suite_id} are {', '.join(map(str, expansion.run_seeds))}"
            )
        there = min(p.parent.parent.name for p in base.glob(f"*/{submission.planner}/seed-*"))
        raise InputError(
            f"{base}: no run of '{submission.planner}' is complete and of a scenario as "
            f"{expansion.suite_id} has it; what is there, such as {there}, was interrupted, or "
            "changed with --set"
        )
    return runs


def other_seeds(submission: Submission, expansion: Expansion) -> list[int]:
    """Return seeds of existing runs that the edition does not include."""
    base = submission.root / expansion.suite
    names = {p.name for p in base.glob(f"*/{submission.planner}/seed-*") if p.is_dir()}
    numbers = {n.removeprefix("seed-") for n in names}
    return sorted({int(n) for n in numbers if n.isdecimal()} - set(expansion.run_seeds))


def _record(place: Path) -> RunRecord | None:
    """Return the record of a complete run, beside a table of scores; None where there is none."""
    try:
        document = files.checked_record(place)
    except InputError:
        return None
    if problems := record_problems(document):
        raise InputError(f"{place / files.RECORD}: damaged: {problems[0]}; run it again")
    if (place / files.SCORES).is_file():  # missing files are reported with the others
        read_scores_csv(place / files.SCORES)
    if wrong := files.changed(place, document, (*_OF_A_RUN, files.RECORDING)):
        raise InputError(f"{place}: {wrong}; run it again")
    return RunRecord.parse(document, place)


# ----------------------------------------------------------------------- checking
def _check_fits(runs: Sequence[_CompleteRun], expansion: Expansion, registry: Registry) -> None:
    specs = {s.id: spec_of(s, registry) for s in expansion.scenarios}
    for run in runs:
        if run.record.hashes.spec != specs[run.record.scenario]:
            raise InputError(
                f"{run.folder} is of another state of {expansion.suite_id}: its scenario has "
                "another hash; run it again"
            )


def _check_alike(runs: Sequence[_CompleteRun]) -> None:
    """Refuse a bundle of runs that cannot be compared with each other."""
    first = runs[0]
    for name in ("planner", "versions", "pinned"):
        for run in runs[1:]:
            if getattr(run.record, name) != getattr(first.record, name):
                raise InputError(
                    f"{first.folder} and {run.folder} have different '{name}' in {files.RECORD}; "
                    "run the older ones again"
                )


def _check_driven(submission: Submission, runs: Sequence[_CompleteRun]) -> None:
    """Refuse a bundle of a planner that failed in every run."""
    record, allowed = runs[0].record, submission.partial or submission.failing
    if not allowed and all(run.record.status == Ending.PLANNER_FAILED for run in runs):
        raise InputError(
            f"{submission.planner} failed in all {len(runs)} runs: there is nothing to compare; "
            f"the first: {record.reason}; --partial packs them all the same"
        )


# ------------------------------------------------------------------------ packing
def _members(submission: Submission, runs: Sequence[_CompleteRun]) -> dict[str, Path | bytes]:
    members: dict[str, Path | bytes] = {}
    for run in runs:
        folder = submission.root / run.folder
        names = [*_OF_A_RUN, files.RECORDING] if submission.recordings else [*_OF_A_RUN]
        members |= {f"runs/{run.folder}/{name}": folder / name for name in names}
        if submission.recordings:
            members |= dict(_references(submission.root, folder, run))
        if run.axes and not run.record.axes:  # runs made from Python have no suite
            whole = files.json_text({**run.record.document(), "axes": dict(run.axes)})
            members[f"runs/{run.folder}/{files.RECORD}"] = whole.encode()
    members |= dict(_planner_files(submission.root, runs[0].record.planner.document()))
    for name, place in members.items():
        if isinstance(place, Path) and not place.is_file():
            raise InputError(f"{place}: missing; run {name} again")
    return members


def _planner_files(root: Path, planner: Mapping[str, Any]) -> Iterator[tuple[str, Path]]:
    """Yield the files that the planner reads, as they were kept beside its runs."""
    for name, digest in digests_of_files(planner):
        file = kept_file(root, digest)
        if not file.is_file() or file_digest(file) != digest:
            raise InputError(
                f"{file}: missing or changed; it is {name}, which the planner reads: run again"
            )
        yield PLANNER_FILES + file.name, file


def _references(root: Path, folder: Path, run: _CompleteRun) -> Iterator[tuple[str, Path]]:
    """Yield the recordings of the run's references."""
    for path in run.record.references.values():
        place = (folder / path).resolve()
        inside = place.is_relative_to(root.resolve())
        if not inside:
            raise InputError(f"{folder}: its reference {path} is not below {root}")
        name = place.relative_to(root.resolve()).as_posix()
        yield f"runs/{name}", place
        record = place.with_name(files.RECORD)
        yield f"runs/{PurePosixPath(name).with_name(files.RECORD)}", record


def _manifest(
    submission: Submission,
    expansion: Expansion,
    runs: Sequence[_CompleteRun],
    missing: Sequence[str],
    members: Mapping[str, Path | bytes],
) -> Manifest:
    first, held = runs[0].record, expansion.round or Round()
    lock = members.get(LOCK)
    return Manifest(
        bundle=BUNDLE,
        crowdbot=metadata.version("crowdbot"),
        team=submission.team,
        contact=submission.contact,
        edition=Edition(
            suite=expansion.suite_id,
            title=expansion.title,
            lock=hashlib.sha256(lock).hexdigest() if isinstance(lock, bytes) else "",
            scenarios=len(expansion.scenarios),
            rules=RULES,
            closes=held.closes or "",
            handed_in=held.planners,
        ),
        planner=first.planner.document(),
        classed=first.classed,
        pinned=first.pinned,
        versions=first.versions,
        seeds=list(expansion.run_seeds),
        missing=list(missing),
        runs=[
            BundledRun(
                scenario=f.record.scenario,
                seed=f.record.seed,
                directory=f"runs/{f.folder}",
                run_id=f.record.run_id,
                trajectory=f.record.hashes.trajectory,
            )
            for f in runs
        ],
        members=members_of(members),
    )


def read_json(text: str, description: str) -> dict[str, Any]:
    """Return a JSON document that is a mapping.

    Raises:
        InputError: it is not a mapping.
    """
    try:
        document = parse_json(text)
    except ValueError as error:
        raise InputError(f"{description} is not a JSON document: {error}") from None
    if not isinstance(document, dict):
        raise InputError(f"{description} is not a mapping")
    return document
