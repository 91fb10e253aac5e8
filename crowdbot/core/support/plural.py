"""Numbers of things, in words."""

from __future__ import annotations


def plural(count: int, noun: str) -> str:
    """Such as ``1 pair`` and ``2 pairs``."""
    return f"{count} {noun}{'' if count == 1 else 's'}"
