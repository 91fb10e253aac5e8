"""The file that somebody may have meant."""

from __future__ import annotations

from pathlib import Path

from crowdbot.errors import did_you_mean, nearest


def near_files(path: Path) -> str:
    """``"; did you mean 'a.csv'?"`` of files beside a path that is not there, or nothing."""
    try:
        names = [other.name for other in path.parent.iterdir() if other.is_file()]
    except OSError:
        return ""
    return did_you_mean([str(path.parent / name) for name in nearest(path.name, names)])
