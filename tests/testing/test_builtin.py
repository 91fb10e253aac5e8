"""Every component that crowdbot ships passes the kit that others are held to."""

from __future__ import annotations

from collections.abc import Callable

from crowdbot.core.registry.registry import discover
from crowdbot.testing import parametrize_with_checks

BUILT_IN = [c for p in discover(allow=(), entry_points=False).plugins for c in p.components]


@parametrize_with_checks(BUILT_IN)
def test_conformance(check: Callable[[], None]) -> None:
    check()
