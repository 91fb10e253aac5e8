"""crowdbot: a benchmark for robots that drive through dense human crowds.

Names below are imported when they are first used, so that ``import crowdbot`` stays cheap.
"""

from __future__ import annotations

from crowdbot.lazy import lazy_names, stub_names

_NAMES = stub_names(__file__)
__all__ = sorted(_NAMES)
__getattr__ = lazy_names(__name__, _NAMES)


def __dir__() -> list[str]:
    return __all__
