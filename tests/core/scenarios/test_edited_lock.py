"""A lock that somebody edited is refused where its people are needed, and at validate."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from crowdbot import cli
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.scenarios.lock import population
from crowdbot.errors import InputError
from tests.core.bundle.made_up_runs import registry, write_suite


def realisation(lock: Any) -> None:
    next(iter(lock["scenarios"].values()))["realisation"] = "cb1-sha256:forged"


def draw(lock: Any) -> None:
    first = next(iter(lock["scenarios"].values()))
    first["draw"] = next(n for n in lock["draws"] if n != first["draw"])


def inputs(lock: Any) -> None:
    for table in lock["draws"].values():
        table["inputs"] = "cb1-sha256:other"


@pytest.mark.slow
@pytest.mark.parametrize("edit", [realisation, draw, inputs])
def test_an_edited_lock_is_refused(tmp_path: Path, edit: Callable[[Any], None]) -> None:
    suite = write_suite(tmp_path)
    lock = tmp_path / "tiny.lock.json"
    first = open_spec(str(suite), registry()).scenarios[0]
    assert population(first, registry()).source == "locked"
    document = json.loads(lock.read_text())
    edit(document)
    lock.write_text(json.dumps(document))
    first = open_spec(str(suite), registry()).scenarios[0]
    with pytest.raises(InputError, match=f"the realisation of {first.id} is .* was edited"):
        population(first, registry())
    changed = open_spec(str(suite), registry(), ["crowd.speed.mean=1.1 m/s"]).scenarios[0]
    assert population(changed, registry()).source == "drawn"


@pytest.mark.parametrize("content", [b"", b"garbage", b"[]", b'{"lock": 1}', b"\xff\xfe"])
def test_garbage_is_found_at_validate(
    tmp_path: Path, content: bytes, capsys: pytest.CaptureFixture[str]
) -> None:
    suite = tmp_path / "s.yaml"
    suite.write_text(
        'crowdbot: 1\nsuite: {id: s}\nbase:\n  extends: ["builtin:parts/corridor_50x10.yaml"]\n'
    )
    assert cli.main(["validate", str(suite)]) == 0
    (tmp_path / "s.lock.json").write_bytes(content)
    assert cli.main(["validate", str(suite)]) == 1
    assert "s.lock.json:1:1: error[E001] s.lock.json is not" in capsys.readouterr().err
