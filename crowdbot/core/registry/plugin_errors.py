"""Describe errors from plugin code: type, text, and place."""

from __future__ import annotations

import signal
import sysconfig
import traceback
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from crowdbot.errors import Interrupted, PlannerHungError

#: Modules whose frames are not the cause of a plugin's error.
_PACKAGE = str(Path(__file__).parents[2])
#: Modules whose frames every command has.
_NO_PLUGINS = frozenset(("crowdbot", "click", "typer"))
_MACHINERY = tuple(f"{_PACKAGE}/{part}/" for part in ("core", "dsl", "cli"))


def describe_error(error: BaseException, sources: Collection[str] = ()) -> str:
    """Return type, text and place of an error.

    Args:
        sources: the plugin's known files; frames in them, beside them, or outside libraries are
            preferred.
    """
    return f"{error_text(error)}{_where(error, sources)}"


def error_text(error: BaseException) -> str:
    """Return type and text of an error, also if its text is empty."""
    kind, text = type(error).__name__, _text(error)
    return f"{kind}{f': {text}' if text else ''}"


@cache
def _plugin_roots() -> frozenset[str]:
    """Return the top module names of installed plugins; finding them takes milliseconds."""
    from importlib.metadata import entry_points

    found = entry_points(group="crowdbot")
    return frozenset(e.value.partition(":")[0].partition(".")[0] for e in found)


def culprit(error: BaseException) -> str:
    """Return `` (file:line)`` of the innermost frame in a plugin; empty if there is none."""
    found = ""
    for frame, line in traceback.walk_tb(error.__traceback__):
        root = str(frame.f_globals.get("__name__")).partition(".")[0]
        file = frame.f_code.co_filename
        if root not in _NO_PLUGINS and (not _is_a_library(file) or root in _plugin_roots()):
            found = f" ({file}:{line})"
    return found


def is_user_interrupt(error: BaseException) -> bool:
    """Return True if an error is the user's Ctrl-C or our own interruption, not the plugin's.

    A plugin may also raise KeyboardInterrupt. Python's own handler makes both look alike, so
    commands install a handler that raises a subclass.
    """
    if isinstance(error, Interrupted | PlannerHungError):
        return True
    if not isinstance(error, KeyboardInterrupt):
        return False
    default = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    return default or type(error) is not KeyboardInterrupt


class UserInterrupt(KeyboardInterrupt):
    """Ctrl-C, distinguished from a plugin that raises KeyboardInterrupt."""


@contextmanager
def telling_interrupts() -> Iterator[None]:
    """Raise `UserInterrupt` on Ctrl-C in the context, to tell it from a plugin's interrupt.

    Does nothing if Ctrl-C already has a handler, or outside the main thread.
    """

    def press(number: int, frame: object) -> None:
        del number, frame
        raise UserInterrupt

    try:
        theirs = signal.getsignal(signal.SIGINT) is not signal.default_int_handler
        previous = None if theirs else signal.signal(signal.SIGINT, press)
    except ValueError:  # not the main thread
        previous = None
    try:
        yield
    finally:
        if previous is not None:
            signal.signal(signal.SIGINT, previous)


def _text(error: BaseException) -> str:
    try:
        return str(error)
    except BaseException as another:
        if is_user_interrupt(another):
            raise
        return f"(its text raises {type(another).__name__})"


def _where(error: BaseException, sources: Collection[str]) -> str:
    """Return `` (file:line)`` of the innermost frame of the plugin, or ""."""
    frames = [
        f for f in traceback.extract_tb(error.__traceback__) if not f.filename.startswith("<")
    ]
    own = [f for f in frames if _is_own(f.filename, sources)]
    if not own and (isinstance(error, SyntaxError) or not frames):
        return ""
    frame = (own or frames)[-1]
    return f" ({frame.filename}:{frame.lineno})" if not _is_ours(frame.filename) else ""


def _is_ours(file: str) -> bool:
    return file.startswith(_MACHINERY)


def _is_own(file: str, sources: Collection[str]) -> bool:
    """Return True for a planner's file, a file beside it, or a file outside installed libraries."""
    if file in sources or Path(file).parent in {Path(s).parent for s in sources}:
        return True
    return not _is_ours(file) and not _is_a_library(file)


def _is_a_library(file: str) -> bool:
    """Return True for files not written for crowdbot: Python's own, and installed packages."""
    libraries = {sysconfig.get_path(p) for p in ("stdlib", "platstdlib", "purelib", "platlib")}
    return file.startswith(("<", *(p for p in libraries if p)))
