"""Writes crowdbot/cli/app/builtin_names.py: what a shell offers before anything was looked for.

Example: .venv/bin/python scripts/write_completion_names.py
"""

from __future__ import annotations

from pathlib import Path

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import suite_names

FILE = Path(__file__).parent.parent / "crowdbot" / "cli" / "app" / "builtin_names.py"
_HEAD = '''"""Names of crowdbot's own planners, metrics and suites, for the tab key.

Written by scripts/write_completion_names.py: to ask the components would take half a second.
"""

from __future__ import annotations

#: What is completed -> names.
BUILTIN_NAMES: dict[str, list[str]] = {
'''


def text() -> str:
    """The whole file."""
    registry = discover(entry_points=False)
    names = {
        "planners": sorted(registry.components("planner")),
        "metrics": sorted(registry.components("metric")),
        "suites": suite_names(registry),
    }
    rows = [f'    "{what}": [\n{_lines(found)}    ],\n' for what, found in names.items()]
    return _HEAD + "".join(rows) + "}\n"


def _lines(names: list[str]) -> str:
    return "".join(f'        "{name}",\n' for name in names)


if __name__ == "__main__":
    FILE.write_text(text(), encoding="utf-8")
