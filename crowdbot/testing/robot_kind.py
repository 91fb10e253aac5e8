from __future__ import annotations

from collections.abc import Callable

CHECKS: tuple[Callable[..., None], ...] = ()
