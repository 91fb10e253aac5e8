"""Runs the tests under coverage and writes docs/developers/coverage.md.

Examples:
    .venv/bin/python scripts/write_coverage.py
    .venv/bin/python scripts/write_coverage.py -m "not slow"   # arguments go to pytest
"""

from __future__ import annotations

import json
import shlex
import subprocess
import sys
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs" / "developers" / "coverage.md"
DATA = ROOT / ".coverage"

_HEAD = (
    "# Test coverage\n\n<!-- Written by scripts/write_coverage.py. -->\n\n"
    "Which statements and branches of each room the tests run, the processes that tests start "
    "included. Measured on {date} by `{command}`: {total:.1f} % of {statements} statements and "
    "{branches} branches.\n\n"
    "Functions that numba compiles are left out and counted in a column of their own: they run as "
    "machine code, which coverage cannot look into. Interpreted they would take hours, and some "
    "could not run at all, since compiled code calls cost functions by address. Hand-computed "
    "cases, properties and reference trajectories test them.\n\n"
    "| room | statements | branches | covered | compiled, not measured |\n"
    "|---|---|---|---|---|\n"
)


@dataclass
class Room:
    """Sums over the files of a room."""

    statements: int = 0
    missing: int = 0
    branches: int = 0
    missing_branches: int = 0
    excluded: int = 0

    def add(self, summary: Mapping[str, int]) -> None:
        """One file, as ``coverage json`` sums it up."""
        self.statements += summary["num_statements"]
        self.missing += summary["missing_lines"]
        self.branches += summary["num_branches"]
        self.missing_branches += summary["missing_branches"]
        self.excluded += summary["excluded_lines"]

    @property
    def percent(self) -> float:
        """Of statements and branches together, as coverage counts."""
        everything = self.statements + self.branches
        return 100.0 * (1.0 - (self.missing + self.missing_branches) / max(1, everything))


def room_of(file: str) -> str:
    """The folder that a file counts to: two names in core, one elsewhere."""
    parts = Path(file).with_suffix("").parts[1:]
    depth = 2 if parts[0] in ("core", "plugins") else 1
    return "/".join(parts[: min(depth, max(1, len(parts) - 1))])


def page(report: Mapping[str, Any], command: str, date: str) -> str:
    """The page's text from what ``coverage json`` wrote."""
    rooms: dict[str, Room] = defaultdict(Room)
    total = Room()
    for file, found in report["files"].items():
        rooms[room_of(file)].add(found["summary"])
        total.add(found["summary"])
    head = _HEAD.format(
        date=date, command=command, total=total.percent, statements=total.statements,
        branches=total.branches,
    )  # fmt: skip
    return head + "".join(
        f"| `{name}` | {r.statements} | {r.branches} | {r.percent:.1f} % | {r.excluded or ''} |\n"
        for name, r in sorted(rooms.items())
    )


def measure(arguments: Sequence[str]) -> dict[str, Any]:
    """Run the tests; what ``coverage json`` says of them."""
    DATA.mkdir(exist_ok=True)
    _coverage("erase")
    _coverage("run", "-m", "pytest", "-n", "auto", "-q", *arguments)
    _coverage("combine", "-q")
    _coverage("json", "-q", "-o", str(DATA / "report.json"))
    return dict(json.loads((DATA / "report.json").read_text(encoding="utf-8")))


def _coverage(*words: str) -> None:
    subprocess.run([sys.executable, "-m", "coverage", *words], cwd=ROOT, check=True)


def main(arguments: Sequence[str]) -> None:
    """Measure and write the page; nothing is written if a test fails."""
    report = measure(arguments)
    command = shlex.join(["scripts/write_coverage.py", *arguments])
    today = datetime.now(UTC).date().isoformat()
    PAGE.write_text(page(report, command, today), encoding="utf-8")
    print(f"wrote {PAGE.relative_to(ROOT)}")


if __name__ == "__main__":
    main(sys.argv[1:])
