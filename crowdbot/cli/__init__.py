"""The command line: one file per command, found by its name, imported when it is called.

A module ``crowdbot/cli/x.py`` offers the command ``x``: a function ``x``, or a `typer.Typer`
named ``x`` for a command with commands of its own. Its docstring ends with an example. Heavy
imports stay inside functions: ``--help`` imports every command. Modules that begin with an
underscore are not commands.
"""

from __future__ import annotations

import importlib
import io
import logging
import os
import pkgutil
import re
import shutil
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext, redirect_stdout
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup
from typer.main import get_command

from crowdbot.cli._complete import offer
from crowdbot.cli._mishaps import left_by, tell_of_threads
from crowdbot.core.registry.plugin_errors import telling_interrupts
from crowdbot.core.support.quick_exit import end_without_collecting
from crowdbot.core.support.seldom_collected import collect_seldom
from crowdbot.errors import CrowdbotError, PluginError, SpecError, did_you_mean, nearest, printable

_SETTINGS: dict[str, Any] = {
    "add_completion": False,
    "pretty_exceptions_enable": False,
    "context_settings": {"help_option_names": ["-h", "--help"]},
}


#: Columns; 80 have room for the longest option beside its type and what it does.
_NARROW = 80


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit code; nothing but messages reaches the user.

    Args:
        argv: arguments without the program's name; default: those of the process.
    """
    if argv is None:
        end_without_collecting()
    _tolerate_any_encoding()
    tell_of_threads()
    try:
        with telling_interrupts():
            return _run(argv)
    except CrowdbotError as error:
        _say(_text(error))
        return error.exit_code
    except (KeyboardInterrupt, SystemExit) as error:
        if said := left_by(error):
            _say(said)
        return PluginError.exit_code if said else 130
    except BrokenPipeError:
        _drop_output()
        return 0
    except OSError as error:
        _say(f"error: {error.filename or 'operating system'}: {error.strerror or error}")
        return 1
    except Exception as error:
        if os.environ.get("CROWDBOT_DEBUG"):
            raise
        from crowdbot.cli._mishaps import internal_error

        _say(internal_error(error))
        return 4


def _run(argv: Sequence[str] | None) -> int:
    words = sys.argv[1:] if argv is None else list(argv)
    if argv is None and not _READING.isdisjoint(words[:1]):
        collect_seldom()
    try:
        with _silence() if _wants_silence(words) else nullcontext():
            get_command(_app())(words, prog_name="crowdbot")
        sys.stdout.flush()
    except SystemExit as done:
        if isinstance(done.__context__, BrokenPipeError):  # rich makes an exit of it
            raise done.__context__ from None
        if left_by(done):
            raise
        sys.stdout.flush()
        return done.code if isinstance(done.code, int) else int(done.code is not None)
    return 0


#: Commands that read documents, tell about them, and are over: a process of theirs is short.
_READING = frozenset(("expand", "plugins", "validate"))

#: Commands whose output only tells what they did; with ``-q`` they say only what went wrong.
_TELLING = frozenset(
    ("bundle", "campaign", "evaluate", "export-urdf", "lock", "report", "simulate", "validate",
     "verify", "view")
)  # fmt: skip


def _wants_silence(words: Sequence[str]) -> bool:
    """Whether a command line asks for nothing but what went wrong."""
    options = set(words)
    quiet = any(w == "--quiet" or re.fullmatch("-v*q[qv]*", w) for w in words)
    return quiet and not _TELLING.isdisjoint(words[:2]) and not options & {"--json", "-h", "--help"}


@contextmanager
def _silence() -> Iterator[None]:
    """Nothing on stdout; messages on stderr stay."""
    with Path(os.devnull).open("w", encoding="utf-8") as nowhere, redirect_stdout(nowhere):
        yield


class _Commands(TyperGroup):
    """The commands are the modules of this package."""

    def list_commands(self, ctx: Any) -> list[str]:
        del ctx
        return command_names()

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        known = command_names()
        if cmd_name not in known:
            near = did_you_mean(nearest(cmd_name, known))
            ctx.fail(f"no command '{cmd_name}'{near or '; see crowdbot --help'}")
        return _load(cmd_name)


def command_names() -> list[str]:
    """Names of all commands, sorted."""
    modules = (m.name for m in pkgutil.iter_modules(__path__))
    return sorted(m.replace("_", "-") for m in modules if not m.startswith("_"))


def _load(name: str) -> Any:
    """The command of one module, with ``-v`` and ``-q`` added."""
    module = name.replace("-", "_")
    found = getattr(importlib.import_module(f"{__name__}.{module}"), module)
    if not isinstance(found, typer.Typer):
        app = typer.Typer(**_SETTINGS)
        app.command(name=name)(found)
        found = app
    command = get_command(found)
    command.name = name
    for one in (command, *getattr(command, "commands", {}).values()):
        one.help = _unwrapped(one.help)
        if one.help and not one.short_help:  # or else click would leave out its end
            one.short_help = one.help.partition("\n\n")[0]
        if _is_narrow():
            one.rich_markup_mode = None
        taken = {text for param in one.params for text in param.opts}
        one.params += [p for p in _verbosity_params() if not taken & set(p.opts)]
        for param in one.params:
            if completes := offer(param.name):
                param._custom_shell_complete = completes
    return command


def _is_narrow() -> bool:
    """Whether a table of options would cut their names off, which plain help does not."""
    return shutil.get_terminal_size().columns < _NARROW


def _unwrapped(text: str | None) -> str | None:
    """Paragraphs of a docstring as single lines, which help wraps to the width of the screen."""
    if text is None:
        return None
    return "\n\n".join(" ".join(part.split("\n")) for part in text.split("\n\n"))


def _set_level(level: int) -> Any:
    def callback(value: bool) -> None:
        if value:
            logging.getLogger("crowdbot").setLevel(level)

    return callback


_Verbose = Annotated[
    bool,
    typer.Option(
        "-v", "--verbose", help="Say more.", callback=_set_level(logging.DEBUG), expose_value=False
    ),
]
_Quiet = Annotated[
    bool,
    typer.Option(
        "-q",
        "--quiet",
        help="Say only what went wrong.",
        callback=_set_level(logging.WARNING),
        expose_value=False,
    ),
]


def _common(verbose: _Verbose = False, quiet: _Quiet = False) -> None:
    """Options that every command has."""


def _verbosity_params() -> list[Any]:
    app = typer.Typer(**_SETTINGS)
    app.command()(_common)
    return list(get_command(app).params)


def _show_version(value: bool) -> None:
    if value:
        from importlib.metadata import version

        typer.echo(f"crowdbot {version('crowdbot')}")
        raise typer.Exit


_Version = Annotated[
    bool,
    typer.Option(
        "--version", help="Print the version.", callback=_show_version, is_eager=True,
        expose_value=False,
    ),
]  # fmt: skip


def _app() -> typer.Typer:
    _start_log()
    settings = {**_SETTINGS, "add_completion": True}
    if _is_narrow():
        settings["rich_markup_mode"] = None
    app = typer.Typer(cls=_Commands, no_args_is_help=True, **settings)

    @app.callback()
    def crowdbot(
        verbose: _Verbose = False, quiet: _Quiet = False, version: _Version = False
    ) -> None:
        """A benchmark for robots that drive through dense human crowds.

        Example: crowdbot simulate challenge-2020 in-d0125-slow-c01-r02 --planner dwa
        """

    return app


def _start_log() -> None:
    """Messages of crowdbot's loggers go to stderr as they are."""
    log = logging.getLogger("crowdbot")
    handler = logging.StreamHandler()
    handler.setFormatter(_Printable())
    log.handlers = [handler]
    log.setLevel(logging.INFO)


class _Printable(logging.Formatter):
    """Messages quote what strangers wrote."""

    def format(self, record: logging.LogRecord) -> str:
        return printable(super().format(record))


def _text(error: CrowdbotError) -> str:
    if isinstance(error, SpecError):
        from crowdbot.dsl.diagnostics import render

        return render(error.diagnostics)
    return f"error: {error}"


def _say(text: str) -> None:
    print(printable(text), file=sys.stderr)


def _tolerate_any_encoding() -> None:
    """A terminal that cannot show a character gets an escape instead of an error."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def _drop_output() -> None:
    """Keep the interpreter from flushing into the closed pipe at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
