"""The paragraph for a paper has the report's own numbers."""

from __future__ import annotations

import re

from crowdbot.core.report.methods import methods
from tests.core.report.report_cases import campaign, contents
from tests.core.report.test_page import small


def test_its_numbers_are_those_of_the_report() -> None:
    report = contents(small(seeds=3), accepted=("rates: 16 Hz, 20 Hz.",))
    text = methods(report)
    counts = report.counts()
    assert "dwa, orca_lookahead and straight_on in 8 scenarios" in text
    assert "seeds 0 to 2" in text
    assert f"{sum(counts.values())} runs in all" in text
    assert f"arrived in {counts['arrived']} of them" in text
    assert f"{counts['failed']} could not be made" in text
    assert f"over the {report.figures.headline.tests} tests" in text
    assert "rates: 16 Hz, 20 Hz." in text
    assert ".." not in text
    assert "crowdbot 0.1.0" in text
    assert re.search(r"With 2 crowd draws no verdict was possible|With \d+ crowd draws", text)


def test_one_planner_is_compared_with_nobody() -> None:
    text = methods(contents(campaign({"dwa": 0.0}, axes={"density": ("d0125",)}, failures=0)))
    assert "Wilcoxon" not in text
    assert "We simulated dwa in 1 scenario " in text
