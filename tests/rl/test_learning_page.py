"""The page on learning names all observations and rewards."""

from __future__ import annotations

import re

import pytest

from crowdbot.api import registry
from tests.paths import ROOT

PAGE = (ROOT / "docs" / "reference" / "learning.md").read_text()


@pytest.mark.parametrize(("category", "heading"), [("observation", "## Observations"),
                                                   ("reward", "## Rewards")])  # fmt: skip
def test_each_kind_has_its_section(category: str, heading: str) -> None:
    section = PAGE.split(f"\n{heading}\n")[1].split("\n## ")[0]
    ours = {k for k in registry().components(category) if "." not in k}
    assert set(re.findall(r"^### (\w+)$", section, re.MULTILINE)) == ours
