"""Waiting for other processes: for what happens, not for a time."""

from __future__ import annotations

import time
from collections.abc import Callable

#: Far more than anything takes, on a machine that compiles and is busy with other things, s.
AT_MOST = 300.0


def wait_until(happened: Callable[[], object], at_most: float = AT_MOST) -> None:
    """Return as soon as ``happened()`` is true.

    Raises:
        AssertionError: it never was.
    """
    end = time.monotonic() + at_most
    while not happened():
        assert time.monotonic() < end, f"nothing happened within {at_most:g} s"
        time.sleep(0.02)
