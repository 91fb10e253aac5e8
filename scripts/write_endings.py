"""Writes the table of endings in docs/reference/run_directory.md; a test compares the page with it.

Example: .venv/bin/python scripts/write_endings.py
"""

from __future__ import annotations

from pathlib import Path

from crowdbot.core.types.ending import Ending

PAGE = Path(__file__).parent.parent / "docs" / "reference" / "run_directory.md"
BEGIN = "<!-- Written by scripts/write_endings.py: change core/types/ending.py, not this. -->"
END = "<!-- End of what scripts/write_endings.py writes. -->"


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
    return "results, reports" if ending == Ending.NO_RUN else "recordings (`.partial`)"


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
