"""The results of a study as one table: a line for each drive, with scores and answers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.scoring.evaluate import score
from crowdbot.core.scoring.scores_csv import read_scores_csv
from crowdbot.core.studies.document import Study
from crowdbot.core.studies.progress import StudyProgress
from crowdbot.core.trajectories.questionnaires import TLX_SCALES, USE_ITEMS, Questionnaires
from crowdbot.errors import InputError

#: Columns before the scores.
FIRST = (
    "participant", "position", "condition", "step", "trial", "suite", "scenario", "driver",
    "status", "run",
)  # fmt: skip

Row = dict[str, Any]


def study_rows(study: Study, folder: Path, registry: Registry) -> list[Row]:
    """Return a row for each finished drive, without practice.

    Scores have the names ``metric.variant``; those of questionnaires belong to the condition and
    are repeated in each of its rows. Missing numbers are None.

    Raises:
        InputError: a file of the data is damaged.
    """
    rows = [
        row for p in study.spec.people for row in _rows(StudyProgress(study, folder, p), registry)
    ]
    names = sorted({name for row in rows for name in row if name not in FIRST})
    return [{name: row.get(name) for name in (*FIRST, *names)} for row in rows]


def _rows(progress: StudyProgress, registry: Registry) -> Iterator[Row]:
    done = progress.done()
    weights: Mapping[str, Any] = {}
    answers: dict[str, dict[str, Any]] = {}
    for step in progress.steps:  # comparisons may be asked once, for all conditions
        entry = done.get(step.name)
        if entry is None:
            break
        found = entry.get("answers")
        if step.kind == "weights" and found:
            weights = found
        if step.kind in ("nasa_tlx", "weights", "use") and found:
            answers.setdefault(step.condition, {})[step.kind] = found
    for step in progress.steps:
        entry = done.get(step.name)
        if step.kind != "trial" or entry is None or step.trial is None:
            continue
        sheets = answers.get(step.condition, {})
        run = progress.folder / entry["run"]
        yield {
            "participant": progress.participant,
            "position": step.position,
            "condition": step.condition,
            "step": step.number,
            "trial": step.index,
            "suite": step.trial.suite,
            "scenario": step.trial.scenario,
            "driver": entry["driver"],
            "status": RunRecord.read(run).status,
            "run": entry["run"],
            **_scores(run),
            **_of_answers(sheets, sheets.get("weights") or weights, registry),
        }


def _scores(run: Path) -> Row:
    """Return the values of a run's scores that exist."""
    path = run / "scores.csv"
    if not path.is_file():
        raise InputError(f"{path}: it is missing; a run of the study was changed")
    scores = (row.score for row in read_scores_csv(path))
    return {f"{s.metric}.{s.variant}": s.value for s in scores if s.value is not None}


def _of_answers(
    sheets: Mapping[str, Mapping[str, Any]], weights: Mapping[str, Any], registry: Registry
) -> Row:
    """Return the scores of the questionnaires of one condition."""
    if not sheets:
        return {}
    tlx, use = sheets.get("nasa_tlx", {}), sheets.get("use", {})
    given = Questionnaires(
        tlx_ratings={s: float(tlx[s]) for s in TLX_SCALES if s in tlx},
        tlx_weights={s: float(weights[s]) for s in TLX_SCALES if tlx and s in weights},
        use={
            d: tuple(_number(use.get(f"{d}_{k}")) for k in range(1, count + 1))
            for d, count in USE_ITEMS.items()
            if use
        },
    )
    found = score(registry, None, questionnaires=given, metrics=("nasa_tlx", "use"))
    return {f"{s.metric}.{s.variant}": s.value for s in found if s.value is not None}


def _number(text: Any) -> float | None:
    return float(text) if text not in (None, "") else None
