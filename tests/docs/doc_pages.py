"""The documents as data: pages, headings, code blocks, links, commands."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tests.paths import ROOT

ROOT = ROOT
PAGES = sorted(
    [
        *ROOT.glob("*.md"),
        *(p for p in (ROOT / "docs").rglob("*.md") if ".pytest_cache" not in p.parts),
    ]
)

_FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
_HEADING = re.compile(r"^#{1,6} +(.*)$", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class Block:
    """A fenced code block; ``names`` is the file in its first line, or None."""

    page: Path
    language: str
    names: Path | None
    text: str


def name_of(page: Path) -> str:
    """How test ids call a page."""
    return page.relative_to(ROOT).as_posix()


def read(page: str) -> str:
    """The text of a page of docs/."""
    return (ROOT / "docs" / page).read_text(encoding="utf-8")


def blocks(page: Path) -> Iterator[Block]:
    """All fenced blocks of a page."""
    for info, text in _FENCE.findall(page.read_text(encoding="utf-8")):
        language, _, name = info.strip().partition(" ")
        yield Block(page, language, page.parent / name if name else None, text)


def prose(page: Path) -> str:
    """A page without its code blocks."""
    return _FENCE.sub("", page.read_text(encoding="utf-8"))


def links(page: Path) -> list[str]:
    """Targets of all links and pictures."""
    return _LINK.findall(prose(page))


def anchors(page: Path) -> set[str]:
    """What may follow ``#`` in a link to a page."""
    return {_slug(heading) for heading in _HEADING.findall(prose(page))}


def section(text: str, heading: str) -> str:
    """From one heading to the next of the same or a higher level."""
    level = heading.count("#")
    found = re.search(
        rf"^{re.escape(heading)}$(.*?)(?=^#{{1,{level}}} |\Z)", text, re.MULTILINE | re.DOTALL
    )
    assert found, f"no heading '{heading}'"
    return found[1]


def sessions() -> Iterator[tuple[str, list[str], list[str]]]:
    """Page, words and shown output of each ``crowdbot`` command in a console block."""
    for page in PAGES:
        for block in blocks(page):
            if block.language != "console":
                continue
            for entry in re.split(r"^\$ ", block.text, flags=re.MULTILINE)[1:]:
                command, *output = entry.splitlines()
                words = shlex.split(command)
                if Path(words[0]).name == "crowdbot":
                    yield name_of(page), words[1:], output


def commands() -> Iterator[tuple[str, list[str]]]:
    """Page and words of each ``crowdbot`` command in a console block."""
    for page, words, _ in sessions():
        yield page, words


def _slug(heading: str) -> str:
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
