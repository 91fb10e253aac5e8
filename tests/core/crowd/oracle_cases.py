"""Excerpts of the original engine's trajectories, and cost functions ready to use."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

import numpy as np

from crowdbot.core.crowd.build import build_cost
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.plugin import CostFunctionSpec
from scripts.crowd_oracle.case import Case, case_of
from tests.core.crowd.crowd_reference import agents_of
from tests.paths import DATA

FOLDER = DATA / "oracle"
NAMES = sorted(p.stem for p in FOLDER.glob("*.npz"))


@cache
def _registry() -> Registry:
    return discover()


def compiled(spec: CostFunctionSpec) -> Any:
    """The compiled form of one cost function."""
    return build_cost(_registry(), spec)


def load(name: str) -> Case:
    """An excerpt by name: successive steps of one case."""
    with np.load(FOLDER / f"{name}.npz") as data:
        state, ids = np.asarray(data["state"]), np.asarray(data["id"])
        given = json.loads(str(data["settings"]))
    times = np.repeat(np.arange(len(state)), len(ids))
    rows = state.reshape(-1, 4)
    return case_of(name, given, [times, np.tile(ids, len(state)), *rows.T])


__all__ = ["NAMES", "agents_of", "compiled", "load"]
