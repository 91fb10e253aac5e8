"""Compile functions that a first run needs late, in a second process at the same time.

Both read and write one folder of compiled functions, and each function is compiled by one of them
(`compile_parts`). If the second process fails or is missing, the first one compiles everything
itself.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module

from crowdbot.core.support.compile_cache import is_plain_numba, nothing_compiled
from crowdbot.core.support.cores import available_cores

_START = (
    "import sys, json; sys.path[:] = json.loads(sys.argv[1]); "
    "from crowdbot.core.support.compiling.compile_ahead import main; main(sys.argv[2])"
)
#: Time for the second process to exit by itself, s.
_GRACE = 2.0


@contextmanager
def compiled_ahead(module: str) -> Iterator[None]:
    """Call ``module.compile_ahead()`` in a second process, if nothing is compiled yet.

    It ends with the block, or with this process. On a single core there is none: it would only
    compile in another order.
    """
    process = _started(module) if _worth_it() else None
    try:
        yield
    finally:
        if process is not None:
            _end(process)


def _worth_it() -> bool:
    compiles = os.environ.get("NUMBA_DISABLE_JIT", "0") == "0"
    return compiles and not is_plain_numba() and available_cores() > 1 and nothing_compiled()


def _started(module: str) -> subprocess.Popen[bytes] | None:
    command = [sys.executable, "-c", _START, json.dumps(sys.path), module]
    try:
        return subprocess.Popen(
            command,
            stdin=subprocess.PIPE,  # its end shows the second process that this one has ended
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,  # only this process handles Ctrl-C
        )
    except OSError:
        return None


def _end(process: subprocess.Popen[bytes]) -> None:
    assert process.stdin is not None
    process.stdin.close()
    try:
        process.wait(_GRACE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def main(module: str) -> None:
    """Run the second process."""
    threading.Thread(target=_end_with_caller, daemon=True).start()
    import_module(module).compile_ahead()


def _end_with_caller() -> None:
    os.read(0, 1)
    from crowdbot.core.support.compiling.compile_parts import SAVING

    with SAVING:  # or else a partial file would remain
        os._exit(0)
