"""Provenance: hashes of a run's inputs and results, and its machine."""

from __future__ import annotations

import hashlib
import os
import platform
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from crowdbot.core.planning.choice import IN_PROCESS
from crowdbot.core.registry.plugin import BUILTIN
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs.record_parts import RecordPart
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.support.float_fingerprint import fingerprint
from crowdbot.core.support.json_digest import digest
from crowdbot.core.trajectories.trajectories import Trajectories

_PACKAGES = ("crowdbot", "drake", "mcap", "numba", "numpy", "pydantic", "rosbags")


def recording_hashes(identity: RecordPart) -> dict[str, str]:
    """Return the hashes in the header of a recording that identify its run and planner.

    Args:
        identity: of the run, or of the calibration run.
    """
    document = identity.identity()
    found = {"run": identity.id()}
    return found | ({"planner": digest(document["planner"])} if "planner" in document else {})


def trajectory_hash(run: Trajectories) -> str:
    """Return the hash of every simulated number of a run, without wall times.

    Two runs with equal hashes agree bit by bit.
    """
    sha = hashlib.sha256()
    for name in ("t", "robot", "agents", "trips", "contacts", "signals"):
        _feed(sha, name, getattr(run, name))
    return f"cb1-sha256:{sha.hexdigest()}"


def _feed(sha: Any, name: str, value: Any) -> None:
    sha.update(name.encode() + b"\0")
    if is_dataclass(value):
        for part in fields(value):
            _feed(sha, part.name, getattr(value, part.name))
    elif isinstance(value, np.ndarray):
        sha.update(repr((value.dtype.str, value.shape)).encode())
        sha.update(np.ascontiguousarray(value).data)
    elif isinstance(value, Mapping):
        for key in sorted(value):
            _feed(sha, key, value[key])
    else:
        sha.update(repr(value).encode())


def versions() -> dict[str, str]:
    """Return the versions of crowdbot and of libraries that affect its numbers."""
    return dict(_versions())


@cache
def _versions() -> tuple[tuple[str, str], ...]:
    packages = ((p, metadata.version(p)) for p in _PACKAGES)
    return ("python", platform.python_version()), *packages


def plugins(registry: Registry) -> list[dict[str, Any]]:
    """Return the loaded plugins, with file hashes for those that are not pinned.

    A plugin given by path is named by its last part, so that a run's identity does not depend on
    the path.
    """
    return [
        {
            "name": p.name,
            "distribution": Path(p.distribution).resolve().name if p.given else p.distribution,
            "pinned": p.pinned,
            **({} if p.pinned else {"sha256": p.sha256}),
            **({"data": p.data} if p.name != BUILTIN and p.data else {}),
        }
        for p in registry.plugins
        if not p.error
    ]


def third_parties(registry: Registry) -> dict[str, Any]:
    """Return everything besides crowdbot that affects a reference run; empty without plugins."""
    others = [p for p in plugins(registry) if p["name"] != BUILTIN]
    return {"plugins": others} if others else {}


def remarks(record: RunRecord) -> dict[str, str]:
    """Return warnings about the origin of scores that a reader must know, title -> text."""
    found = {}
    if record.by_person:
        found["Driven by a person"] = "the run cannot be repeated, and ranks beside no planner"
    if record.privileged:
        found["Privileged"] = "the planner sees the truth"
    if runs_inside(record):
        found["In process"] = "the planner ran inside the simulator, where nothing contains it"
    if record.uncontained and record.planner_contained is not None:
        found["Not contained"] = f"nothing kept the planner from: {record.uncontained}"
    if not record.pinned:
        loose = [plugin.distribution for plugin in record.plugins if not plugin.pinned]
        if record.planner.sha256:
            loose.append(record.planner.kind)
        found["Not pinned"] = f"{', '.join(loose)}: not from an installed distribution"
    return found


def runs_inside(record: RunRecord) -> bool:
    """Return True if a planner that is not crowdbot's own ran inside the simulator.

    Runs from before planners had processes do not say where theirs ran.
    """
    if record.planner_process != IN_PROCESS or "planner_process" not in record.model_fields_set:
        return False
    return bool(record.planner.sha256) or "." in record.planner.kind


def machine() -> dict[str, str]:
    """Describe the machine of the run.

    ``processor`` is the target of compiled code; machines with equal ``processor`` and ``rounding``
    give equal trajectories.
    """
    return {
        "system": platform.system(),
        "machine": platform.machine(),
        "processor": _processor(),
        "rounding": fingerprint(),
    }


def _processor() -> str:
    from llvmlite import binding  # type: ignore[import-untyped]

    return os.environ.get("NUMBA_CPU_NAME") or str(binding.get_host_cpu_name())
