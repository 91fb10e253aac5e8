"""three.js in the pages: compressed, and unpacked only when the 3-D view is opened."""

from __future__ import annotations

from functools import cache
from importlib import resources

from crowdbot.core.replay.pack import deflate


@cache
def three_source() -> str:
    """Return the source of three.js that the pages use; made by ``scripts/js/three``."""
    return resources.files(__package__).joinpath("three.min.js").read_text(encoding="utf-8")


@cache
def three_packed() -> str:
    """Return three.js compressed, for `solid_load.js`."""
    return deflate(three_source().encode())
