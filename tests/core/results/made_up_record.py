"""Records and rows of runs that never were."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from crowdbot.core.results.rows import RunRow
from crowdbot.core.runs.run_record import RunRecord

_HASHES = {f"{name}_hash": name for name in ("spec", "realisation", "trajectory")}


def made_up_record(**values: Any) -> RunRecord:
    """A valid record.

    Args:
        values: keys of ``run.json``; ``planner`` may be a label, ``spec_hash`` and the like are
            put among the hashes.
    """
    document: dict[str, Any] = {
        "run_id": "r", "suite": "suite", "scenario": "s0", "planner": {}, "seed": 0,
        "hashes": {"spec": "s", "realisation": "d0", "trajectory": "t"}, "versions": {},
        "plugins": [], "pinned": True, "privileged": False, "status": "arrived", "reason": "",
        "goal_time": 1.0, "sim_time": 1.0, "wall_time": 1.0, "metrics": {}, "references": {},
        "machine": {}, "density": 0.1, "axes": {}, "conditions": {},
    }  # fmt: skip
    return RunRecord.model_validate(_laid_over(document, values))


def changed(row: RunRow, **values: Any) -> RunRow:
    """A row with other values in its record."""
    record = _laid_over(row.record.document(), values)
    return replace(row, record=RunRecord.model_validate(record))


def _laid_over(document: dict[str, Any], values: dict[str, Any]) -> dict[str, Any]:
    found, hashes = dict(document), dict(document["hashes"])
    for name, value in values.items():
        if name in _HASHES:
            hashes[_HASHES[name]] = value
        elif name == "hashes":
            hashes |= value
        else:
            found[name] = str(value) if name == "status" else value
    planner = found["planner"]
    given = {"label": planner} if isinstance(planner, str) else planner
    label = given.get("label", "a")
    plugin = {"name": "plugin", "distribution": "plugin 1", "pinned": True}
    return {
        **found,
        "hashes": hashes,
        "planner": {"kind": label, "name": label, "label": label, **given},
        "plugins": [{**plugin, **one} for one in found["plugins"]],
    }
