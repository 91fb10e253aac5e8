"""Check arguments of public functions, with messages that name the argument.

Type checkers find the same errors, but most scripts and notebooks are not type-checked.
"""

from __future__ import annotations

import math
import operator
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from crowdbot.errors import InputError, kind_of


def expect(name: str, value: object, *kinds: type, hint: str = "") -> None:
    """Refuse an argument of another type.

    Raises:
        InputError: it has another type.
    """
    if not isinstance(value, kinds):
        _refuse(name, value, f"a {' or '.join(k.__name__ for k in kinds)}", hint)


def expect_function(name: str, value: object) -> None:
    """Refuse an argument that is not callable.

    Raises:
        InputError: it is not callable.
    """
    if not callable(value):
        _refuse(name, value, "a function")


def path_of(name: str, value: str | os.PathLike[str]) -> Path:
    """Return a path from a text or a path.

    Raises:
        InputError: it is neither.
    """
    text = os.fspath(value) if isinstance(value, str | os.PathLike) else value
    if not isinstance(text, str):
        _refuse(name, value, "a path")
    if "\0" in text:
        raise InputError(f"{name} is a path with a zero character: {text!r}")
    return Path(text)


def number_of(name: str, value: Any, unit: str = "") -> float:
    """Return a finite number.

    Raises:
        InputError: it is not one; the message names the unit.
    """
    expected = f"a number in {unit}" if unit else "a number"
    if isinstance(value, bool | str | bytes | complex) or not hasattr(value, "__float__"):
        _refuse(name, value, expected)
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        _refuse(name, value, expected)
    if not math.isfinite(number):
        raise InputError(f"{name} must be {expected}, not {number}")
    return number


def whole_number_of(name: str, value: Any, least: int = 0) -> int:
    """Return a whole number that is at least the minimum.

    Raises:
        InputError: it is not one.
    """
    expected = f"a whole number, at least {least}"
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        _refuse(name, value, expected)
    try:
        number = operator.index(value)
    except TypeError:  # an array
        _refuse(name, value, expected)
    if number < least:
        raise InputError(f"{name} must be {expected}, not {number}")
    return number


def point_of(name: str, value: Any) -> tuple[float, float]:
    """Return two finite numbers, m.

    Raises:
        InputError: it is not a point.
    """
    try:
        x, y = value
        return number_of(name, x, "m"), number_of(name, y, "m")
    except (TypeError, ValueError, InputError):
        raise InputError(f"{name} must be (x, y), two numbers in m, not {value!r}") from None


def texts_of(name: str, value: str | Sequence[str]) -> tuple[str, ...]:
    """Return one or several texts as a tuple.

    Raises:
        InputError: it is not text.
    """
    if isinstance(value, str):
        return (value,)
    if not isinstance(value, Sequence | set | frozenset) or isinstance(value, bytes):
        _refuse(name, value, "a str or a list of them")
    for item in value:
        if not isinstance(item, str):
            raise InputError(f"{name} must be a list of str; {kind_of(item)} is in it")
    return tuple(value)


def mapping_of(name: str, value: Any, of: str) -> Mapping[Any, Any]:
    """Return a mapping.

    Args:
        name: the argument's name.
        value: the argument.
        of: description of its keys and values.

    Raises:
        InputError: it is not a mapping.
    """
    if not isinstance(value, Mapping):
        _refuse(name, value, f"a mapping of {of}")
    mapping: Mapping[Any, Any] = value
    return mapping


def _refuse(name: str, value: object, expected: str, hint: str = "") -> Any:
    advice = f"; {hint}" if hint else ""
    raise InputError(f"{name} must be {expected}, not {kind_of(value)}{advice}")
