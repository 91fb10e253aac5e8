"""A run has a largest number of signals."""

from __future__ import annotations

import pytest

from crowdbot.core.planning import planner
from crowdbot.core.planning.planner import SignalBounds
from crowdbot.errors import PlannerError


def test_names_and_values_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(planner, "_MOST_SIGNALS", 3)
    bounds = SignalBounds(most=5)
    for name in ("a", "b", "c", "a", "b"):
        bounds.check(name)
    with pytest.raises(PlannerError, match="more than 5 values"):
        bounds.check("a")
    with pytest.raises(PlannerError, match="more than 3 names"):
        bounds.check("d")
