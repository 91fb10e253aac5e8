"""crowdbot: a benchmark for robots that drive through dense human crowds.

Names below are imported when they are first used, so that ``import crowdbot`` stays cheap.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from crowdbot.api import evaluate, expand, load, results, score, simulate
    from crowdbot.core.commands import Commands
    from crowdbot.core.evaluate import Scores
    from crowdbot.core.questionnaires import Questionnaires
    from crowdbot.core.score import Score
    from crowdbot.core.sim.request import Run
    from crowdbot.core.trajectory import Trajectories
    from crowdbot.dsl.expand import Expansion as Suite
    from crowdbot.dsl.scenario import Scenario
    from crowdbot.errors import CrowdbotError

_HOMES = {
    "Commands": "crowdbot.core.commands",
    "CrowdbotError": "crowdbot.errors",
    "Questionnaires": "crowdbot.core.questionnaires",
    "Run": "crowdbot.core.sim.request",
    "Scenario": "crowdbot.dsl.scenario",
    "Score": "crowdbot.core.score",
    "Scores": "crowdbot.core.evaluate",
    "Suite": "crowdbot.dsl.expand:Expansion",
    "Trajectories": "crowdbot.core.trajectory",
    "evaluate": "crowdbot.api",
    "expand": "crowdbot.api",
    "load": "crowdbot.api",
    "results": "crowdbot.api",
    "score": "crowdbot.api",
    "simulate": "crowdbot.api",
}

__all__ = [
    "Commands",
    "CrowdbotError",
    "Questionnaires",
    "Run",
    "Scenario",
    "Score",
    "Scores",
    "Suite",
    "Trajectories",
    "evaluate",
    "expand",
    "load",
    "results",
    "score",
    "simulate",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'crowdbot' has no attribute '{name}'")
    module, _, attribute = _HOMES[name].partition(":")
    return getattr(importlib.import_module(module), attribute or name)


def __dir__() -> list[str]:
    return sorted(__all__)
