"""Lines of ``crowdbot audit --adversaries``."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from crowdbot.cli.output.adversary_lines import adversary_lines, adversary_text
from crowdbot.core.results.results import Results
from crowdbot.errors import InputError
from tests.core.results.made_up_record import changed
from tests.core.statistics.made_up_results import pairs

VALUES = np.random.default_rng(5).uniform(0.4, 0.6, size=20)


def results(gain: float) -> Results:
    """Planner a is an adversary, b a baseline."""
    found = pairs((VALUES + gain).tolist(), VALUES.tolist(), metric="safe_efficiency")
    roles = {"a": "adversary", "b": "baseline"}
    return replace(found, runs=tuple(changed(r, role=roles[r.planner]) for r in found.runs))


@pytest.mark.parametrize(("gain", "standing"), [(0.1, "ahead"), (-0.1, "behind")])
def test_the_standing_of_an_adversary(gain: float, standing: str) -> None:
    lines = adversary_lines(results(gain), ())
    assert [(x["adversary"], x["careful"], x["standing"]) for x in lines] == [("a", "b", standing)]
    assert lines[0]["efficiency"]["difference"] == pytest.approx(gain)
    text = adversary_text(lines)
    assert ("ahead: a of b" in text) is (standing == "ahead")


def test_without_an_adversary_or_a_careful_planner() -> None:
    found = results(0.1)
    for role, missing in (("baseline", "adversary"), ("adversary", "careful planner")):
        runs = tuple(changed(r, role=role) for r in found.runs)
        with pytest.raises(InputError, match=f"no {missing} was run"):
            adversary_lines(replace(found, runs=runs), ())
