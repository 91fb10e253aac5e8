"""The command line: one file per command, found by its name, imported when it is called.

A module ``crowdbot/cli/commands/GROUP/x.py`` offers the command ``x``: a function ``x``, or a
`typer.Typer` named ``x`` for a command with commands of its own. Its docstring ends with an
example. Heavy imports stay inside functions: ``--help`` imports every command.
"""

from __future__ import annotations

import logging
import os
import re
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext, redirect_stdout
from pathlib import Path

from crowdbot.cli.app.command_names import command_names
from crowdbot.cli.app.mishaps import left_by, tell_of_threads
from crowdbot.cli.app.streams import prepare_streams
from crowdbot.core.registry.plugin_errors import telling_interrupts
from crowdbot.core.support.gc_throttle import throttle_gc
from crowdbot.core.support.skip_final_gc import end_without_collecting
from crowdbot.errors import (
    CrowdbotError,
    InputError,
    PluginError,
    RecordingWarning,
    SpecError,
    printable,
)
from crowdbot.shown_warnings import warnings_to

__all__ = ["command_names", "main"]


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit code; the user sees only messages, no tracebacks.

    Args:
        argv: arguments without the program's name; default: those of the process.
    """
    if argv is None:
        end_without_collecting()
    prepare_streams()
    _start_log()
    tell_of_threads()
    try:
        with telling_interrupts(), warnings_to(_say_warning, RecordingWarning):
            return _run(argv)
    except CrowdbotError as error:
        _say(_text(error))
        return error.exit_code
    except (KeyboardInterrupt, SystemExit) as error:
        if message := left_by(error):
            _say(message)
        return PluginError.exit_code if message else 130
    except OSError as error:
        from crowdbot.cli.app.mishaps import no_one_reads, system_error

        if isinstance(error, BrokenPipeError) and no_one_reads(sys.stdout, sys.stderr):
            _drop_output()
            return 0
        _say(system_error(error))
        return 1
    except MemoryError as error:
        details = f" ({error})" if str(error) else ""
        _say(
            f"error: there is not enough memory{details}; 'free -h' and 'ulimit -v' show the limits"
        )
        return 1
    except Exception as error:
        if os.environ.get("CROWDBOT_DEBUG"):
            raise
        from crowdbot.cli.app.mishaps import ended_process, internal_error, link_loop, system_error

        if loop := link_loop(error):
            _say(system_error(loop))
            return 1
        if ended := ended_process(error):
            _say(ended)
            return 1
        _say(internal_error(error))
        return 4


def _run(argv: Sequence[str] | None) -> int:
    if re.fullmatch(r"\s*(-\d+|0+)\s*", os.environ.get("NUMBA_NUM_THREADS", "")):
        raise InputError("the environment's NUMBA_NUM_THREADS must be above 0, or not set")
    words = sys.argv[1:] if argv is None else list(argv)
    if argv is None and not _LOADING.isdisjoint(words[:1]):
        throttle_gc()
    if argv is None and not _READING.isdisjoint(words[:1]):
        # Pydantic would search every distribution for plugins that only monitor services.
        os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    try:
        with _silence() if _wants_silence(words) else nullcontext():
            _dispatch(words)
        sys.stdout.flush()
    except SystemExit as done:
        if isinstance(done.__context__, BrokenPipeError):  # rich's, which drops the output itself
            return 0
        if left_by(done):
            raise
        sys.stdout.flush()
        if isinstance(done.code, str):  # a library's, such as Drake's
            raise RuntimeError(done.code) from done
        return done.code if isinstance(done.code, int) else int(done.code is not None)
    return 0


def _dispatch(words: list[str]) -> None:
    """Run a command. Typer is imported only here, after ``-q`` took effect."""
    from crowdbot.cli.app.typer_app import run

    run(words)


#: Commands that read documents, print facts and exit: their process is short.
_READING = frozenset(("expand", "plugins", "validate"))
#: Commands that spend their time on loading libraries and documents before a run begins.
_LOADING = _READING | {"campaign", "simulate"}

#: Commands whose output only reports their actions; with ``-q`` they print errors only.
_TELLING = frozenset(
    ("bundle", "campaign", "challenge-page", "evaluate", "export-urdf", "judge", "leaderboard",
     "lock", "report", "seal", "simulate", "validate", "verify", "view")
)  # fmt: skip


def _say_warning(text: str, *_: object) -> None:
    """Print a warning about a recording as a message, without file and line of crowdbot's code."""
    _say(f"warning: {text}")


def _wants_silence(words: Sequence[str]) -> bool:
    """Return True if a command line asks for errors only."""
    options = set(words)
    quiet = any(w == "--quiet" or re.fullmatch("-v*q[qv]*", w) for w in words)
    return quiet and not _TELLING.isdisjoint(words[:2]) and not options & {"--json", "-h", "--help"}


@contextmanager
def _silence() -> Iterator[None]:
    """Suppress stdout; messages on stderr remain."""
    with Path(os.devnull).open("w", encoding="utf-8") as nowhere, redirect_stdout(nowhere):
        yield


def _start_log() -> None:
    """Send messages of crowdbot's loggers to stderr unchanged."""
    log = logging.getLogger("crowdbot")
    handler = logging.StreamHandler()
    handler.setFormatter(_Printable())
    log.handlers = [handler]
    log.setLevel(logging.INFO)


class _Printable(logging.Formatter):
    """A formatter that escapes untrusted text in messages."""

    def format(self, record: logging.LogRecord) -> str:
        return printable(super().format(record))


def _text(error: CrowdbotError) -> str:
    if isinstance(error, SpecError):
        from crowdbot.dsl.text.diagnostics import render

        return render(error.diagnostics)
    return f"error: {error}"


def _say(text: str) -> None:
    print(printable(text), file=sys.stderr)


def _drop_output() -> None:
    """Redirect output to the null device, since flushing a closed pipe at exit would fail."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
