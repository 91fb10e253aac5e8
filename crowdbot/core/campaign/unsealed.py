"""Unpack a sealed planner while its runs are repeated."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from crowdbot.core.bundle.submission import SUFFIX, read_submission, unpack_submission
from crowdbot.core.planning.choice import PlannerPlace


@contextmanager
def unsealed(given: str | None, place: PlannerPlace) -> Iterator[tuple[str | None, PlannerPlace]]:
    """Yield the planner and its place; a sealed one is unpacked, anything else stays as it is.

    Args:
        given: ``FILE.cbs``, ``FILE.py:CLASS``, ``FILE.yaml``, or None.
        place: where the planner runs.

    Raises:
        InputError: the archive cannot be read or is damaged.
    """
    if given is None or not given.endswith(SUFFIX):
        yield given, place
        return
    sealed = read_submission(Path(given))
    with tempfile.TemporaryDirectory(prefix="crowdbot-sealed-") as folder:
        file = unpack_submission(sealed, Path(folder))
        _, colon, kind = sealed.about.planner.partition(":")
        yield f"{file}{colon}{kind}", replace(place, sealed=Path(folder).resolve())
