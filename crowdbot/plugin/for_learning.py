"""Tools for build functions of observations and rewards."""

from __future__ import annotations

from crowdbot.lazy import lazy_face

__all__, __getattr__, __dir__ = lazy_face(__name__, __file__)
