"""Counts the words of the documentation: written by hand and generated, for users and developers.

    python scripts/count_words.py                    # words by group
    python scripts/count_words.py --sentences 100    # random sentences, to be judged

Code blocks are counted apart. Generated is what ``make generate`` and scripts that
measure write: whole pages, parts between comments, tables of options and checks; on the cards
of metrics tables of parameters, what the metric declares (symbol, category, units, directions)
and the picture with its text.
"""

from __future__ import annotations

import argparse
import random
import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

DOCS = Path(__file__).parent.parent / "docs"
_DEVELOPERS = ("decisions/", "developers/")
#: Pages that are generated as a whole.
_GENERATED = (
    "gallery_of_clips.md",
    "reference/scenario.md",
    "reference/components/",
    "reference/crowd/flow_validation.md",
    "reference/crowd/validation.md",
    "reference/fault.md",
    "reference/metrics.md",
    "reference/rosetta_stone.md",
    "developers/author_surface.md",
    "developers/coverage.md",
)
_CODE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
_BETWEEN = re.compile(
    r"<!-- (?:Table w|W)ritten by make generate.*?-->(.*?)<!-- (?:End|end) of.*?-->", re.DOTALL
)
_OPTIONS = re.compile(
    r"^\| (?:option \| |check \| |parameter \| default \| meaning )\|\n(?:\|.*\n)*", re.MULTILINE
)
#: On cards of metrics: rows and cells that are declared, and pictures.
_DECLARED = re.compile(
    r"^\| (?:symbol|category|unit|better) \| .* \|$"
    r"|^\| `\w+` \| [^|]* \| (?:lower|higher|reference|none) \|"
    r"|^!\[.*\]\(../../images/metrics/.*\)$",
    re.MULTILINE,
)


def main() -> int:
    """Print counts, or sentences."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--sentences", type=int, default=0, help="random sentences instead")
    parser.add_argument("--seed", type=int, default=0, help="seed of the sentences")
    given = parser.parse_args()
    if given.sentences:
        drawn = random.Random(given.seed).sample(list(sentences()), given.sentences)  # noqa: S311
        for page, sentence in drawn:
            print(f"{page}: {sentence}")
        return 0
    counts = counted()
    for group, words in sorted(counts.items()):
        print(f"{words:7d}  {group}")
    print(f"{sum(counts.values()):7d}  all")
    return 0


def counted() -> Counter[str]:
    """Return group -> words."""
    found: Counter[str] = Counter()
    for path in sorted(DOCS.rglob("*.md")):
        name = path.relative_to(DOCS).as_posix()
        readers = "developers" if name.startswith(_DEVELOPERS) else "users"
        for kind, text in _parts(name, path.read_text(encoding="utf-8")):
            found[f"{readers}, {kind}"] += len(text.split())
    return found


def _parts(name: str, text: str) -> Iterator[tuple[str, str]]:
    """Yield kind and text of each part of a page."""
    if name.startswith(_GENERATED):
        yield "generated", text
        return
    yield "code", " ".join(_CODE.findall(text))
    text = _CODE.sub("", text)
    declared = (_DECLARED,) if name.startswith("reference/metrics/") else ()
    for pattern in (_BETWEEN, _OPTIONS, *declared):
        yield "generated", " ".join(pattern.findall(text))
        text = pattern.sub("", text)
    yield "by hand", text


def sentences() -> Iterator[tuple[str, str]]:
    """Yield page and sentence of users' pages: no headings, tables or code."""
    for path in sorted(DOCS.rglob("*.md")):
        name = path.relative_to(DOCS).as_posix()
        if name.startswith(_DEVELOPERS + _GENERATED):
            continue
        text = _OPTIONS.sub("", _BETWEEN.sub("", _CODE.sub("", path.read_text(encoding="utf-8"))))
        for line in text.splitlines():
            if line.startswith(("#", "|", "!", "<", "    ")) or not line.strip():
                continue
            for sentence in re.split(r"(?<=[.!?:]) +(?=[A-Z`*\[])", line):
                if len(sentence.split()) > 3:
                    yield name, sentence


if __name__ == "__main__":
    sys.exit(main())
