"""The table of endings in docs/reference/run_directory.md; scripts/generate.py writes it."""

from __future__ import annotations

from pathlib import Path

from crowdbot.core.types.ending import Ending

PAGE = Path(__file__).parent.parent / "docs" / "reference" / "run_directory.md"
BEGIN = "<!-- Written by make generate: change core/types/ending.py, not this. -->"
END = "<!-- End of what make generate writes. -->"


def page(text: str) -> str:
    """The page with the table as it is now."""
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n\n{_table()}\n\n{END}{after}"


def _table() -> str:
    lines = ["| status | such runs | stands in | counts as failed |", "|---|---|---|---|"]
    lines += [
        f"| `{one}` | {one.past} | {_place(one)} | {'yes' if one.failed else 'no'} |"
        for one in Ending
    ]
    return "\n".join(lines)


def _place(ending: Ending) -> str:
    if ending.complete:
        return "`run.json`, results, reports, recordings"
    beside = (Ending.NO_RUN, Ending.PEOPLE_ALONE)
    return "results, reports" if ending in beside else "recordings (`.partial`)"
