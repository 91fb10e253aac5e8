"""One side of a comparison: a scenario or a run."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs.run_directory import RECORD, SCENARIO, SCORES
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.scenarios.library import open_spec, pick, suite_names
from crowdbot.core.support.text_files import read_text
from crowdbot.dsl.identity.canonical import canonical_bytes, content_hash
from crowdbot.errors import InputError

#: Entries of a record in which equal runs may differ.
_PASSING = (
    "cpu_time", "files", "machine", "planner_step_time", "real_time_factor", "references",
    "wall_time",
)  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class DiffSide:
    """Scenario and run on one side of a comparison.

    Attributes:
        name: readable name.
        scenario: canonical form.
        hash: content hash of the scenario.
        run: ``run.json`` without entries that may differ; None for a scenario.
        scores: ``metric.variant`` -> value, unit and status; empty for a scenario.
    """

    name: str
    scenario: dict[str, Any]
    hash: str
    run: dict[str, Any] | None = None
    scores: dict[str, Any] = field(default_factory=dict)


def read_diff_side(text: str, registry: Registry, overrides: Sequence[str] = ()) -> DiffSide:
    """Read one side of a comparison.

    Args:
        text: a run directory; ``SPEC/ID`` or ``SPEC#ID``, SPEC a packaged suite or a file; or a
            document with a single scenario.
        registry: the installed components.
        overrides: ``key=value`` texts that override the scenario.

    Raises:
        InputError: it is none of these, or its contents are invalid.
    """
    folder = Path(text)
    if folder.is_dir():
        return _run(folder, registry, overrides)
    spec, scenario_id = _split(text, registry)
    return _scenario(text, spec, scenario_id, registry, overrides)


def _split(text: str, registry: Registry) -> tuple[str, str | None]:
    """Split into document and id. A file may have any name, so ``#`` is tried last."""
    if Path(text).is_file():
        return text, None
    if "#" in text:
        spec, _, scenario_id = text.rpartition("#")
        return spec, scenario_id
    spec, slash, scenario_id = text.partition("/")
    if slash and spec in suite_names(registry) and not text.endswith((".yaml", ".yml")):
        return spec, scenario_id
    return text, None


def _scenario(
    name: str, spec: str, scenario_id: str | None, registry: Registry, overrides: Sequence[str]
) -> DiffSide:
    scenario = pick(open_spec(spec, registry, overrides), scenario_id)
    kinds = registry.spec_versions(scenario)
    content = json.loads(canonical_bytes(scenario, kinds))
    return DiffSide(name=name, scenario=content, hash=content_hash(scenario, kinds))


def _run(folder: Path, registry: Registry, overrides: Sequence[str]) -> DiffSide:
    record = RunRecord.find(folder)
    if record is None:
        raise InputError(f"{folder}: no run directory, there is no readable {RECORD} in it")
    if overrides:
        raise InputError(f"{folder}: --set changes a scenario, not a run")
    found = _scenario(str(folder), str(folder / SCENARIO), None, registry, ())
    kept = {k: v for k, v in record.document().items() if k not in _PASSING}
    return DiffSide(
        name=str(folder), scenario=found.scenario, hash=found.hash, run=kept,
        scores=_scores(folder / SCORES),
    )  # fmt: skip


def _scores(path: Path) -> dict[str, Any]:
    try:
        with io.StringIO(read_text(path), newline="") as file:
            rows = list(csv.DictReader(file))
        return {
            f"{row['metric']}.{row['variant']}": {
                "value": float(row["value"]) if row["value"] else None,
                **{key: row[key] for key in ("unit", "status", "reason")},
            }
            for row in rows
        }
    except (OSError, ValueError, KeyError, csv.Error) as error:
        raise InputError(f"{path}: no table of scores ({error})") from error
