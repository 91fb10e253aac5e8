"""A suite's round: dates, order, and messages with positions."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.suite.round import Round
from crowdbot.errors import SpecError

SUITE = """\
crowdbot: 1
extends: builtin:challenge-2020.yaml
suite: {id: rounds}
only: {flow: in, density: d0125, coeff: c01, range: r02}
"""


def opened(folder: Path, lines: str) -> Round | None:
    path = folder / "suite.yaml"
    path.write_text(SUITE + lines)
    return open_spec(str(path), discover(allow=())).round


def test_a_day_lasts_until_its_end() -> None:
    held = Round(opens="2027-01-10", closes="2027-03-31")
    assert held.problem(datetime(2027, 1, 9, 23, 59, tzinfo=UTC)) == "the round opens on 2027-01-10"
    assert held.problem(datetime(2027, 1, 10, tzinfo=UTC)) == ""
    assert held.problem(datetime(2027, 3, 31, 23, 59, 59, tzinfo=UTC)) == ""
    assert held.problem(datetime(2027, 4, 1, tzinfo=UTC)) == "the round closed on 2027-03-31"


def test_a_moment_has_a_time_zone() -> None:
    held = Round(closes="2027-03-31T12:00+02:00")
    assert held.problem(datetime(2027, 3, 31, 10, 0, tzinfo=UTC)) == ""
    assert held.problem(datetime(2027, 3, 31, 10, 1, tzinfo=UTC))


def test_it_is_read_and_changes_no_hash(tmp_path: Path) -> None:
    registry = discover(allow=())
    path = tmp_path / "suite.yaml"
    path.write_text(SUITE)
    before = open_spec(str(path), registry)
    held = opened(tmp_path, "round: {closes: 2027-03-31, planners: sealed, contact: us}\n")
    assert before.round is None
    assert held is not None
    assert held.text == "closes 2027-03-31, sealed planners only, contact: us"
    assert open_spec(str(path), registry).scenarios == before.scenarios


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("round: {opens: 2027-02-01, closes: 2027-01-01}", "a round must close after it opens"),
        ("round: {closes: soon}", "write a day such as 2027-01-31"),
        ("round: {closes: 2027-01-31T12:00}", "write a day such as 2027-01-31"),
        ("round: {planners: glued}", "planners"),
        ("round: {contakt: us}", "did you mean 'contact'?"),
    ],
)
def test_a_wrong_one_is_told_with_its_place(tmp_path: Path, line: str, says: str) -> None:
    with pytest.raises(SpecError) as caught:
        opened(tmp_path, line + "\n")
    text = str(caught.value)
    assert "suite.yaml:5:" in text
    assert says in text
