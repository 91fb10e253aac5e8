"""Leaderboard entries: bundles that are read, checked and, if needed, scored again."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from crowdbot.core.bundle.archive import Archive, open_archive
from crowdbot.core.bundle.check import check_members, claimed_runs
from crowdbot.core.bundle.check_edition import late
from crowdbot.core.bundle.check_run import ClaimedRun, declared_problems
from crowdbot.core.bundle.manifest import Manifest
from crowdbot.core.bundle.score_members import score_member
from crowdbot.core.bundle.verification import JUDGED, REFUSED, content_hash, read_verification
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.record_parts import MetricPart
from crowdbot.core.support.look_alike import alike
from crowdbot.core.support.text import plural
from crowdbot.core.types.ending import has_failed
from crowdbot.dsl.suite.round import Round
from crowdbot.errors import InputError, printable

SUFFIX = ".cbz"


@dataclass(frozen=True, slots=True, kw_only=True)
class LeaderboardEntry:
    """One bundle on the leaderboard.

    Attributes:
        name: team and planner, unique per entry.
        sha256: hash of the archive.
        verification: the signed verification record beside it, or None.
        doubt: why the verification record beside it is not trusted.
        rescored: metrics scored again from recordings, since their version has changed.
        outdated: metrics left out, since their version has changed and the bundle cannot be scored
            again.
    """

    path: Path
    name: str
    manifest: Manifest
    sha256: str
    verification: Mapping[str, Any] | None
    runs: tuple[ClaimedRun, ...] = field(repr=False)
    rescored: tuple[str, ...] = ()
    outdated: tuple[str, ...] = ()
    doubt: str = ""

    @property
    def ranked(self) -> bool:
        """Return True if the entry may have a rank."""
        return not self.unranked

    @property
    def unranked(self) -> str:
        """Return why it has no rank: incomplete, refused, or not in the required form."""
        outcome = (self.verification or {}).get("outcome")
        if outcome in REFUSED:
            return f"the organisers found it {outcome}"
        if self.manifest.missing:
            return f"{plural(len(self.manifest.missing), 'run')} missing"
        if self.manifest.edition.handed_in == "sealed" and outcome != JUDGED:
            return "this round ranks sealed planners only"
        return ""

    def in_round(self, held: Round | None) -> LeaderboardEntry:
        """Return the entry with the organisers' closing date and form, in place of the bundle's."""
        fields = {
            "closes": (held and held.closes) or "",
            "handed_in": held.planners if held else "any",
        }
        edition = self.manifest.edition.model_copy(update=fields)
        return replace(self, manifest=self.manifest.model_copy(update={"edition": edition}))

    @property
    def late(self) -> str:
        """Return why the archive is late, by the time stamp of its file; empty if it is in time."""
        return late(self.path, self.manifest.edition.closes)

    @property
    def is_verified(self) -> bool:
        """Return True if an organiser has repeated some of its runs and accepted it."""
        record = self.verification
        return bool(record and record.get("ok") is True and record.get("runs"))

    @property
    def failed(self) -> int:
        """Return the number of runs in which the planner failed."""
        return sum(has_failed(run.record.status) for run in self.runs)


def load_entries(
    folder: Path, registry: Registry, trusted: Collection[str] = ()
) -> tuple[list[LeaderboardEntry], dict[str, str]]:
    """Return all bundles of a folder, by file name, and reasons for those left out.

    Args:
        folder: folder of the bundles.
        registry: the installed components.
        trusted: public keys of organisers, whose verification records are accepted.

    Raises:
        InputError: no such folder, or no bundle in it.
    """
    paths = sorted(p for p in folder.glob(f"*{SUFFIX}") if p.is_file())
    if not paths:
        raise InputError(f"{folder}: no bundles (*{SUFFIX}) there")
    entries, left_out = [], dict[str, str]()
    for path in paths:
        try:
            entries.append(_entry(path, registry, trusted))
        except InputError as error:
            left_out[path.name] = str(error).removeprefix(f"{path}: ")
        except Exception as error:  # any error concerns one bundle only
            left_out[path.name] = f"malformed: {type(error).__name__}: {str(error)[:200]}"
    return _named_apart(entries), left_out


def _entry(path: Path, registry: Registry, trusted: Collection[str]) -> LeaderboardEntry:
    with open_archive(path) as archive:
        problems = list(check_members(archive))
        runs, wrong = claimed_runs(archive)
        problems += wrong
        for run in [] if problems else runs:
            problems += [f"{run.entry.directory}: {p}" for p in declared_problems(run, registry)]
        if problems:
            raise InputError(f"{path}: {problems[0]}")
        manifest = archive.manifest
        verification, doubt = read_verification(path, trusted)
        entry = LeaderboardEntry(
            path=path,
            name=" · ".join(part for part in (manifest.team, manifest.label) if part),
            manifest=manifest,
            sha256=content_hash(path),
            verification=verification,
            doubt=doubt,
            runs=tuple(runs),
        )
        return _up_to_date(entry, archive, registry)


def _named_apart(entries: Sequence[LeaderboardEntry]) -> list[LeaderboardEntry]:
    similar = alike(e.name for e in entries)
    return [
        replace(e, name=f"{e.name} ({printable(e.path.stem)})") if e.name in similar else e
        for e in entries
    ]


# ------------------------------------------------------------------ metrics' versions
def old_metrics(run: ClaimedRun, registry: Registry) -> set[str]:
    """Return metrics of a run whose version is not the installed one."""
    known = registry.components("metric")
    return {s.metric for s in run.scores if _version(run, s.metric) != (
        known[s.metric].spec_version if s.metric in known else None)}  # fmt: skip


def _version(run: ClaimedRun, metric: str) -> int | None:
    recorded = run.record.metrics.get(metric)
    return None if recorded is None else recorded.spec_version


def _up_to_date(entry: LeaderboardEntry, archive: Archive, registry: Registry) -> LeaderboardEntry:
    old = {metric for run in entry.runs for metric in old_metrics(run, registry)}
    if not old:
        return entry
    known = registry.components("metric")
    recorded = all(f"{r.entry.directory}/{files.RECORDING}" in archive.names for r in entry.runs)
    again = sorted(old & set(known)) if recorded else []
    gone = sorted(old - set(again))
    runs = tuple(_scored_again(archive, run, again, gone, registry) for run in entry.runs)
    return replace(entry, runs=runs, rescored=tuple(again), outdated=tuple(gone))


def _scored_again(
    archive: Archive, run: ClaimedRun, again: Sequence[str], gone: Sequence[str], registry: Registry
) -> ClaimedRun:
    left = [s for s in run.scores if s.metric not in again and s.metric not in gone]
    metrics = dict(run.record.metrics)
    for name in gone:
        metrics.pop(name, None)
    if again:
        known = registry.components("metric")
        found = list(score_member(archive, run, again, registry))
        left += found
        metrics |= {s.metric: MetricPart(spec_version=known[s.metric].spec_version, **s.parameters)
                    for s in found}  # fmt: skip
    left.sort(key=lambda s: s.metric)
    record = run.record.model_copy(update={"metrics": metrics})
    return replace(run, scores=tuple(left), record=record)
