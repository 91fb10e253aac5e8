"""Options and arguments of commands in their usual form: a name of the value, and its meaning."""

from __future__ import annotations

from typing import Any

import typer


def option(metavar: str, text: str, *flags: str) -> Any:
    """Return an option with a value; its flag is the parameter's name if none is given."""
    return typer.Option(*flags, metavar=metavar, help=text)


def argument(metavar: str, text: str) -> Any:
    """Return an argument."""
    return typer.Argument(metavar=metavar, help=text)


def switch(flag: str, text: str) -> Any:
    """Return an option without a value."""
    return typer.Option(flag, help=text)
