"""Print untrusted text with control characters escaped, so that it cannot control the terminal."""

from __future__ import annotations

import json
from typing import Any

import typer

from crowdbot.errors import printable


def say(text: object = "", *, err: bool = False, nl: bool = True) -> None:
    """Print a text with hidden characters escaped.

    Args:
        text: printed as by ``str``.
        err: True for stderr.
        nl: True to end the line.
    """
    typer.echo(printable(str(text)), err=err, nl=nl)


def say_json(document: object, **options: Any) -> None:
    """Print a document as indented JSON, as ``--json`` of the commands does.

    Args:
        document: anything that JSON can hold.
        options: further arguments of `json.dumps`.

    Raises:
        ValueError, TypeError: JSON cannot hold it.
    """
    say(json.dumps(document, indent=2, **options))
