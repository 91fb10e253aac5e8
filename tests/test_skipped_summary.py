"""What a machine could not test is one line at the end."""

from __future__ import annotations

from types import SimpleNamespace

from tests.skipped_summary import skipped_line


def report(reason: str) -> SimpleNamespace:
    """A skipped test."""
    return SimpleNamespace(longrepr=("tests/test_x.py", 3, f"Skipped: {reason}"))


def test_reasons_are_counted_the_most_frequent_first() -> None:
    reports = [report("needs a C compiler"), report("no browser"), report("no browser")]
    assert skipped_line(reports) == (
        "not tested on this machine: 3 tests: 2 (no browser); 1 (needs a C compiler)"
    )


def test_nothing_skipped_is_no_line() -> None:
    assert skipped_line([]) == ""
