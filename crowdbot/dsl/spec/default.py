"""Declaration of a field with a default."""

from __future__ import annotations

from typing import Any, TypeVar

from pydantic import Field

_T = TypeVar("_T")


def default(value: _T, description: str, **options: Any) -> _T:
    """Declare a field that may be left out, short for pydantic's ``Field(default=..., ...)``.

    Args:
        value: its value where it is left out.
        description: its meaning, with the unit.
        options: further arguments of `pydantic.Field`, such as ``le=1.0``.
    """
    field: _T = Field(default=value, description=description, **options)
    return field
