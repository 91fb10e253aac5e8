"""Check the planner that a bundle names: a name of a component, never a place on a disk."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

#: A registered kind; FILE.py:CLASS or FILE.yaml:NAME of a planner whose files have a hash.
_KIND = re.compile(r"[A-Za-z_][A-Za-z0-9_.+-]{0,99}")
_FROM_FILE = re.compile(r"[^/\\:\x00-\x1f]{1,200}:[A-Za-z0-9_.-]{1,100}")
_FILES = (".py", ".yaml", ".yml")


def planner_problems(planner: Mapping[str, Any]) -> Iterator[str]:
    """Yield reasons why a bundle's planner cannot be looked up safely."""
    robots = planner.get("robots")
    if planner.get("kind") == "fleet" and isinstance(robots, Mapping):
        for name, one in robots.items():
            for problem in _one(one if isinstance(one, Mapping) else {}):
                yield f"the planner of {str(name)[:60]!a}: {problem}"
        return
    for problem in _one(planner):
        yield f"the planner: {problem}"


def is_kind(text: str) -> bool:
    """Return True if a text can be the kind of a registered planner."""
    return bool(_KIND.fullmatch(text)) and not text.endswith(_FILES)


def _one(planner: Mapping[str, Any]) -> Iterator[str]:
    kind, digest = planner.get("kind"), planner.get("sha256")
    if digest is not None and not re.fullmatch("[0-9a-f]{64}", str(digest)):
        yield f"sha256 is {str(digest)[:80]!a}"
    fits = _FROM_FILE.fullmatch(str(kind)) if digest else is_kind(str(kind))
    if not isinstance(kind, str) or not fits:
        yield f"its kind is {str(kind)[:80]!a}, which is not the name of a planner"
