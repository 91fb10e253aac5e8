"""Options shared by several commands."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli.shared.installed import installed
from crowdbot.cli.shared.option import argument, option, switch

if TYPE_CHECKING:
    from crowdbot.core.planning.choice import PlannerPlace

__all__ = [
    "MEMORY_GIB",
    "InProcess",
    "NoPlugins",
    "PlannerMemory",
    "Plugins",
    "ReplaceDraws",
    "check_ending",
    "installed",
    "planner_place",
]

SuiteArgument = Annotated[str, argument("SUITE", "File, or name of a suite.")]
OnlyScenarios = Annotated[
    list[str] | None, option("GLOB", "Only scenarios that match; repeatable.")
]
EveryScenarioSet = Annotated[
    list[str] | None, option("KEY=VALUE", "Set a value in every scenario; repeatable.", "--set")
]
Jobs = Annotated[int, typer.Option(min=0, help="Processes; 0 is one for each core.")]
OwnRecordings = Annotated[
    list[Path] | None,
    typer.Option(
        metavar="FILE",
        help="Recordings of your own: .mcap, .csv (t,id,x,y), .ndjson "
        "(TrajNet++), .txt, .vsp (ETH, UCY), a bag of ROS or BAG:/TOPIC; repeatable.",
    ),
]
PixelsToMetres = Annotated[
    str | None,
    option(
        "FILE|M", "Where places are pixels: a file with the 3 x 3 matrix to metres, or m/pixel."
    ),
]
FrameRate = Annotated[
    float | None,
    option("HZ", "Frames per second, where a table counts frames, or of a data set's video."),
]
ScenarioSet = Annotated[
    list[str] | None, option("KEY=VALUE", "Set a value of the scenario; repeatable.", "--set")
]
PlannerSet = Annotated[
    list[str] | None, option("KEY=VALUE", "Set a parameter of the planner; repeatable.")
]
MakeReferences = Annotated[
    bool, typer.Option(help="First run robot_alone and crowd_alone, unless done before.")
]
Plugins = Annotated[
    list[Path] | None,
    option(
        "PATH", "A plugin that is not installed: file, package or project; repeatable.", "--plugin"
    ),
]
NoPlugins = Annotated[bool, switch("--no-plugins", "Only crowdbot's own, and those of --plugin.")]
InProcess = Annotated[
    bool | None,
    typer.Option(
        "--in-process/--own-process",
        help="Where planners run; default: crowdbot's own inside, others in separate processes.",
        show_default=False,
    ),
]
PlannerMemory = Annotated[
    float,
    typer.Option(metavar="GIB", min=0.0, help="Memory of a planner's process; 0: no limit."),
]
ReplaceDraws = Annotated[
    int,
    typer.Option(
        min=0,
        max=3,
        help="Make a run again with the next draw, at most so often, if its robot was struck "
        "from behind without fault and toppled.",
    ),
]
#: Minimum; a Python with numpy needs about a third of it.
_LEAST_GIB = 0.5
#: Default of `PlannerMemory`, GiB.
MEMORY_GIB = 4.0


def check_ending(out: Path | None, *endings: str) -> None:
    """Refuse an ``--out`` file whose suffix does not match its contents.

    Args:
        out: the option's value, or None.
        endings: allowed suffixes, such as ``.html``.

    Raises:
        UsageError: the suffix is not allowed.
    """
    from crowdbot.errors import UsageError

    if out is not None and out.suffix.lower() not in endings:
        known = " or ".join(filter(None, [", ".join(endings[:-1]), endings[-1]]))
        raise UsageError(f"--out {out}: the name must end in {known}")


def planner_place(
    in_process: bool | None, memory: float, *, lenient: bool = False, contained: bool = False
) -> PlannerPlace:
    """Return where planners run.

    Args:
        in_process: as `InProcess`.
        memory: as `PlannerMemory`.
        lenient, contained: as in `PlannerPlace`.

    Raises:
        UsageError: the memory is too small for any process.
    """
    from crowdbot.core.planning.choice import PlannerPlace
    from crowdbot.errors import UsageError

    if not memory < 2**20 or 0.0 < memory < _LEAST_GIB:
        raise UsageError(f"--planner-memory {memory:g}: 0, or at least {_LEAST_GIB:g} GiB")
    limit = round(memory * 2**30) if memory else None
    return PlannerPlace(in_process=in_process, memory=limit, lenient=lenient, contained=contained)
