"""Messages for unexpected errors, here or in a plugin's thread."""

from __future__ import annotations

import errno
import os
import re
import resource
import select
import sys
import threading
import traceback
from typing import TextIO

from crowdbot.core.registry.plugin_errors import (
    UserInterrupt,
    culprit,
    error_text,
)
from crowdbot.errors import printable


def internal_error(error: Exception) -> str:
    """Return one line that reports a bug and names installed plugins, a possible cause."""
    from importlib.metadata import entry_points

    text = (
        f"internal error {error_text(error)}{culprit(error)}; "
        "run with CROWDBOT_DEBUG=1 for the traceback"
    )
    allowed = os.environ.get("CROWDBOT_PLUGINS", "")
    others = sorted(
        {e.name for e in entry_points(group="crowdbot") if not e.value.startswith("crowdbot.")}
    )
    if others and allowed != "builtin":
        text += (
            f", or with CROWDBOT_PLUGINS=builtin to see whether it is a plugin's: {_few(others)}"
        )
    return text


def system_error(error: OSError) -> str:
    """Return one line for an error of the operating system: its file or limit, and the reason."""
    if error.filename is None and error.errno == errno.ENOENT and _has_no_folder():
        return "error: the current folder is gone; change to one that exists"
    where = error.filename or "operating system"
    text = f"error: {where}: {error.strerror or error}"
    if error.errno == errno.EPIPE:
        text += "; a process that this command started has ended"
    if error.errno == errno.EMFILE:
        limit = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
        text += f" (this process may open {limit}; raise it with 'ulimit -n')"
    return text


def no_one_reads(*streams: TextIO) -> bool:
    """Return True if the reader of an output stream has gone, such as ``head -1``.

    Other pipes break, too: those to processes that a command has started.
    """
    gone = select.POLLERR | select.POLLHUP
    for stream in streams:
        try:
            waiting = select.poll()
            waiting.register(stream, 0)
            if any(event & gone for _, event in waiting.poll(0)):
                return True
        except (OSError, ValueError):  # closed, or no file
            return True
    return False


def ended_process(error: Exception) -> str:
    """Return one line if a process of a pool has ended before its time, else ""."""
    from concurrent.futures.process import BrokenProcessPool

    if not isinstance(error, BrokenProcessPool):
        return ""
    return (
        f"error: a process that this command started has ended: killed, such as for want of "
        f"memory, or {sys.executable} cannot be started; --jobs 1 starts none"
    )


def link_loop(error: Exception) -> OSError | None:
    """Return the OSError for a circle of symbolic links; None for another error.

    Before Python 3.13 such a circle raises a RuntimeError.
    """
    match = re.fullmatch(r"Symlink loop from (['\"])(.*)\1", str(error), re.DOTALL)
    if not isinstance(error, RuntimeError) or match is None:
        return None
    return OSError(errno.ELOOP, os.strerror(errno.ELOOP), match[2])


def _has_no_folder() -> bool:
    try:
        os.getcwd()  # noqa: PTH109 - asks whether there is one
    except FileNotFoundError:
        return True
    return False


def left_by(error: BaseException) -> str:
    """Return an error line if a plugin ended the process outside of its own calls, else "".

    Also "" after an interrupt by the user, or a ``SystemExit`` raised by click.
    """
    turned = error.__context__.__cause__ if error.__context__ else None
    if isinstance(turned, KeyboardInterrupt):  # typer converts it to an exit
        error = turned
    place = "" if isinstance(error, UserInterrupt) else culprit(error)
    return f"error: a plugin raised {error_text(error)}{place}" if place else ""


def tell_of_threads() -> None:
    """Print an uncaught exception of a plugin's thread as one line, as other errors are printed."""
    usual = threading.excepthook is threading.__excepthook__
    if usual and not os.environ.get("CROWDBOT_DEBUG"):
        threading.excepthook = _tell


def _tell(failure: threading.ExceptHookArgs) -> None:
    if failure.exc_type is SystemExit:
        return
    where = "".join(
        f" ({last.filename}:{last.lineno})"
        for last in traceback.extract_tb(failure.exc_traceback)[-1:]
    )
    text = "".join(traceback.format_exception_only(failure.exc_type, failure.exc_value)).strip()
    name = failure.thread.name if failure.thread is not None else "?"
    print(printable(f"warning: thread {name} ended: {text}{where}"), file=sys.stderr)


def _few(names: list[str], limit: int = 5) -> str:
    more = f" and {len(names) - limit} more" if len(names) > limit else ""
    return ", ".join(names[:limit]) + more
