"""Writes docs/reference/metrics_by_category.md: every metric with its symbol and its question.

Examples:
    .venv/bin/python scripts/write_metric_index.py
    .venv/bin/python scripts/write_metric_index.py --check
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from crowdbot.core.registry.registry import discover

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs" / "reference" / "metrics_by_category.md"
_HEAD = """# Metrics by category

Each metric has a page with its formula, variants, parameters, limits and a worked example. \
The four scores decide: {four}. \
Metrics in *italics* are experimental and scored only when they are named. \
[Errata](metrics/errata.md) lists what is wrong with the formulas of the challenge, and \
[four scores](../explanation/four_scores.md) says why there are four.
"""
_FOUR = ("safe_efficiency", "contacts_per_km", "push_work", "intrusion")


def page() -> str:
    """The whole page."""
    groups: dict[str, list[Any]] = {}
    for component in discover(entry_points=False).components("metric").values():
        if not component.successor:
            groups.setdefault(str(component.score_category), []).append(component)  # type: ignore[attr-defined]
    four = ", ".join(f"[{name}](metrics/{name}.md)" for name in _FOUR)
    parts = [_HEAD.format(four=four)]
    for category in sorted(groups):
        rows = [_row(c) for c in groups[category]]
        head = "| metric | symbol | better | what it tells |\n|---|---|---|---|"
        parts.append("\n".join([f"## {category}\n", head, *rows, ""]))
    return "\n".join(parts)


def _row(component: Any) -> str:
    link = f"[{component.kind.replace('_', ' ')}](metrics/{component.kind}.md)"
    link = f"*{link}*" if component.experimental else link
    label = component.variants
    better = " or ".join(dict.fromkeys(v.better for v in label.values() if v.better != "none"))
    tells = component.summary.removeprefix(f"{component.symbol}: ")
    return f"| {link} | {_cell(component.symbol)} | {better or '–'} | {_cell(tells)} |"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("*", "\\*")


def main() -> int:
    """Write the page, or say whether it is current."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing; exit 1 if stale")
    text = page()
    if parser.parse_args().check:
        return int(not PAGE.is_file() or PAGE.read_text(encoding="utf-8") != text)
    PAGE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
