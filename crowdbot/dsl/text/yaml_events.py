"""The events of a YAML text: what it consists of, in its order, each with its place.

Two parsers give them, whose classes have the same names and attributes. libyaml (in C, by PyYAML)
is about thirty times as fast and reads a YAML between 1.1 and 1.2; it gets texts in which the two
agree. ruamel.yaml reads all others, and whatever is wrong: all messages are its.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

#: Where the two may differ: line ends other than line feeds, tabs, byte order marks, directives,
#: and what begins a block scalar, an explicit key, an anchor, an alias, a tag, or a JSON-like key.
_UNLIKE = re.compile(
    r"""[\t\r\x85\u2028\u2029\ufeff]|^%|(?:^|[^\w.)])(?:[?|>!]|[&*]\S)|["']:\S""", re.MULTILINE
)


def events_of(text: str) -> Iterator[Any]:
    """All events, from the start of the stream to its end.

    Raises:
        MarkedYAMLError: of ruamel.yaml; the text is not YAML from here on.
    """
    quick = quick_events(text)
    if quick is not None:
        return iter(quick)
    from ruamel.yaml import YAML

    events: Iterator[Any] = YAML(typ="safe", pure=True).parse(text)
    return events


def quick_events(text: str) -> list[Any] | None:
    """The events by libyaml; None where ruamel.yaml has to look."""
    if not text.endswith("\n") or _UNLIKE.search(text):
        return None
    try:
        from yaml import CLoader, YAMLError, parse
    except ImportError:  # PyYAML without libyaml
        return None
    try:
        events = list(parse(text, Loader=CLoader))
    except YAMLError:
        return None
    return events if all(map(_is_plain, events)) else None


def _is_plain(event: Any) -> bool:
    """Whether an event says nothing but data, and has the same place in both parsers.

    A value that nobody wrote stands where libyaml has already looked beyond it.
    """
    kind = type(event).__name__
    if kind == "ScalarEvent":
        return not event.tag and not event.anchor and bool(event.value or not event.implicit[0])
    if kind in ("MappingStartEvent", "SequenceStartEvent"):
        return not event.tag and not event.anchor
    return kind != "DocumentStartEvent" or not event.explicit
