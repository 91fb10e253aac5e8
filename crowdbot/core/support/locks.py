"""Locks of files between processes, also where the file system has none."""

from __future__ import annotations

import errno
import fcntl
import logging
from functools import cache
from pathlib import Path
from typing import Literal

_LOG = logging.getLogger("crowdbot")
#: What flock says on a file system without locks: Lustre without its option, NFS without lockd.
_WITHOUT = (errno.ENOSYS, errno.ENOLCK, errno.EOPNOTSUPP, errno.EINVAL)


def try_lock(handle: int, folder: Path) -> Literal["locked", "taken", "unguarded"]:
    """Lock an open file if no other process has; warn once if the file system cannot.

    Args:
        handle: of the file.
        folder: what the lock guards, for the warning.

    Raises:
        OSError: the file cannot be locked for another reason.
    """
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return "taken"
    except OSError as error:
        if error.errno not in _WITHOUT:
            raise
        _warn(str(folder.parent))
        return "unguarded"
    return "locked"


@cache
def _warn(folder: str) -> None:
    _LOG.warning(
        "%s: this file system has no locks (flock): do not let two commands write there at once",
        folder,
    )
