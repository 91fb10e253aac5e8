"""The glossary has every term that code and documents must share."""

from __future__ import annotations

import re

import pytest

from crowdbot.dsl.spec.component_specs import CATEGORIES
from tests.docs.doc_pages import links, read, section
from tests.paths import ROOT

PAGE = "developers/glossary.md"
TEXT = read(PAGE)
ROWS = [line for line in TEXT.splitlines() if re.match(r"\| (?!term |folder |---)", line)]
FOLDERS = sorted(
    p.name for p in (ROOT / "crowdbot/core").glob("*/") if (p / "__init__.py").exists()
)


def _terms() -> list[str]:
    return re.findall(r"^\| \[([^\]]+)\]\(", TEXT, re.M)


@pytest.mark.parametrize("category", [c.category for c in CATEGORIES])
def test_every_category_of_component_is_there(category: str) -> None:
    listed = section(TEXT, "## Plugins")
    (row,) = (line for line in listed.splitlines() if line.startswith("| [category]"))
    assert category in row
    assert any(category in term for term in _terms()), category


def test_every_folder_of_core_is_there_and_no_other() -> None:
    listed = re.findall(r"^\| `(\w+)` \|", section(TEXT, "## Folders of `crowdbot.core`"), re.M)
    assert sorted(listed) == FOLDERS


def test_every_term_is_there_once_and_linked() -> None:
    assert len(set(_terms())) == len(_terms()) == len(ROWS) - len(FOLDERS)
    assert len(_terms()) > 90


def test_every_term_has_one_line() -> None:
    for row in ROWS:
        assert row.count("|") == 3, row
        assert len(row.split("|")[2]) < 140, row


def test_links_lead_to_pages_of_ours() -> None:
    assert [link for link in links(ROOT / "docs" / PAGE) if ":" in link] == []
