"""Run mypy without garbage collection, which takes a third of its time where nothing is cached.

    python scripts/check_types.py [ARGUMENT OF MYPY...]

All syntax trees stay until the end, and each collection walks through them. Without it, mypy takes
2.6 GB instead of 1.1, so machines with little memory keep it. Messages and exit codes are mypy's.
"""

from __future__ import annotations

import gc
import os

from mypy.__main__ import console_entry

#: Memory below which a machine that also runs tests keeps garbage collection, bytes.
ENOUGH = 7e9


def main() -> None:
    """Run mypy with the arguments of this command."""
    if os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") > ENOUGH:
        gc.set_threshold(0)
        gc.set_threshold = lambda *_: None  # mypy sets its own and enables collections
    console_entry()


if __name__ == "__main__":
    main()
