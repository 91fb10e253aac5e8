"""Every argument and option that takes a file: what is no plain, small text ends with an error.

The options are those that the commands have, so that a new one is tested, too.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click
import pytest
import typer.main

from crowdbot.cli import main
from crowdbot.cli.app.typer_app import app

#: Words that name files although they are text, by metavar or name of the parameter.
_NAMES_OF_FILES = ("SPEC", "FILE", "RUN", "BUNDLE", "PATH", "CSV", "YAML", "MCAP")
#: Parameters that are written, or whose text is no file: reasons why they are left out.
_WRITTEN = {"out", "save"}
_OTHER = {
    ("plugins", "new"): "makes a project",
    ("draws", "make_public"): "is no file",
}
#: What has to be given as well, per command.
_ALSO: dict[str, list[str]] = {}
#: Seconds until an invocation counts as one that waits for ever.
_PATIENCE = 20


def _commands(group: click.Group, path: tuple[str, ...] = ()) -> Iterator[tuple[str, click.Command]]:
    for name, command in group.commands.items():
        if isinstance(command, click.Group):
            yield from _commands(command, (*path, name))
        else:
            yield " ".join((*path, name)), command


def _takes_a_file(parameter: click.Parameter) -> bool:
    if parameter.name in _WRITTEN or getattr(parameter, "hidden", False):
        return False
    if isinstance(parameter.type, click.Path) or "Path" in type(parameter.type).__name__:
        return True
    shown = (parameter.metavar or "").upper()
    return any(word in shown for word in _NAMES_OF_FILES)


def _places() -> list[tuple[str, str]]:
    group = typer.main.get_command(app())
    assert isinstance(group, click.Group)
    return [
        (name, str(parameter.name))
        for name, command in _commands(group)
        for parameter in command.params
        if _takes_a_file(parameter)
    ]
