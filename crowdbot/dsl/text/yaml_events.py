"""The parser events of a YAML text, in order and with positions.

Two parsers produce them, with the same class names and attributes. libyaml (in C, by PyYAML) is
about thirty times as fast and reads a YAML between 1.1 and 1.2; it gets texts in which both agree.
ruamel.yaml reads all others, and invalid ones: all messages come from it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

#: Text in which the two may differ: line ends other than line feeds, tabs, byte order marks,
#: directives, starts of block scalars, explicit keys, anchors, aliases, tags, or JSON-like keys.
_UNLIKE = re.compile(
    r"""[\t\r\x85\u2028\u2029\ufeff]|^%|(?:^|[^\w.)])(?:[?|>!]|[&*]\S)|["']:\S""", re.MULTILINE
)


def events_of(text: str) -> Iterator[Any]:
    """Yield all events, from the start of the stream to its end.

    Raises:
        MarkedYAMLError: from ruamel.yaml; the text is not YAML from here on.
    """
    quick = quick_events(text)
    if quick is not None:
        return iter(quick)
    from ruamel.yaml import YAML

    events: Iterator[Any] = YAML(typ="safe", pure=True).parse(text)
    return events


def quick_events(text: str) -> list[Any] | None:
    """Return libyaml's events; None if ruamel.yaml has to read the text."""
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
    """Return True if an event is plain data with the same position in both parsers.

    For an empty value, libyaml's position is too far ahead.
    """
    kind = type(event).__name__
    if kind == "ScalarEvent":
        return not event.tag and not event.anchor and bool(event.value or not event.implicit[0])
    if kind in ("MappingStartEvent", "SequenceStartEvent"):
        return not event.tag and not event.anchor
    return kind != "DocumentStartEvent" or not event.explicit
