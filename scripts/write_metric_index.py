"""The page docs/reference/metrics.md: every metric with its symbol, question and picture."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from crowdbot.core.registry.registry import discover
from scripts.make_metric_pictures import entry
from scripts.metric_pictures.registry import DRAWINGS

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs" / "reference" / "metrics.md"
_HEAD = """# Metrics

Each metric has a page with its formula, variants, parameters, limits and a worked example. \
The four scores decide: {four}. \
Metrics in *italics* are experimental and scored only when they are named. \
[Errata](../developers/errata.md) lists what is wrong with the formulas of the challenge, and \
[four scores](../explanation/four_scores.md) says why there are four.

Below each table are pictures of what its metrics measure, from one run: a robot that sways and \
hardly brakes, among 24 people who walk both ways in a corridor of 14 m. The number above a \
picture is the metric's value in that run. What users answer and command is made up, since no one \
steered.
"""
_TREE = """```{toctree}
:hidden:
:glob:
metrics/*
```
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
        head = "| metric | symbol | better | what it measures |\n|---|---|---|---|"
        pictures = [entry(c.kind) for c in groups[category] if c.kind in DRAWINGS]
        parts.append("\n".join([f"## {category}\n", head, *rows, "", *pictures]))
    return "\n".join([*parts, _TREE])


def _row(component: Any) -> str:
    link = f"[{component.kind.replace('_', ' ')}](metrics/{component.kind}.md)"
    link = f"*{link}*" if component.experimental else link
    label = component.variants
    better = " or ".join(dict.fromkeys(v.better for v in label.values() if v.better != "none"))
    tells = component.summary.removeprefix(f"{component.symbol}: ")
    return f"| {link} | {_cell(component.symbol)} | {better or '–'} | {_cell(tells)} |"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("*", "\\*")
