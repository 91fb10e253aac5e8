"""Tables of checks in docs/reference/conformance.md; scripts/generate.py writes them."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from crowdbot.testing.checks import BY_CATEGORY, OF_ALL_KINDS

PAGE = Path(__file__).parent.parent / "docs" / "reference" / "conformance.md"
HEAD = "| check | |\n|---|---|\n"
_TABLE = re.compile(rf"{re.escape(HEAD)}(?:\|.*\n)*")
#: Categories in the order of the tables; the first table has the checks of every component.
ORDER = (
    "environment", "robot", "sensor", "noise", "planner", "crowd policy", "cost function",
    "metric", "observation", "reward",
)  # fmt: skip


def page() -> str:
    """Return the page with each check and the first part of its docstring."""
    groups = iter([OF_ALL_KINDS, *(BY_CATEGORY[category] for category in ORDER)])
    text = PAGE.read_text(encoding="utf-8")
    return _TABLE.sub(lambda _: HEAD + "".join(_rows(next(groups))), text)


def _rows(checks: Sequence[Callable[..., object]]) -> Iterator[str]:
    for check in checks:
        what = (inspect.getdoc(check) or "").partition("If this fails, ")[0]
        yield f"| `{check.__name__}` | {' '.join(what.split())} |\n"
