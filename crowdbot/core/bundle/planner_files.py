"""Files that a bundled planner reads, unpacked while its runs are repeated."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from crowdbot.core.bundle.archive import Archive
from crowdbot.core.bundle.manifest import PLANNER_FILES


@contextmanager
def planner_files_of(archive: Archive) -> Iterator[Path]:
    """Yield a temporary folder with the files, named by their SHA-256; empty if there are none.

    Raises:
        InputError: one is damaged.
    """
    with tempfile.TemporaryDirectory(prefix="crowdbot-planner-") as folder:
        for name in sorted(n for n in archive.names if n.startswith(PLANNER_FILES)):
            archive.unpack(name, Path(folder) / name.removeprefix(PLANNER_FILES).replace("/", "_"))
        yield Path(folder)
