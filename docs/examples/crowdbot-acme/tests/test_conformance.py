"""Everything in this package keeps to what crowdbot promises about it."""

from __future__ import annotations

from collections.abc import Callable

from crowdbot.testing import parametrize_with_checks

from crowdbot_acme import COMPONENTS


@parametrize_with_checks(COMPONENTS)
def test_conformance(check: Callable[[], None]) -> None:
    check()
