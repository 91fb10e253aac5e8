"""Names that look alike, by the skeletons of Unicode's security mechanisms (UTS 39)."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable
from functools import cache
from importlib import resources

_TABLE = "confusables.txt"


def looks(name: str) -> frozenset[str]:
    """Return the keys of a name; two names look alike if they share one.

    Differences that are hard to see are ignored: similar letters of other scripts, capitals,
    digits, blanks and compatibility forms.
    """
    plain = unicodedata.normalize("NFKC", name)
    return frozenset(
        " ".join(key.split()) for key in (skeleton(plain).casefold(), skeleton(plain.casefold()))
    )


def skeleton(text: str) -> str:
    """Return the skeleton of a text: equal for texts that look the same."""
    parts = unicodedata.normalize("NFD", text)
    seen = (_prototypes().get(c, c) for c in parts if unicodedata.category(c) != "Cf")
    return unicodedata.normalize("NFD", "".join(seen))


def alike(names: Iterable[str]) -> set[str]:
    """Return the names that look like another one of them, or occur twice."""
    by_key: dict[str, list[str]] = {}
    for name in names:
        for key in looks(name):
            by_key.setdefault(key, []).append(name)
    return {name for found in by_key.values() if len(found) > 1 for name in found}


@cache
def _prototypes() -> dict[str, str]:
    """Return character -> what it looks like."""
    text = resources.files(__package__).joinpath(_TABLE).read_text(encoding="ascii")
    lines = (line.split() for line in text.splitlines())
    return {
        chr(int(source, 16)): "".join(chr(int(c, 16)) for c in target)
        for source, *target in lines
        if source != "#"
    }
