"""Declare options and arguments of commands with a name for the value and a help text."""

from __future__ import annotations

from typing import Any

import typer


def option(metavar: str, text: str, *flags: str) -> Any:
    """Return an option with a value; without ``flags``, the parameter's name is the flag."""
    return typer.Option(*flags, metavar=metavar, help=text)


def argument(metavar: str, text: str) -> Any:
    """Return a positional argument."""
    return typer.Argument(metavar=metavar, help=text)


def switch(flag: str, text: str) -> Any:
    """Return an option without a value."""
    return typer.Option(flag, help=text)
