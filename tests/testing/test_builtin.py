"""Every component that crowdbot ships passes the kit that others are held to."""

from __future__ import annotations

from dataclasses import replace
from typing import Any
from unittest import SkipTest

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.dsl.spec.component import Component
from crowdbot.testing import checks_for, metric
from tests.examples import THOROUGH

BUILT_IN = [c for p in discover(allow=(), entry_points=False).plugins for c in p.components]


@pytest.fixture(autouse=True)
def _fewer_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Metrics are tried on four random runs instead of ten, except in `make test-all`."""
    if not THOROUGH:
        monkeypatch.setattr(metric, "_SEEDS", range(4))


# One test per component: with one per check, as authors have it, pytest took as long as the checks.
@pytest.mark.parametrize("component", BUILT_IN, ids=lambda component: component.kind)
def test_conformance(component: Component[Any]) -> None:
    failed, skipped = [], []
    for name, check in checks_for(component):
        try:
            check()
        except SkipTest as reason:
            skipped.append(str(reason))
        except Exception as error:
            error.add_note(f"check of {component.kind}: {name}")
            failed.append(error)
    if failed:
        raise ExceptionGroup(component.kind, failed)
    if skipped:
        pytest.skip("; ".join(dict.fromkeys(skipped)))


def test_a_check_that_fails_is_named() -> None:
    broken = replace(BUILT_IN[0], summary="two\nlines")
    with pytest.raises(ExceptionGroup) as found:
        test_conformance(broken)
    notes = [note for failed in found.value.exceptions for note in failed.__notes__]
    assert f"check of {broken.kind}: check_summary_is_a_line" in notes
