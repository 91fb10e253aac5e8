"""Everything in this package keeps to what crowdbot promises about it."""

from __future__ import annotations

from collections.abc import Callable

from crowdbot.testing import components_of, parametrize_with_checks


@parametrize_with_checks(components_of("acme"))
def test_conformance(check: Callable[[], None]) -> None:
    check()
