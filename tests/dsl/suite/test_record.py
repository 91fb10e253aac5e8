"""A document says what `crowdbot simulate` records where it is not told."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.errors import SpecError

REGISTRY = discover(allow=())
DOCUMENT = """\
crowdbot: 1
scenario:
  id: x
  environment: {kind: floor, area: {x: [0 m, 9 m], y: [0 m, 9 m]}}
"""


def _record(tmp_path: Path, text: str) -> str | None:
    file = tmp_path / "x.yaml"
    file.write_text(DOCUMENT + text, encoding="utf-8")
    return open_spec(str(file), REGISTRY).record


def test_record(tmp_path: Path) -> None:
    assert _record(tmp_path, "") is None
    assert _record(tmp_path, "record: none\n") == "none"
    with pytest.raises(SpecError, match="record") as caught:
        _record(tmp_path, "record: everything\n")
    assert caught.value.diagnostics[0].code == "E113"


@pytest.mark.parametrize(
    ("suite", "record"),
    [("challenge-2020", "all"), ("challenge-2020-robots", "all"), ("challenge-2026", None)],
)
def test_the_suites(suite: str, record: str | None) -> None:
    assert open_spec(suite, REGISTRY).record == record
