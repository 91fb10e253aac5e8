"""What somebody else's code raised: whose it is, and where it happened."""

from __future__ import annotations

import signal
import sysconfig
import traceback
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from crowdbot.errors import Interrupted, PlannerHungError

#: Frames of crowdbot's machinery are not where somebody else's error is.
_PACKAGE = str(Path(__file__).parents[2])
#: Modules whose frames every command has.
_NO_PLUGINS = frozenset(("crowdbot", "click", "typer"))
_MACHINERY = tuple(f"{_PACKAGE}/{part}/" for part in ("core", "dsl", "cli"))


def describe_error(error: BaseException, sources: Collection[str] = ()) -> str:
    """Type, text and place of an error.

    Args:
        error: what was raised.
        sources: files in which the culprit is known to be written; frames in them, beside them or
            in nobody's library are preferred.
    """
    return f"{error_text(error)}{_where(error, sources)}"


def error_text(error: BaseException) -> str:
    """Type and text of an error, also of one that has no text."""
    kind, text = type(error).__name__, _text(error)
    return f"{kind}{f': {text}' if text else ''}"


@cache
def _plugin_roots() -> frozenset[str]:
    """First names of the modules of installed plugins; looking for them takes milliseconds."""
    from importlib.metadata import entry_points

    found = entry_points(group="crowdbot")
    return frozenset(e.value.partition(":")[0].partition(".")[0] for e in found)


def culprit(error: BaseException) -> str:
    """`` (file:line)`` of the innermost frame that is in a plugin; empty where none is."""
    found = ""
    for frame, line in traceback.walk_tb(error.__traceback__):
        root = str(frame.f_globals.get("__name__")).partition(".")[0]
        file = frame.f_code.co_filename
        if root not in _NO_PLUGINS and (not _is_a_library(file) or root in _plugin_roots()):
            found = f" ({file}:{line})"
    return found


def is_user_interrupt(error: BaseException) -> bool:
    """Whether an error is not the plugin's: the user's Ctrl-C, or our own interruption.

    A plugin may raise KeyboardInterrupt, too. While Python's own handler is in place, nobody can
    tell the two apart; commands install one that raises a subclass.
    """
    if isinstance(error, Interrupted | PlannerHungError):
        return True
    if not isinstance(error, KeyboardInterrupt):
        return False
    default = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    return default or type(error) is not KeyboardInterrupt


class UserInterrupt(KeyboardInterrupt):
    """Ctrl-C, as opposed to a plugin that raises KeyboardInterrupt itself."""


@contextmanager
def telling_interrupts() -> Iterator[None]:
    """Ctrl-C raises a class of its own inside, so that a plugin's own interrupt can be told.

    Does nothing where somebody handles Ctrl-C already, or in another thread than the main one.
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
    """`` (file:line)`` of the innermost frame of the culprit, or nothing."""
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
    """A planner's file, a file beside it, or any file that is not an installed library."""
    if file in sources or Path(file).parent in {Path(s).parent for s in sources}:
        return True
    return not _is_ours(file) and not _is_a_library(file)


def _is_a_library(file: str) -> bool:
    """Whether nobody wrote a file for crowdbot: Python's own, and what is installed."""
    libraries = {sysconfig.get_path(p) for p in ("stdlib", "platstdlib", "purelib", "platlib")}
    return file.startswith(("<", *(p for p in libraries if p)))
