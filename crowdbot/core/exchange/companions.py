"""Files that imported files refer to: found beside them, and nowhere else."""

from __future__ import annotations

from pathlib import Path, PurePosixPath

from crowdbot.core.exchange.item import Item
from crowdbot.errors import SpecError, nearest


def companion(item: Item, beside: Path, text: str | None = None) -> Path:
    """Return the file that an item names.

    Projects move, so the longest end of its path that exists below the folder of the naming file,
    or the folder above it, counts.

    Args:
        item: the item, for messages.
        beside: the naming file.
        text: the path; None: the item's value.

    Raises:
        SpecError: E402, there is no such file.
    """
    named = (item.text() if text is None else text).strip().replace("\\", "/")
    parts = [p for p in PurePosixPath(named).parts if p not in ("/", ".")]
    if not parts or ".." in parts or any("\0" in p or len(p) > 250 for p in parts):
        item.refuse(f"{named[:80]!r} is not the name of a file that could lie beside this one")
    folder = beside.parent
    for base in (folder, beside.resolve().parent.parent):
        for start in range(len(parts)):
            path = base.joinpath(*parts[start:])
            if path.is_file():
                return path
    names = sorted(p.name for p in folder.iterdir() if p.is_file()) if folder.is_dir() else []
    message = f"the file '{named[:80]}' is not beside this one"
    raise SpecError([item.problem(message, nearest(parts[-1], names))])
