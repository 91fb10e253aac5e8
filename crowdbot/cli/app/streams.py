"""Standard streams as commands need them: open, and able to print any character."""

from __future__ import annotations

import codecs
import io
import os
import sys

#: Replacements of characters that a terminal cannot show.
_PLAIN = {
    "–": "-", "—": "-", "−": "-", "·": "*", "×": "x", "²": "^2", "³": "^3", "°": " deg", "…": "...",
    "±": "+-", "≤": "<=", "≥": ">=", "≈": "~", "√": "sqrt", "µ": "u", "μ": "u", "σ": "sigma",
    "→": "->", "’": "'", "‘": "'", "“": '"', "”": '"', "•": "*", "\u202f": " ", "\xa0": " ",
}  # fmt: skip
_NAME = "crowdbot.plain"


def prepare_streams() -> None:
    """Replace closed standard streams; escape characters that open ones cannot encode."""
    _fill_closed()
    _drop_sizes_of_nothing()
    codecs.register_error(_NAME, _plainly)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=_NAME)


def _drop_sizes_of_nothing() -> None:
    """Delete ``COLUMNS`` and ``LINES`` if they are zero or empty, as in some containers."""
    for name in ("COLUMNS", "LINES"):
        if os.environ.get(name, "1").strip().strip("0") == "":
            del os.environ[name]


def _fill_closed() -> None:
    """Open the null device for closed streams.

    Otherwise the next opened file would get their descriptor, and the output of libraries.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number
    if sys.stdin is None:
        sys.stdin = open(0, encoding="utf-8", closefd=False)  # noqa: SIM115
    if sys.stdout is None:
        sys.stdout = open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    if sys.stderr is None:
        sys.stderr = open(2, "w", encoding="utf-8", closefd=False)  # noqa: SIM115


def _plainly(error: UnicodeError) -> tuple[str | bytes, int]:
    """Return an ASCII replacement or an escape for characters that cannot be encoded."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    text = error.object[error.start : error.end]
    escaped = (_PLAIN.get(c) or c.encode("ascii", "backslashreplace").decode() for c in text)
    return "".join(escaped), error.end
