"""The page of threats promises nothing that no test shows."""

from __future__ import annotations

import re

import pytest

from tests.paths import ROOT, TESTS

PAGE = (ROOT / "docs" / "developers" / "threats.md").read_text(encoding="utf-8")
ROWS = [
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in PAGE.splitlines()
    if line.startswith("|") and line.count("|") == 6 and not line.startswith(("|---", "| threat"))
]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0][:40])
def test_what_contains_a_threat_is_shown_by_a_test(row: list[str]) -> None:
    _, contained, where, left, test = row
    assert bool(contained) == bool(where) == bool(test)
    assert contained or left
    if test:
        found = re.fullmatch(r"`([a-z_/0-9]+\.py)::(test_\w+)`", test)
        assert found, test
        text = (TESTS / found[1]).read_text(encoding="utf-8")
        assert f"def {found[2]}(" in text, test


def test_the_page_has_its_tables() -> None:
    assert len(ROWS) > 40
