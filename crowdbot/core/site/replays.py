"""Replay pages of a challenge's site: the best and a typical run of the first planners."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from crowdbot.core.bundle.archive import open_archive
from crowdbot.core.bundle.check_run import ClaimedRun
from crowdbot.core.bundle.entries import LeaderboardEntry
from crowdbot.core.registry.registry import Registry
from crowdbot.core.replay.page import write_replay
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.replayed import replayed_runs
from crowdbot.core.scoring.four_scores import PRIMARY

FOLDER = "replays"
_PLANNERS = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class SiteReplay:
    """One replay page: planner, choice of run, and the page's path relative to the site."""

    entry: str
    which: str
    run: str
    value: float
    file: str


def write_replays(
    entries: Sequence[LeaderboardEntry], registry: Registry, folder: Path
) -> list[SiteReplay]:
    """Write replays of the first entries whose bundles have recordings.

    Raises:
        InputError: a recording cannot be read, or a page cannot be written.
    """
    made: list[SiteReplay] = []
    shown = 0
    for entry in (e for e in entries if e.ranked):
        scored = sorted((v, run.name, run) for run in entry.runs if (v := _value(run)) is not None)
        if not scored or not _has_recording(entry, scored[0][2]):
            continue
        shown += 1
        if shown > _PLANNERS:
            break
        chosen = {"best": scored[-1], "typical": scored[(len(scored) - 1) // 2]}
        for which, (value, name, run) in chosen.items():
            if which == "typical" and run is scored[-1][2]:
                continue  # the only run
            file = f"{FOLDER}/{shown}-{which}.html"
            _write(entry, run, registry, folder / file)
            made.append(SiteReplay(entry=entry.name, which=which, run=name, value=value, file=file))
    return made


def _value(run: ClaimedRun) -> float | None:
    primary = (PRIMARY.metric, PRIMARY.variant)
    return next((s.value for s in run.scores if (s.metric, s.variant) == primary), None)


def _has_recording(entry: LeaderboardEntry, run: ClaimedRun) -> bool:
    return f"{run.entry.directory}/{files.RECORDING}" in entry.manifest.members


def _write(entry: LeaderboardEntry, run: ClaimedRun, registry: Registry, page: Path) -> None:
    page.parent.mkdir(exist_ok=True)
    with open_archive(entry.path) as archive, tempfile.TemporaryDirectory() as scratch:
        place = Path(scratch)
        for name in (files.RECORD, files.SCENARIO, files.SCORES, files.RECORDING):
            archive.unpack(f"{run.entry.directory}/{name}", place / name)
        (shown,) = replayed_runs([place], registry)
        write_replay(page, shown, title=f"{run.name} · {entry.name}")
