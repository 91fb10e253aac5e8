"""Writes the Drake diagram of a run as diagram.dot; `dot -Tsvg diagram.dot` draws it."""

from contextlib import suppress
from pathlib import Path
from typing import Any
from unittest import mock

import crowdbot
from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.sim import record
from crowdbot.core.sim.diagram import Blocks
from crowdbot.core.sim.runner import run
from crowdbot.errors import Interrupted


def draw(blocks: Blocks, *given: Any, **options: Any) -> Outcome:
    """Draw the finished diagram, then go on as usual."""
    text = blocks.diagram.GetGraphvizString(max_depth=1)
    Path("diagram.dot").write_text(text, encoding="utf-8")
    return run(blocks, *given, **options)


scenario = crowdbot.load("challenge-2020", "counter-d0250-dispersed-c20-r05")
assert isinstance(scenario, crowdbot.Scenario)
with mock.patch.object(record, "run", draw), suppress(Interrupted):
    crowdbot.simulate(scenario, planner="goal_seek", references=False, stop=lambda: True)
