"""Tables of fields in docs/reference/studies.md; scripts/generate.py writes them."""

from __future__ import annotations

from pathlib import Path

from crowdbot.core.studies.document import StudyCondition, StudySpec, StudyTrial
from scripts.write_reference import field_table

PAGE = Path(__file__).parent.parent / "docs" / "reference" / "studies.md"
BEGIN = "<!-- Written by make generate: change crowdbot/core/studies/document.py, not this. -->"
END = "<!-- End of what make generate writes. -->"


def page() -> str:
    """Return the page with its tables as they are now."""
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
    tables = [
        field_table(StudySpec),
        f"Each of `conditions`:\n\n{field_table(StudyCondition)}",
        f"Each of `trials`, and `practice`:\n\n{field_table(StudyTrial)}",
    ]
    inner = "\n\n".join(tables)
    return f"{before}{BEGIN}\n\n{inner}\n\n{END}{rest.partition(END)[2]}"
