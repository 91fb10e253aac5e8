"""Everything that is made from the code and committed is as `make generate` writes it."""

from __future__ import annotations

import pytest

from scripts import generate


@pytest.mark.parametrize("what", generate.GENERATED)
def test_generated_files_are_current(what: str) -> None:
    assert [path.name for path, _ in generate.stale(what)] == [], "run make generate"


def test_a_stale_file_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    path = generate.ROOT / "README.md"
    monkeypatch.setitem(generate.GENERATED, "one", lambda: {path: "other"})
    assert list(generate.stale("one")) == [(path, "other")]
