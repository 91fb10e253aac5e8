"""What a report says before anything else: floors, and suites that tell nothing."""

from __future__ import annotations

from dataclasses import replace

import pytest

from crowdbot.core.report.markdown import markdown
from crowdbot.core.report.page import render
from crowdbot.core.results.results import Results
from crowdbot.core.statistics.audit import Audit, audit
from crowdbot.core.statistics.crowds import CrowdOrder, CrowdRanks
from tests.core.report.report_cases import AXES, DRAWN, campaign, contents
from tests.core.report.test_page import EVIL, METRICS, Page
from tests.core.results.made_up_record import changed

CROWDS = {name: AXES[name] for name in DRAWN}


def with_floor(skill: float, name: str = "straight_on") -> Results:
    """dwa, and a floor of some skill, in 18 scenarios with a crowd each."""
    found = campaign({"dwa": 0.0, name: skill}, axes=CROWDS, metrics=METRICS, failures=0)
    roles = {"dwa": "baseline", name: "floor"}
    return replace(found, runs=tuple(changed(r, role=roles[r.planner]) for r in found.runs))


def position(text: str, *parts: str) -> list[int]:
    found = [text.find(part) for part in parts]
    assert -1 not in found
    return found


def test_a_planner_that_beats_the_floors_is_told_before_any_table() -> None:
    report = contents(with_floor(-5.0))
    text = markdown(report)
    first, table = position(text, "dwa beats the floors in success: +", "| planner |")
    assert first < table
    assert "**dwa" not in text
    words = " ".join(Page(render(report)).words.split())
    first, table = position(words, "beats the floors in success", "how the runs ended")
    assert first < table


def test_one_that_does_not_is_told_in_bold() -> None:
    report = contents(with_floor(0.0))
    assert "**dwa does not beat the floors in success: " in markdown(report)
    page = Page(render(report))
    marked = [a for t, a in page.tags if t == "p" and "floors" in (a.get("class") or "")]
    assert [a["class"] for a in marked] == ["notice floors accepted"]


def test_without_floors_it_says_that_nothing_is_known() -> None:
    found = campaign({"dwa": 0.0, "other": 0.0}, axes=CROWDS, metrics=METRICS, failures=0)
    text = markdown(contents(found))
    assert text.count("no floor planner ran") == 2


def test_roles_are_tags() -> None:
    words = Page(render(contents(with_floor(-5.0)))).words.split()
    assert {"floor", "baseline"} <= set(words)


def test_names_of_planners_stay_text() -> None:
    report = contents(with_floor(0.0, EVIL))
    tags = [tag for tag, _ in Page(render(report)).tags]
    assert tags.count("script") == [t for t, _ in Page(render(contents(with_floor(0.0)))).tags
                                    ].count("script")  # fmt: skip
    assert "<script>" not in markdown(report)


@pytest.fixture
def useless() -> Audit:
    return audit(with_floor(0.0))


def test_a_suite_that_cannot_tell_is_labelled_first(useless: Audit) -> None:
    assert not useless.tells_apart
    report = contents(with_floor(0.0), audit=useless)
    text = markdown(report)
    label, floors = position(text, "cannot tell floors from baselines", "does not beat the floors")
    assert label < floors
    assert "This suite cannot distinguish planners." in Page(render(report)).words


def test_one_that_can_is_not() -> None:
    good = audit(with_floor(-5.0))
    assert good.tells_apart
    assert contents(with_floor(-5.0), audit=good).suspicion == ""


def test_another_version_of_the_suite_has_to_be_audited_again(useless: Audit) -> None:
    results = with_floor(-5.0)
    others = tuple(changed(r, spec_hash=f"new-{r.spec_hash}") for r in results.runs)
    report = contents(replace(results, runs=others), audit=useless)
    assert "audit it again" in report.suspicion


def test_how_alike_the_orders_of_crowds_are_is_a_table_with_a_cell_for_each_two() -> None:
    found = campaign({"dwa": 0.0, "other": 0.5}, axes=CROWDS, metrics=METRICS, failures=0)
    names = ("a", "b", "c")
    ranks = CrowdRanks(
        metric="success",
        orders=tuple(CrowdOrder(crowd=n, realism=None, means={}, pairs=3) for n in names),
        taus={("a", "b"): 0.25, ("a", "c"): -1.0, ("b", "c"): 0.5},
        verdicts=(),
    )
    page = Page(render(replace(contents(found), ranks=ranks)))
    assert "reversedcrowdbca+0.25-1.00b+0.50" in "".join(page.words.split())
