"""Check the planner that a bundle names: the name of a component, never a file path."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

#: A registered kind; FILE.py:CLASS or FILE.yaml:NAME of a planner whose files have a hash.
_KIND = re.compile(r"[A-Za-z_][A-Za-z0-9_.+-]{0,99}")
_FROM_FILE = re.compile(r"[^/\\:\x00-\x1f]{1,200}:[A-Za-z0-9_.-]{1,100}")
#: A policy in a file, whose name has no class.
_POLICY = re.compile(r"([^/\\:\x00-\x1f]{1,200})\.(?:onnx|zip)")
_FILES = (".py", ".yaml", ".yml")
#: Kinds whose names follow from the planners in them, or are those of people.
_NAMED_OTHERWISE = ("fleet", "teleop")


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
    of_files = _FROM_FILE.fullmatch(str(kind)) or _POLICY.fullmatch(str(kind))
    if not isinstance(kind, str) or not (of_files if digest else is_kind(kind)):
        yield f"its kind is {str(kind)[:80]!a}, which is not the name of a planner"
        return
    if not isinstance(planner.get("parameters", {}), Mapping):
        yield "its parameters are not a mapping"
    if kind not in _NAMED_OTHERWISE:
        yield from _names(planner, kind)


def _names(planner: Mapping[str, Any], kind: str) -> Iterator[str]:
    """Yield a name or label that differs from the planner's kind, and so could mislead."""
    policy = _POLICY.fullmatch(kind)
    expected = policy[1] if policy else kind.rpartition(":")[2]
    name, label = planner.get("name", expected), planner.get("label", expected)
    if name != expected:
        yield f"its name is {str(name)[:80]!a}, but it is {expected[:80]!a}"
    elif label != expected and not str(label).startswith(f"{expected}+"):
        yield f"its label is {str(label)[:80]!a}, but it is {expected[:80]!a}"
