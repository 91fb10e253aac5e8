"""Seeds of random streams: adding a stream never changes another."""

from __future__ import annotations

import hashlib


def stream_seed(root: int, key: str, stream: str) -> int:
    """Return the seed of one named stream, an integer below 2**64.

    Args:
        root: root seed of the suite.
        key: draw within the root, e.g. ``in-d0500-slow``.
        stream: name of the stream, e.g. ``crowd.speed``.
    """
    digest = hashlib.sha256(f"{root}/{key}/{stream}".encode()).digest()
    return int.from_bytes(digest[:8], "big")
