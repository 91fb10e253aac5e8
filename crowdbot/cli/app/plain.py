"""Command lines of names alone, called without reading them with typer.

To import typer and have it look at one command takes some 50 ms of processor time, a tenth of
``crowdbot validate challenge-2021``. What is printed, and the exit code, are the same.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from functools import partial


def plain_call(words: Sequence[str]) -> Callable[[], int] | None:
    """What runs a command line that needs no parser and returns the exit code; None for all others.

    Args:
        words: arguments without the program's name.
    """
    command, names = words[:1], list(words[1:])
    if "_CROWDBOT_COMPLETE" in os.environ or not names or any(n[:1] == "-" for n in names[:1]):
        return None
    if command == ["validate"] and not any(n[:1] == "-" for n in names):
        return partial(_validate, names)
    if command == ["expand"] and names[1:] in ([], ["--count"]):
        return partial(_expand, names[0], count=bool(names[1:]))
    return None


def _validate(specs: Sequence[str]) -> int:
    from crowdbot.cli.output.checked_documents import check_documents
    from crowdbot.cli.shared.installed import installed

    return check_documents(specs, installed(None))


def _expand(spec: str, *, count: bool) -> int:
    from crowdbot.cli.output.scenario_list import print_scenarios
    from crowdbot.cli.shared.installed import installed
    from crowdbot.core.scenarios.library import open_spec

    registry = installed(None)
    print_scenarios(open_spec(spec, registry).scenarios, registry, count=count)
    return 0
