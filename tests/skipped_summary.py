"""One line on what a machine could not test: reasons of skipped tests, with their numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any


def skipped_line(reports: Sequence[Any]) -> str:
    """The line, the most frequent reason first; empty where nothing was skipped.

    Args:
        reports: of skipped tests, whose ``longrepr`` is file, line and reason.
    """
    reasons = Counter(
        str(report.longrepr[2]).removeprefix("Skipped: ")
        for report in reports
        if isinstance(report.longrepr, tuple)
    )
    if not reasons:
        return ""
    parts = "; ".join(f"{count} ({reason})" for reason, count in reasons.most_common())
    return f"not tested on this machine: {reasons.total()} tests: {parts}"
