"""Declaration of a field with a default."""

from __future__ import annotations

from functools import partial
from operator import eq
from typing import Any, TypeVar

from pydantic import Field

_T = TypeVar("_T")


def default(value: _T, description: str, *, omitted: bool = False, **options: Any) -> _T:
    """Declare a field that may be left out, short for pydantic's ``Field(default=..., ...)``.

    Args:
        value: its value where it is left out.
        description: its meaning, with the unit.
        omitted: True if documents are written, and hashed, without the field while it has this
            value: those from before the field keep their hashes.
        options: further arguments of `pydantic.Field`, such as ``le=1.0``.
    """
    if omitted:
        options["exclude_if"] = partial(eq, value)
    field: _T = Field(default=value, description=description, **options)
    return field
