"""Types of fields in words, for people who do not read Python."""

from __future__ import annotations

import re
import types
from enum import Enum
from pathlib import PurePath
from typing import Any, Literal, Union, get_args, get_origin

import annotated_types as limits

_PLAIN = {float: "number", int: "integer", str: "text", bool: "true or false", Any: "anything",
          type(None): "unset", dict: "map", list: "list", tuple: "list"}  # fmt: skip
_PLURALS = {"number": "numbers", "integer": "integers", "text": "texts"}


def type_words(annotation: Any, metadata: tuple[Any, ...] = ()) -> str:
    """Return a type in words, with its limits.

    Args:
        annotation: the type.
        metadata: further arguments of `Annotated`, or the field's metadata.
    """
    origin, inside = get_origin(annotation), get_args(annotation)
    if hasattr(annotation, "__metadata__"):
        return type_words(inside[0], (*annotation.__metadata__, *metadata))
    if hasattr(annotation, "__value__"):  # a named alias
        return type_words(annotation.__value__, metadata)
    bounds = _bounds(metadata)
    if origin is Literal:
        return " or ".join(str(value) for value in inside)
    if origin in (Union, types.UnionType):
        return " or ".join(dict.fromkeys(type_words(one, metadata) for one in _last_none(inside)))
    if origin in (list, tuple, set, frozenset) or _is_sequence(origin):
        kinds = dict.fromkeys(type_words(one) for one in inside if one is not Ellipsis)
        fixed = f"{len(inside)} " if origin is tuple and Ellipsis not in inside else "list of "
        return f"{fixed}{' or '.join(_PLURALS.get(kind, kind) for kind in kinds)}"
    if inside and origin is not None:
        value = type_words(inside[-1])
        return f"map of names to {_PLURALS.get(value, value)}"
    return f"{_PLAIN.get(annotation) or _of_class(annotation)}{bounds}"


def _last_none(inside: tuple[Any, ...]) -> list[Any]:
    """Return the members of a union, ``None`` last."""
    return sorted(inside, key=lambda one: one is type(None))


def _is_sequence(origin: Any) -> bool:
    return getattr(origin, "__name__", "") in ("Sequence", "Iterable", "Collection")


def _bounds(metadata: tuple[Any, ...]) -> str:
    """Return the limits of a number, such as `` > 0``."""
    lows: list[tuple[Any, str]] = [(one.ge, "≥") for one in metadata if isinstance(one, limits.Ge)]
    lows += [(one.gt, ">") for one in metadata if isinstance(one, limits.Gt)]
    highs: list[tuple[Any, str]] = [(one.le, "≤") for one in metadata if isinstance(one, limits.Le)]
    highs += [(one.lt, "<") for one in metadata if isinstance(one, limits.Lt)]
    low, high = max(lows, default=None), min(highs, default=None)
    if low and high and (low[1], high[1]) == ("≥", "≤"):
        return f" from {low[0]:g} to {high[0]:g}"
    return f" {' and '.join(f'{sign} {end:g}' for end, sign in filter(None, (low, high)))}".rstrip()


def _of_class(annotation: Any) -> str:
    if isinstance(annotation, type) and issubclass(annotation, Enum):
        return " or ".join(str(one.value) for one in annotation)
    if isinstance(annotation, type) and issubclass(annotation, PurePath):
        return "file"
    name = getattr(annotation, "__name__", str(annotation)).removesuffix("Spec")
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", name.lstrip("_")).lower()


def default_words(value: Any) -> str:
    """Return a default as a reader would write it in YAML."""
    if value is None:
        return "unset"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(default_words, value))}]"
    if isinstance(value, dict) and value:
        return ", ".join(map(str, value))
    return "none" if value in ("", {}) else str(value)
