"""A report begins with one plain verdict and the main scores."""

from __future__ import annotations

from crowdbot.core.report.contents import Contents
from crowdbot.core.report.lead import main_columns, verdict
from crowdbot.core.report.page import render
from tests.core.report.report_cases import AXES, DRAWN, campaign, contents
from tests.core.report.test_page import METRICS, Page

CROWDS = {name: AXES[name] for name in DRAWN}


def of(planners: dict[str, float], **more: object) -> Contents:
    axes = {"density": AXES["density"]} if more.pop("few", False) else CROWDS
    return contents(campaign(planners, axes=axes, metrics=METRICS, failures=0))


def told(report: Contents, *, useless: bool = False) -> str:
    return verdict(report.figures.headline, report.sample, useless=useless)


def test_the_better_planner_is_named() -> None:
    role = main_columns(of({"a": 0.0, "b": -5.0}).figures.headline)[0].role
    assert told(of({"a": 0.0, "b": -5.0})) == f"a is better than b in {role}."
    assert told(of({"a": -5.0, "b": 0.0})) == f"b is better than a in {role}."


def test_equal_planners_are_not_told_apart() -> None:
    assert told(of({"a": 0.0, "b": 0.0})).endswith("beyond chance between a and b.")


def test_without_grounds_there_is_no_verdict() -> None:
    assert told(of({"a": 0.0})).startswith("Only a has runs")
    assert "needs at least 8" in told(of({"a": 0.0, "b": -5.0}, few=True))
    assert told(of({"a": 0.0, "b": -5.0}), useless=True).startswith("No verdict: this suite")


def test_verdict_and_scores_stand_before_notes_and_tables() -> None:
    report = of({"a": 0.0, "b": -5.0})
    words = " ".join(Page(render(report)).words.split())
    column = main_columns(report.figures.headline)[0]
    places = [
        words.find(part) for part in (told(report), f"{column.role} ", "Notes", "how the runs")
    ]
    assert -1 not in places
    assert places == sorted(places)
