"""Tables of parameters in docs/reference/planners; scripts/generate.py writes them."""

from __future__ import annotations

from pathlib import Path

from crowdbot.core.registry.registry import discover
from scripts.write_reference import field_table, linked

PAGES = Path(__file__).parent.parent / "docs" / "reference" / "planners"
BEGIN = "<!-- Written by make generate: change the planner's spec, not this. -->"
END = "<!-- End of what make generate writes. -->"


def pages() -> dict[Path, str]:
    """Return the pages of planners with their tables as they are now."""
    planners = discover().components("planner")
    found = {}
    for path in sorted(PAGES.glob("*.md")):
        if path.stem in planners:
            text = path.read_text(encoding="utf-8")
            before, _, rest = text.partition(BEGIN)
            table = linked(field_table(planners[path.stem].spec), path)
            found[path] = f"{before}{BEGIN}\n\n{table}\n\n{END}{rest.partition(END)[2]}"
    return found
