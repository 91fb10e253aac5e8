"""Reference scores: runs of crowdbot's planners in one small file, with hashes to repeat them.

Data shared by runs (planners, scenarios, versions, metrics) is written once, a run is a short row.
The file holds no recordings: each row has the hash of its trajectory, which `crowdbot verify`
compares with that of the repeated run.
"""

from __future__ import annotations

import json
import lzma
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError

from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow, ScoreRow
from crowdbot.core.runs.run_record import RunIdentity, RunRecord
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.strict_json import parse_json
from crowdbot.dsl.text.bounded_files import read_bytes, reason_of
from crowdbot.errors import InputError

#: The word that names the file that comes with crowdbot, the file, and its largest size, bytes.
SHIPPED, NAME, LARGEST = "crowdbot", "reference_scores.json.xz", 1_000_000
SUFFIX = ".json.xz"
_UNPACKED, _FORMAT, _DIGITS = 64_000_000, 2, 6
_HASH = "cb1-sha256:"
#: Metrics that are kept, with all of their variants.
METRICS = (
    "safe_efficiency", "acceptance", "contacts_per_km", "push_work", "intrusion", "success",
    "contacts_at_fault", "collision_count", "min_clearance", "relative_time_to_goal", "delay",
    "evasive_acceleration", "regress",
)  # fmt: skip
#: Keys of ``run.json`` by what they depend on.
_OF_SCENARIO = (
    "suite", "scenario", "axes", "axis_words", "position", "agents", "conditions", "crowd",
    "suite_metrics",
)  # fmt: skip
_OF_PLANNER = ("planner", "role", "privileged", "pinned", "planner_process")
_OF_MAKER = ("versions", "plugins", "machine", "allowed_plugins")
#: Those of a run alone, as they stand in its row.
_OWN = ("seed", "status", "reason", "goal_time", "sim_time", "density")


class _File(BaseModel):
    """The document in the file.

    Attributes:
        commands: those that made it, the first one first.
        metrics: the versions of the metrics, as in ``run.json``.
        makers, scenarios, planners: parts of ``run.json`` that many runs share; a maker is a
            machine with its versions.
        columns: category, metric, symbol, variant, unit, better of each score.
        runs: maker, scenario, planner, seed, ending, time of arrival, simulated time, density,
            trajectory, scores.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    references: int
    commands: list[str]
    metrics: dict[str, Any]
    makers: list[dict[str, Any]]
    scenarios: list[dict[str, Any]]
    planners: list[dict[str, Any]]
    columns: list[list[str]]
    runs: list[list[Any]]


@dataclass(frozen=True)
class ReferenceScores:
    """The content of a file of reference scores.

    Attributes:
        commands: those that made it, the first one first.
        results: its runs and scores, like those of a folder of runs.
    """

    commands: tuple[str, ...]
    results: Results

    @cached_property
    def held(self) -> tuple[str, ...]:
        """Return a summary of the content: one line for each suite."""
        found = []
        for suite in dict.fromkeys(r.suite for r in self.results.runs):
            runs = [r for r in self.results.runs if r.suite == suite]
            scenarios, seeds = ({getattr(r, n) for r in runs} for n in ("scenario", "seed"))
            planners = dict.fromkeys(r.planner for r in runs)
            found.append(
                f"{suite}: {len(runs)} runs, {len(scenarios)} scenarios, seeds "
                f"{', '.join(map(str, sorted(seeds)))}; {', '.join(planners)}"
            )
        return tuple(found)


# ------------------------------------------------------------------------- writing
def write_references(out: Path, results: Results, commands: Sequence[str]) -> int:
    """Write runs and scores into a small file; equal results give equal bytes.

    Args:
        out: the file.
        results: scores of one version of each metric; machines may differ.
        commands: those that made them.

    Returns:
        Its size, bytes.

    Raises:
        InputError: there are no runs, versions of a metric differ, or it would be too large.
    """
    if not results.runs:
        raise InputError("there are no runs to keep as references")
    metrics = _metrics(results)
    makers, scenarios, planners, columns = _Table(), _Table(), _Table(), _Table()
    by_run: dict[str, dict[int, float | None]] = {}
    for score in results.scores:
        if score.metric in METRICS:
            number = columns.number([getattr(score, n) for n in _COLUMNS])
            by_run.setdefault(score.run_id, {})[number] = _rounded(score.value)
    tables = makers, scenarios, planners
    rows = [_row(run, by_run.get(run.run_id, {}), *tables) for run in results.runs]
    document = {
        "references": _FORMAT, "commands": list(commands), "metrics": metrics,
        "makers": makers.items, "scenarios": scenarios.items, "planners": planners.items,
        "columns": columns.items,
        "runs": [[*row[:-1], [row[-1].get(n) for n in range(len(columns.items))]] for row in rows],
    }  # fmt: skip
    text = json.dumps(document, ensure_ascii=False, separators=(",", ":"))
    content = lzma.compress(text.encode(), preset=9 | lzma.PRESET_EXTREME)
    if len(content) > LARGEST:
        raise InputError(f"{out}: {len(content)} bytes; references have at most {LARGEST}")
    atomic_write(out, content)
    return len(content)


_COLUMNS = ("category", "metric", "symbol", "variant", "unit", "better")


class _Table:
    """Distinct items, numbered in the order of first use."""

    def __init__(self) -> None:
        self.items: list[Any] = []
        self._numbers: dict[str, int] = {}

    def number(self, item: Any) -> int:
        key = json.dumps(item, sort_keys=True)
        if key not in self._numbers:
            self._numbers[key] = len(self.items)
            self.items.append(item)
        return self._numbers[key]


def _metrics(results: Results) -> dict[str, Any]:
    """Return version and parameters of each metric in the file, from the records of runs."""
    metrics: dict[str, Any] = {}
    for run in results.runs:
        document = run.record.document()
        own = {n: m for n, m in document["metrics"].items() if n in METRICS}
        changed = [n for n, m in own.items() if metrics.setdefault(n, m) != m]
        if changed:
            raise InputError(
                f"{run.directory}: other runs have another version of {', '.join(changed)}; "
                "make all references again"
            )
    return metrics


def _row(
    run: RunRow,
    scores: Mapping[int, float | None],
    makers: _Table,
    scenarios: _Table,
    planners: _Table,
) -> list[Any]:
    document = run.record.document()
    if document.get("robots") or run.changes:
        raise InputError(f"{run.directory}: references are of one robot and unchanged scenarios")
    hashes = document["hashes"]
    about = {n: document[n] for n in _OF_SCENARIO if n in document}
    about |= {"spec": hashes["spec"], "realisation": hashes["realisation"]}
    maker, planner = (
        {n: document[n] for n in part if n in document} for part in (_OF_MAKER, _OF_PLANNER)
    )
    own = {**document, "density": _rounded(run.density)}
    return [
        makers.number(maker), scenarios.number(about), planners.number(planner),
        *(own[n] for n in _OWN), hashes["trajectory"].removeprefix(_HASH), dict(scores),
    ]  # fmt: skip


def _rounded(value: float | None) -> float | None:
    return None if value is None else float(f"{value:.{_DIGITS}g}")


# ------------------------------------------------------------------------- reading
def open_references(text: str) -> ReferenceScores | None:
    """Return reference scores: those that come with crowdbot, or of a file; None for a folder.

    Raises:
        InputError: the file cannot be read, or is not one of reference scores.
    """
    if text == SHIPPED:  # a folder of that name is ./crowdbot
        return read_references(shipped_file())
    return read_references(Path(text)) if text.endswith(SUFFIX) else None


def opened(text: str) -> ReferenceScores:
    """Return reference scores: those that come with crowdbot, or of a file.

    Raises:
        InputError: it is not a file of reference scores.
    """
    found = open_references(text)
    if found is None:
        raise InputError(f"{text}: a file of reference scores ends in {SUFFIX}")
    return found


def shipped_file() -> Traversable:
    """Return the file that comes with crowdbot."""
    return files("crowdbot.core.results") / NAME


def read_references(file: Traversable) -> ReferenceScores:
    """Return the content of a file.

    Raises:
        InputError: it cannot be read, or is not one of reference scores.
    """
    with _errors_of(file):
        found = _document(file)
        runs = tuple(_runs(found))
        scores = tuple(_scores(found, runs))
    return ReferenceScores(tuple(found.commands), Results(runs=runs, scores=scores))


def shipped_runs() -> tuple[RunRow, ...]:
    """Return the runs of the file that comes with crowdbot, in half the time without their scores.

    Raises:
        InputError: it cannot be read.
    """
    file = shipped_file()
    with _errors_of(file):
        return tuple(_runs(_document(file)))


def _document(file: Traversable) -> _File:
    packed = read_bytes(file, LARGEST) if isinstance(file, Path) else file.read_bytes()
    unpacker = lzma.LZMADecompressor()
    text = unpacker.decompress(packed, _UNPACKED)
    if not unpacker.eof:
        raise InputError(f"{file}: cut, or larger than {_UNPACKED // 10**6} MB")
    document = parse_json(text.decode())
    if document["references"] != _FORMAT:
        raise InputError(f"{file}: format {document['references']}; this crowdbot reads {_FORMAT}")
    return _File.model_validate(document)


@contextmanager
def _errors_of(file: Traversable) -> Iterator[None]:
    """Say of which file something is wrong, in one line."""
    try:
        yield
    except (OSError, lzma.LZMAError) as error:
        raise InputError(f"{file}: cannot be read: {reason_of(error)}") from None
    except (ValidationError, ValueError, LookupError, TypeError, AttributeError) as error:
        some = str(error).splitlines()[0][:200]
        raise InputError(f"{file} is not a file of reference scores: {some}") from None


def _runs(file: _File) -> Iterator[RunRow]:
    for maker, scenario, planner, *own, trajectory, _ in file.runs:
        about = dict(file.scenarios[scenario])
        known = {"spec": about.pop("spec"), "realisation": about.pop("realisation")}
        document = {
            **file.makers[maker], **about, **file.planners[planner], "metrics": file.metrics,
            **dict(zip(_OWN, own, strict=True)), "wall_time": 0.0, "references": {},
            "hashes": {**known, "trajectory": f"{_HASH}{trajectory}"},
        }  # fmt: skip
        document["run_id"] = RunIdentity.model_validate(
            {n: document[n] for n in RunIdentity.model_fields if n in document}
        ).id()
        record = RunRecord.parse(document, document["scenario"])
        place = f"{record.suite}/{record.scenario}/{record.planner.label}/seed-{record.seed}"
        yield RunRow(record=record, directory=place)


def _scores(file: _File, runs: Sequence[RunRow]) -> Iterator[ScoreRow]:
    for run, row in zip(runs, file.runs, strict=True):
        for column, value in zip(file.columns, row[-1], strict=True):
            yield ScoreRow(
                run_id=run.run_id, **dict(zip(_COLUMNS, column, strict=True)), value=value,
                status="ok" if value is not None else "undefined",
                reason="" if value is not None else "not known of this reference",
                lower=None, upper=None,
            )  # fmt: skip
