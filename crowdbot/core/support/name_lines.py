"""Long names in several lines, for narrow columns: broken between words, not within them."""

from __future__ import annotations

import re

_PART = re.compile(r"[^_+-]*[_+-]|[^_+-]+")


def in_lines(name: str, width: int) -> str:
    """A name that is broken at blanks, and where that does not do, after ``_``, ``-`` and ``+``.

    Args:
        name: a line.
        width: no line is longer, unless a word alone is.
    """
    lines = [""]
    for word in name.split():
        parts = [word] if len(word) <= width else _PART.findall(word)
        for k, part in enumerate(parts):
            blank = " " if k == 0 and lines[-1] else ""
            if lines[-1] and len(lines[-1] + blank + part) > width:
                lines.append(part)
            else:
                lines[-1] += blank + part
    return "\n".join(lines)
