"""Finds retired words; what each thing is called is in docs/reference/glossary.md.

    python scripts/check_vocabulary.py [FILE...]

Prints ``file:line: text -> what to write`` and ends with exit code 1 if there are any. Only words
that have no other meaning here are listed: this is a net for what was renamed, not a style guide.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
#: What is read: folders with all that is below them, and files.
PLACES = ("crowdbot", "docs", "tests", "README.md", "CONTRIBUTING.md")
#: Files that have to name retired words.
EXEMPT = ("tests/test_check_vocabulary.py",)
CODE, TEXT = (".py", ".js", ".j2", ".tmpl"), (".md", ".txt", ".yaml", ".toml")
EVERYWHERE = CODE + TEXT
_BEFORE = 40  # characters that `Rule.unless` sees


class Rule(NamedTuple):
    """A retired word.

    Attributes:
        pattern: regular expression.
        instead: what to write.
        suffixes: files in which it is looked for.
        unless: regular expression of what may stand before it and makes it right.
    """

    pattern: str
    instead: str
    suffixes: Sequence[str] = EVERYWHERE
    unless: str = ""


_COMPARED = (
    "longer|farther|further|better|worse|more|less|fewer|larger|smaller|bigger|greater|nearer|"
    "closer|wider|higher|lower|later|earlier|sooner|faster|slower|shorter|harder|easier|stricter|"
    "different|older|newer|one"
)

RULES = (
    Rule(r"\b(?:write_aside|writ\w+ (?:\w+ ){0,2}aside|aside,? (?:and|first|then) renam\w+)\b",
         "atomic_write; write under a temporary name, then rename"),
    Rule(r"\b[Ww]illed\b", "desired acceleration"),
    Rule(r"\b[Cc]omparands?\b", "DiffSide, diff side"),
    Rule(r"\b[Ll]eash(?:es)?\b", "clearance cache"),
    Rule(r"\b[Cc]hatter\b", "stdout guard, stdout_to_stderr", (".md",)),
    Rule(r"\b[Ww]orkshops?\b", "executor, execute"),
    Rule(r"\b(?:[Cc]rews?|(?:Local|Cluster)Crew)\b", "worker pool"),
    Rule(r"\b[Ee]ntrants?\b", "planner entry"),
    Rule(r"\b(?i:deeds?)\b", "build function"),
    Rule(r"\b[Ll]aws\b", "invariants"),
    Rule(r"\bsame(?:_|\s+)words\b", "same spec"),
    Rule(r"\b[Uu]nsteady\b", "nondeterministic"),
    Rule(r"\bin_turn\b", "entry_order", CODE),
    Rule(r"\bunder_way\b", "active", CODE),
    Rule(r"\bPhotographs?\b", "CameraFrame"),
    Rule(r"\b(?:[Pp]ainter|paint_depth)\b", "ColourRenderer, render_depth", CODE),
    Rule(r"\bfault\.described\b|\bis_users\b", "describe_error, is_user_interrupt"),
    Rule(rf"\b(?:is|are|was|were)\s+no\b(?!\s+(?:{_COMPARED})\b)(?!-)", "is not a, is not an",
         unless=r"\b[Tt]here\s+"),
    Rule(r"\b(?:is|are)\s+none\b(?!\s+of)", "is not one, has none", unless=r"\b[Tt]here\s+"),
)  # fmt: skip


def files_to_read() -> Iterator[Path]:
    """All texts below `PLACES`."""
    for name in PLACES:
        place = ROOT / name
        for file in sorted(place.rglob("*")) if place.is_dir() else [place]:
            if file.suffix in EVERYWHERE and file.relative_to(ROOT).as_posix() not in EXEMPT:
                yield file


def findings(text: str, suffix: str) -> Iterator[tuple[int, str, str]]:
    """Line, text and what to write instead, for each retired word.

    Args:
        text: of a file.
        suffix: of its name, which says which rules hold.
    """
    for rule in RULES:
        if suffix not in rule.suffixes:
            continue
        for found in re.finditer(rule.pattern, text):
            before = text[max(0, found.start() - _BEFORE) : found.start()]
            if rule.unless and re.search(rf"(?:{rule.unless})\Z", before):
                continue
            line = text.count("\n", 0, found.start()) + 1
            yield line, " ".join(found[0].split()), rule.instead


def main(arguments: Sequence[str]) -> int:
    """Check the files that are named, or all; the exit code."""
    found = 0
    for file in map(Path, arguments) if arguments else files_to_read():
        for line, text, instead in sorted(
            findings(file.read_text("utf-8", errors="replace"), file.suffix)
        ):
            place = file.relative_to(ROOT) if file.is_relative_to(ROOT) else file
            print(f"{place}:{line}: {text} -> {instead}")
            found += 1
    return int(found > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
