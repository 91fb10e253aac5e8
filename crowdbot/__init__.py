"""crowdbot: a benchmark for robots that drive through dense human crowds.

Names below are imported when they are first used, so that ``import crowdbot`` stays cheap.
"""

from __future__ import annotations

from crowdbot.lazy import lazy_face

__all__, __getattr__, __dir__ = lazy_face(__name__, __file__)
