"""Options that several commands have, and what they make of the installation."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from crowdbot.core.planning.choice import PlannerPlace
    from crowdbot.core.registry.registry import Registry

Plugins = Annotated[
    list[Path] | None,
    typer.Option(
        "--plugin",
        metavar="PATH",
        help="A plugin that is not installed: file, package or project; repeatable.",
    ),
]
NoPlugins = Annotated[
    bool, typer.Option("--no-plugins", help="Only crowdbot's own, and those of --plugin.")
]
InProcess = Annotated[
    bool | None,
    typer.Option(
        "--in-process/--own-process",
        help="Where planners run; default: crowdbot's own inside, all others in their own.",
        show_default=False,
    ),
]
PlannerMemory = Annotated[
    float,
    typer.Option(metavar="GIB", min=0.0, help="Memory of a planner's process; 0: any."),
]
#: A Python with numpy needs about a third of it.
_LEAST_GIB = 0.5
#: Default of `PlannerMemory`, GiB.
MEMORY_GIB = 4.0


def planner_place(in_process: bool | None, memory: float, *, lenient: bool = False) -> PlannerPlace:
    """Where planners are to run.

    Args:
        in_process: as `InProcess`.
        memory: as `PlannerMemory`.
        lenient: as in `PlannerPlace`.

    Raises:
        UsageError: no process can start with so little.
    """
    from crowdbot.core.planning.choice import PlannerPlace
    from crowdbot.errors import UsageError

    if not memory < 2**20 or 0.0 < memory < _LEAST_GIB:
        raise UsageError(f"--planner-memory {memory:g}: 0, or at least {_LEAST_GIB:g} GiB")
    limit = round(memory * 2**30) if memory else None
    return PlannerPlace(in_process=in_process, memory=limit, lenient=lenient)


def installed(
    plugin: Sequence[Path] | None, no_plugins: bool = False, *, strict: bool = True
) -> Registry:
    """The registry that a command works with.

    Args:
        plugin: paths given by hand.
        no_plugins: leave out all that are installed.
        strict: refuse a plugin given by hand that failed; otherwise it is listed as such.

    Raises:
        InputError: there is nothing at a path.
        PluginError: a plugin given by hand failed.
    """
    from crowdbot.core.support.seldom_collected import seldom_collected
    from crowdbot.core.support.stdout_guard import stdout_to_stderr
    from crowdbot.errors import InputError, PluginError

    paths = list(plugin or ())
    for path in paths:
        if not path.exists():
            raise InputError(f"--plugin {path}: no such file or folder")
    with seldom_collected(), stdout_to_stderr():
        from crowdbot.core.registry.registry import discover

        registry = discover(extra=paths, allow=() if no_plugins else None)
    log = logging.getLogger("crowdbot")
    for line in registry.unknown_allowed():
        log.warning(line)
    for found in registry.plugins:
        if strict and found.error and found.given:
            log.debug(found.traceback)
            raise PluginError(f"--plugin {found.distribution}: {found.error}")
    return registry
