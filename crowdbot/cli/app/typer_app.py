"""The command line in typer: commands are modules, imported when called."""

from __future__ import annotations

import importlib
import logging
import re
import shlex
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup
from typer.exceptions import TyperException
from typer.main import get_command

from crowdbot.cli.app.command_names import command_groups, command_names, module_name
from crowdbot.cli.app.complete import offer
from crowdbot.cli.app.folded_help import fold_common
from crowdbot.cli.app.given_once import refuse_repetition
from crowdbot.errors import did_you_mean, nearest, printable

_SETTINGS: dict[str, Any] = {
    "add_completion": False,
    "pretty_exceptions_enable": False,
    "context_settings": {"help_option_names": ["-h", "--help"]},
}


#: Columns; 80 fit the longest option with its type and description.
_NARROW = 80


def run(words: list[str]) -> None:
    """Run a command line.

    Raises:
        SystemExit: always, with the exit code.
    """
    _whole(_is_narrow())(words, prog_name="crowdbot")


@cache
def _whole(narrow: bool) -> Any:
    """Return the whole command line application, for a narrow or a wide terminal."""
    command = get_command(_app(narrow))
    refuse_repetition(command)
    return command


@contextmanager
def _escaped_errors() -> Iterator[None]:
    """Escape hidden characters in the messages of usage errors, which repeat what was typed."""
    try:
        yield
    except TyperException as error:
        if isinstance(text := getattr(error, "message", None), str):
            error.message = printable(text) + _meant_runs(text, getattr(error, "ctx", None))
        raise


def _meant_runs(text: str, ctx: Any) -> str:
    """Return a hint on ``--runs`` if a folder was given as an argument; empty otherwise."""
    extra = re.fullmatch(r"Got unexpected extra argument\(?s?\)? \((.+)\)", text)
    takes_runs = ctx is not None and any("--runs" in p.opts for p in ctx.command.params)
    if not (extra and takes_runs and Path(extra[1]).is_dir()):
        return ""
    return f"; a folder of runs is given with --runs {shlex.quote(printable(extra[1]))}"


class _Commands(TyperGroup):
    """A group whose commands are the modules of this package."""

    def make_context(self, *args: Any, **given: Any) -> Any:
        """Parse options before the command's name, with hidden characters escaped in errors."""
        with _escaped_errors():
            return super().make_context(*args, **given)

    def invoke(self, ctx: Any) -> Any:
        """Run the command."""
        with _escaped_errors():
            return super().invoke(ctx)

    def list_commands(self, ctx: Any) -> list[str]:
        del ctx
        return list(command_groups())

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        known = command_names()
        if cmd_name not in known:
            near = did_you_mean(nearest(cmd_name, known))
            ctx.fail(f"no command '{cmd_name}'{near or '; see crowdbot --help'}")
        return load(cmd_name)


def load(name: str) -> Any:
    """Return the command of a module, with ``-v`` and ``-q`` added."""
    module, group = module_name(name), command_groups()[name]
    found = getattr(importlib.import_module(f"crowdbot.cli.commands.{group}.{module}"), module)
    return _command(found, name, group, _is_narrow())


@cache
def _command(found: Any, name: str, group: str, narrow: bool) -> Any:
    """Convert a function or a `typer.Typer` to a command, for a narrow or a wide terminal."""
    if not isinstance(found, typer.Typer):
        app = typer.Typer(**_SETTINGS)
        app.command(name=name)(found)
        found = app
    command: Any = get_command(found)
    command.name, command.rich_help_panel = name, group.capitalize()
    for one in (command, *getattr(command, "commands", {}).values()):
        one.help = _unwrapped(one.help)
        if one.help and not one.short_help:  # otherwise click would truncate it
            one.short_help = one.help.partition("\n\n")[0]
        if narrow:
            one.rich_markup_mode = None
        taken = {text for param in one.params for text in param.opts}
        one.params += [p for p in _verbosity_params() if not taken & set(p.opts)]
        refuse_repetition(one)
        fold_common(one)
        for param in one.params:
            if completes := offer(param.name):
                param._custom_shell_complete = completes
    return command


def _is_narrow() -> bool:
    """Return True if the terminal is too narrow for help with tables of options."""
    return shutil.get_terminal_size().columns < _NARROW


def _unwrapped(text: str | None) -> str | None:
    """Return a docstring's paragraphs as single lines, which help wraps to the screen's width."""
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
        "-v",
        "--verbose",
        help="Print more.",
        callback=_set_level(logging.DEBUG),
        expose_value=False,
    ),
]
_Quiet = Annotated[
    bool,
    typer.Option(
        "-q",
        "--quiet",
        help="Print errors only.",
        callback=_set_level(logging.WARNING),
        expose_value=False,
    ),
]


def _common(verbose: _Verbose = False, quiet: _Quiet = False) -> None:
    """Declare the options that every command has; their values are not used here."""


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


def _app(narrow: bool) -> typer.Typer:
    settings = {**_SETTINGS, "add_completion": True}
    if narrow:
        settings["rich_markup_mode"] = None
    app = typer.Typer(cls=_Commands, no_args_is_help=True, **settings)

    @app.callback()
    def crowdbot(
        verbose: _Verbose = False, quiet: _Quiet = False, version: _Version = False
    ) -> None:
        """A benchmark for robots that drive through dense crowds.

        Example: crowdbot simulate challenge-2020 in-d0125-slow-c01-r02 --planner dwa
        """

    return app
