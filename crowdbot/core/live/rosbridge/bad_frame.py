"""The error of a frame that is not a message of the protocol."""

from __future__ import annotations


class BadFrame(Exception):  # noqa: N818 - what a client sent, not what we did
    """A client's frame is not a message of the protocol."""
