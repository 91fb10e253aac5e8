"""Pass warnings of one class to a function instead of showing them."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

#: Takes the text, and the file and line that a warning is about.
Take = Callable[[str, str, int], None]


@contextmanager
def warnings_to(take: Take, kind: type[Warning]) -> Iterator[None]:
    """Pass warnings of a class to a function in a context; others are shown as before."""
    with warnings.catch_warnings():
        usual = warnings.showwarning

        def show(
            message: Warning | str,
            category: type[Warning],
            filename: str,
            lineno: int,
            file: TextIO | None = None,
            line: str | None = None,
        ) -> None:
            if issubclass(category, kind):
                take(str(message), filename, lineno)
            else:
                usual(message, category, filename, lineno, file, line)

        warnings.showwarning = show
        yield
