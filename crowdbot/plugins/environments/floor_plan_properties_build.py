"""Properties of GeoJSON features, kind and storeys, as written by several programs."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from typing import Any

#: Properties that name a storey.
_LEVELS = (
    "level", "storey", "story", "level_id", "levelid", "level_index", "storey_id", "floor_id",
    "floorid", "floor_level", "floor_number", "etage", "geschoss", "stockwerk",
)  # fmt: skip
#: Values of ``floor`` that name a storey, not a covering: 1, -2, EG, 1. OG, L2.
_FLOOR_NAME = re.compile(
    r"[a-z]{0,2}[ .]?-?\d+(st|nd|rd|th)?[. ]*(og|ug|floor|level)?|eg|og|ug|dg|kg|gf|g"
    r"|ground( floor)?|basement|level -?\d+|floor -?\d+|first|second|third",
    re.IGNORECASE,
)
#: Properties by which other programs say what a feature is, and values that are solid.
_OTHER_KINDS = ("type", "class", "category", "indoor", "feature_type", "layer", "usage", "role")
_SOLID_WORDS = re.compile(
    r"(outer|inner|interior|exterior)?[ _-]?(walls?|columns?|pillars?|obstacles?|furniture|voids?)",
    re.IGNORECASE,
)


_DOOR_WORDS = re.compile(r"(doors?|openings?|entrances?|exits?)(way|ways)?", re.IGNORECASE)


def is_door(properties: dict[str, Any]) -> bool:
    """Return True if a property of another name than ``kind`` says that a feature is an opening."""
    return any(
        _DOOR_WORDS.fullmatch(str(properties.get(name, "")).strip()) for name in _OTHER_KINDS
    )


def in_small_letters(properties: dict[str, Any]) -> dict[str, Any]:
    """Return properties with lower-case names; shape files write them in capitals."""
    lower = {str(name).lower(): value for name, value in properties.items()}
    return {**lower, **{name: v for name, v in properties.items() if name in lower}}


def kind_of(properties: dict[str, Any]) -> str:
    """Return a feature's kind in lower case, or ""."""
    kind = properties.get("kind")
    return "" if kind is None else str(kind).strip().lower()


def solid_by_another_name(features: Iterable[dict[str, Any]]) -> str:
    """Return how many features without a kind seem solid by another property."""
    found = Counter(
        f"{name}: {value}"
        for properties in features
        if not kind_of(properties)
        for name, value in properties.items()
        if name in _OTHER_KINDS and _SOLID_WORDS.fullmatch(str(value).strip())
    )
    return ", ".join(
        f"{count} feature(s) with '{property_}'" for property_, count in sorted(found.items())
    )


def levels_of(properties: dict[str, Any]) -> tuple[str, ...]:
    """Return the storeys of a feature."""
    values = [v for key in _LEVELS if (v := properties.get(key)) not in (None, "")]
    floor = properties.get("floor")
    if not values and floor is not None and _FLOOR_NAME.fullmatch(str(floor).strip()):
        values = [floor]
    return tuple(label_of(v) for v in str(values[0]).split(";")) if values else ()


def label_of(value: object) -> str:
    """Return the name of a storey, the same for equal numbers."""
    text = str(value).strip()
    try:
        return f"{float(text) + 0.0:g}"
    except ValueError:
        return text
