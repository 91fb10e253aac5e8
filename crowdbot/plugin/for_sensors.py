"""Tools for sensors' build functions: rays in columns, bodies of people, depth images."""

from __future__ import annotations

from crowdbot.lazy import lazy_face

__all__, __getattr__, __dir__ = lazy_face(__name__, __file__)
