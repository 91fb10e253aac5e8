"""Check that the claimed scores follow from the recordings in a bundle, all of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from crowdbot.core.bundle.agreement import agree, name_of, shown
from crowdbot.core.bundle.archive import Archive
from crowdbot.core.bundle.check_run import ClaimedRun
from crowdbot.core.bundle.score_members import recording_of, score_member
from crowdbot.core.bundle.tolerances import WALL_CLOCK
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs.record_parts import MetricPart
from crowdbot.errors import CrowdbotError

#: Largest number of contradictions that are listed per run.
_SHOWN = 3


def recorded_score_problems(
    archive: Archive,
    runs: Sequence[ClaimedRun],
    registry: Registry,
    metrics: Sequence[str] | None,
) -> Iterator[str]:
    """Yield claimed scores that the recordings contradict; none without recordings.

    Args:
        archive: the archive, whose recordings belong to its runs.
        runs: all its runs.
        registry: the installed components.
        metrics: metrics of the suite; None: all.
    """
    for run in runs:
        if recording_of(run) in archive.names:
            yield from (
                f"{run.name}: {text}" for text in _problems(archive, run, registry, metrics)
            )


def _problems(
    archive: Archive, run: ClaimedRun, registry: Registry, metrics: Sequence[str] | None
) -> list[str]:
    try:
        found = score_member(archive, run, "*" if metrics is None else metrics, registry)
    except CrowdbotError as error:
        return [f"its recording cannot be scored: {error}"]
    known = registry.components("metric")
    here = {}
    for score in found.items:
        part = MetricPart(spec_version=known[score.metric].spec_version, **score.parameters)
        if run.record.metrics.get(score.metric) == part:
            here[score.metric, score.variant] = score
    problems = []
    for score in run.scores:
        computed = here.pop((score.metric, score.variant), None)
        if computed is None or score.metric in WALL_CLOCK or agree(score, computed):
            continue
        problems.append(
            f"{name_of(score)} is claimed to be {shown(score)}, but its recording gives "
            f"{shown(computed)}"
        )
    problems += [f"{name_of(score)} was left out" for score in here.values()]
    more = len(problems) - _SHOWN
    return problems[:_SHOWN] + [f"{more} more scores contradict its recording"] * (more > 0)
