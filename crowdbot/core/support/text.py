"""Words and names for output: counted nouns, long names in narrow columns."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

_PART = re.compile(r"[^_+-]*[_+-]|[^_+-]+")


def listed(names: Sequence[str]) -> str:
    """Return names as in a sentence: ``a, b and c``."""
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))


def rough_time(seconds: float) -> str:
    """Return a time that is only estimated: whole seconds, or minutes."""
    return f"{seconds / 60.0:.0f} min" if seconds >= 90.0 else f"{seconds:.0f} s"


def plural(count: int, noun: str) -> str:
    """Return a count and its noun, such as ``1 pair`` and ``2 pairs``."""
    return f"{count} {noun}{'' if count == 1 else 's'}"


def wrap_name(name: str, width: int) -> str:
    """Break a name at blanks, and within words longer than a line after ``_``, ``-`` and ``+``.

    Args:
        name: a single line.
        width: largest length of a line; only a part that cannot be broken is longer.
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


def size_text(size: int) -> str:
    """Return a size in bytes as text, in kB below a megabyte."""
    return f"{size / 1e6:.1f} MB" if size >= 1e6 else f"{math.ceil(size / 1e3)} kB"
