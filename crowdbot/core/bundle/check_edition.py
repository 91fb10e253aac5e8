"""Check that a bundle is of the installed edition: suite, lock, rules, seeds."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

from crowdbot.core.bundle.manifest import LOCK, RULES, Manifest
from crowdbot.core.bundle.verification import content_hash
from crowdbot.core.support.text import plural
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.suite.round import Round

_SHOWN = 3
#: Names of a suite's fields where the manifest has another one.
_FIELDS = {"handed_in": "round.planners"}


def missing_runs(expansion: Expansion, there: set[tuple[str, int]]) -> list[str]:
    """Return ``ID seed-N`` of the edition's missing runs, in the suite's order.

    Args:
        expansion: the expanded suite, with the seeds.
        there: scenario and seed of existing runs.
    """
    return [
        f"{scenario.id} seed-{seed}"
        for scenario in expansion.scenarios
        for seed in expansion.run_seeds
        if (scenario.id, seed) not in there
    ]


def lock_of(expansion: Expansion) -> Path | None:
    """Return the lock file of a suite; None without one."""
    found = (s.locked.files.lock_path for s in expansion.scenarios if s.locked is not None)
    path = next(found, None)
    return path if path is not None and path.exists() else None


def late(bundle: Path, closes: str) -> str:
    """Return why a bundle is late, by the time stamp of its file; empty if it is in time.

    Args:
        bundle: the archive.
        closes: day or moment at which the round closes; empty: never.
    """
    if not closes:
        return ""
    arrived = datetime.fromtimestamp(bundle.stat().st_mtime, UTC)
    reason = Round(closes=closes).problem(arrived)
    return reason and f"{reason}; the file is of {arrived:%Y-%m-%d %H:%M} UTC"


def edition_problems(manifest: Manifest, expansion: Expansion) -> Iterator[str]:
    """Yield claims of a manifest about its edition that are false."""
    edition, name = manifest.edition, expansion.suite_id
    lock = lock_of(expansion)
    expected = {
        "suite": name,
        "title": expansion.title,
        "lock": content_hash(lock) if lock else "",
        "scenarios": len(expansion.scenarios),
        "rules": RULES,
        "handed_in": expansion.round.planners if expansion.round else "any",
    }
    for key, value in expected.items():
        packed = getattr(edition, key)
        if packed != value:
            field = _FIELDS.get(key, key)
            yield f"it was packed with {field} {_shown(packed)}; {name} here has {_shown(value)}"
    member = manifest.members.get(LOCK)
    if edition.lock != (member.sha256 if member else ""):
        yield f"the edition is not that of {LOCK}"
    if tuple(manifest.seeds) != expansion.run_seeds:
        seeds = ", ".join(map(str, manifest.seeds[:10]))
        own = ", ".join(map(str, expansion.run_seeds[:10]))
        yield f"its seeds are {seeds or 'none'}; the edition's are {own}"
    if manifest.versions.get("crowdbot") != manifest.crowdbot:
        yield "the manifest names two versions of crowdbot"
    yield from _missing(manifest, expansion)


def _missing(manifest: Manifest, expansion: Expansion) -> Iterator[str]:
    """Yield runs that are missing but not declared missing, and the opposite."""
    there = {(r.scenario, r.seed) for r in manifest.runs}
    lacking, declared = missing_runs(expansion, there), set(manifest.missing)
    hidden = [n for n in lacking if n not in declared]
    if hidden:
        some = ", ".join(hidden[:_SHOWN])
        yield f"left out without being listed as missing: {plural(len(hidden), 'run')}, {some}"
    invented = sorted(declared - set(lacking))
    if invented or len(declared) < len(manifest.missing):
        some = ", ".join(n[:100] for n in invented[:_SHOWN]) or "one run twice"
        yield f"the manifest's list of missing runs is wrong: {some}"
    for run in manifest.runs:
        if run.seed not in expansion.run_seeds:
            yield f"{run.scenario[:200]} seed-{run.seed} is not a run of the edition"


def _shown(value: object) -> str:
    text = str(value)
    return f"'{text[:60]}'" if isinstance(value, str) else text
