"""What a sealed planner may not ask for: files that were not sealed with it, and the network."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from crowdbot.core.planning.choice import PlannerPlace
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.errors import InputError
from tests.core.planning.process.process_cases import REGISTRY, planner_text

PYTHON = f"python: {sys.executable}\nplanner: mine.py:Mine\n"
NOT_ITS_OWN = "a sealed planner declares '.*', which is not one of its own files"
NETWORK = "a sealed planner asks for the network"
CASES = {
    "data": ("'../secret.txt'", "", NOT_ITS_OWN),
    "computed_data": ("tuple(['..' + '/secret.txt'])", "", NOT_ITS_OWN),
    "libraries": ("()", PYTHON + "libraries: [..]\n", NOT_ITS_OWN),
    "data_of_a_document": ("'../secret.txt'", PYTHON, NOT_ITS_OWN),
    "network": ("()", PYTHON + "network: true\n", NETWORK),
    "half": (
        "()",
        f"kind: safety_stop\nautonomy: {{python: {sys.executable}, planner: 'mine.py:Mine', "
        "network: true}\n",
        NETWORK,
    ),
}


def _sealed(folder: Path, data: str, document: str) -> tuple[str, Path]:
    """Write a planner beside a secret; return the planner and its folder."""
    (folder / "secret.txt").write_text("another planner")
    own = folder / "own"
    own.mkdir()
    text = planner_text().replace("class Mine:", f"class Mine:\n    data = {data}")
    (own / "mine.py").write_text(text)
    (own / "mine.yaml").write_text(document)
    return (str(own / "mine.yaml") if document else f"{own / 'mine.py'}:Mine"), own


@pytest.mark.parametrize("case", CASES)
def test_it_may_not_declare_what_is_not_its_own(case: str, tmp_path: Path) -> None:
    data, document, why = CASES[case]
    planner, own = _sealed(tmp_path, data, document)
    with pytest.raises(InputError, match=why):
        resolve_planner(planner, REGISTRY, place=PlannerPlace(sealed=own))
    assert resolve_planner(planner, REGISTRY, place=PlannerPlace()).name


def test_its_own_files_are_fine(tmp_path: Path) -> None:
    planner, own = _sealed(tmp_path, "'mine.yaml'", "")
    assert resolve_planner(planner, REGISTRY, place=PlannerPlace(sealed=own)).name == "Mine"
