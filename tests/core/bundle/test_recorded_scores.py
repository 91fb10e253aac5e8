"""Scores of a bundle with recordings have to follow from them, all of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import pytest

from crowdbot.core.bundle import check_scores
from crowdbot.core.bundle.check import ClaimedRun
from crowdbot.core.scoring.evaluate import Scores
from crowdbot.core.types.score import Score
from tests.core.bundle.made_up_runs import registry
from tests.core.bundle.test_rerun_verdict import claimed, scored

METRIC = "spl"


class _Archive:
    """An archive that has the recordings of some runs."""

    def __init__(self, *names: str) -> None:
        self.path, self.names = Path("a.cbz"), set(names)


def _problems(
    monkeypatch: pytest.MonkeyPatch, run: ClaimedRun, *computed: Score, recorded: bool = True
) -> list[str]:
    monkeypatch.setattr(check_scores, "score_member", lambda *_: Scores(computed))
    archive: Any = _Archive(*["d/run.mcap"] * recorded)
    return list(check_scores.recorded_score_problems(archive, [run], registry(), None))


def _run(*scores: Score) -> ClaimedRun:
    version = cast(Any, registry().components("metric")[METRIC]).spec_version
    return claimed(*scores, metrics={METRIC: {"spec_version": version}})


def test_equal_scores_are_fine(monkeypatch: pytest.MonkeyPatch) -> None:
    run = _run(scored(METRIC, 0.5), scored(METRIC, 0.7, variant="way"))
    assert _problems(monkeypatch, run, *run.scores) == []
    rounded = scored(METRIC, 0.5 + 1e-12), run.scores[1]
    assert _problems(monkeypatch, run, *rounded) == []


def test_an_edited_score_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    run = _run(scored(METRIC, 0.9))
    (found,) = _problems(monkeypatch, run, scored(METRIC, 0.5))
    assert found == "s0 seed-0: spl.corrected is claimed to be 0.9, but its recording gives 0.5"
    assert _problems(monkeypatch, run, scored(METRIC, 0.5), recorded=False) == []


def test_a_score_that_was_left_out_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    both = scored(METRIC, 0.9), scored(METRIC, 0.7, variant="way")
    assert _problems(monkeypatch, _run(both[0]), *both) == ["s0 seed-0: spl.way was left out"]


def test_other_versions_of_metrics_are_not_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    run = claimed(scored(METRIC, 0.9), metrics={METRIC: {"spec_version": 999}})
    assert _problems(monkeypatch, run, scored(METRIC, 0.5)) == []


def test_many_contradictions_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    names = [f"v{k}" for k in range(10)]
    run = _run(*(scored(METRIC, 0.9, variant=v) for v in names))
    found = _problems(monkeypatch, run, *(scored(METRIC, 0.5, variant=v) for v in names))
    assert len(found) == 4
    assert found[-1] == "s0 seed-0: 7 more scores contradict its recording"
