"""Tools for metrics' build functions: runs as arrays, encounters, contacts, pairs of runs."""

from __future__ import annotations

from crowdbot.lazy import lazy_face

__all__, __getattr__, __dir__ = lazy_face(__name__, __file__)
