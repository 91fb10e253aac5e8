"""Failures of Drake, which raises ``SystemExit`` where a condition of its own does not hold."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

#: How such a failure begins.
_BEGINS = "Failure at "


@contextmanager
def drake_failures() -> Iterator[None]:
    """Turn failed conditions of Drake into errors that do not end the process.

    Raises:
        RuntimeError: a condition of Drake does not hold; the text is Drake's, without its file.
    """
    try:
        yield
    except SystemExit as error:
        if not (isinstance(error.code, str) and error.code.startswith(_BEGINS)):
            raise
        _, _, condition = error.code.partition(" in ")
        raise RuntimeError(f"a condition of Drake failed: {condition or error.code}") from error
