"""Print untrusted text with control characters escaped, so that it cannot control the terminal."""

from __future__ import annotations

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
