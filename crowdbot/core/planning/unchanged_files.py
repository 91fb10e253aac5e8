"""Builders of planners whose files must not change after they were chosen."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from crowdbot.core.planning.planner import Planner
from crowdbot.core.planning.process.describe import NotLoaded
from crowdbot.errors import InputError


@dataclass(frozen=True, slots=True)
class UnchangedFiles:
    """Builds a planner, after checking that its files are unchanged since it was chosen.

    Attributes:
        build: builds it.
        digest: returns the SHA-256 of its files; ``sha256`` is what it was.
        origin: file or document that names it.
    """

    build: Callable[[], Planner]
    digest: Callable[[], str]
    sha256: str
    origin: str

    def __call__(self) -> Planner:
        """Build it.

        Raises:
            InputError: its files have changed.
        """
        if self.digest() != self.sha256:
            raise InputError(
                f"{self.origin}: the planner's files changed since it was chosen; start again"
            )
        return self.build()


def while_unchanged(
    build: Callable[[], Planner], digest: Callable[[], str], sha256: str, origin: str
) -> Callable[[], Planner]:
    """Return a builder that first checks the planner's files; a `NotLoaded` stays unchanged."""
    return build if isinstance(build, NotLoaded) else UnchangedFiles(build, digest, sha256, origin)
