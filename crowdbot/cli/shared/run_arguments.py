"""Arguments shared by commands that make a run."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from crowdbot.cli.shared.option import argument, option, switch


class RecordChoice(StrEnum):
    """Levels of simulated and recorded sensors."""

    all = "all"
    used = "used"
    none = "none"


SpecArgument = Annotated[str, argument("SPEC", "File, or name of a suite.")]
ScenarioArgument = Annotated[
    str | None, argument("[ID]", "Scenario: id, unique prefix or pattern.")
]
Overrides = Annotated[
    list[str] | None, option("KEY=VALUE", "Set a value of the scenario; repeatable.", "--set")
]
RunSeed = Annotated[int, typer.Option(min=0, help="Run seed: sensor noise and planner.")]
OutRoot = Annotated[Path, option("DIR", "Root of the run directories.")]
Record = Annotated[RecordChoice, typer.Option(help="Sensors to simulate and record.")]
AsJson = Annotated[bool, switch("--json", "JSON on stdout.")]
AllScores = Annotated[bool, switch("--all", "Print all scores, instead of the four that matter.")]
MeshcatPort = Annotated[
    int | None,
    typer.Option(
        "--meshcat", min=1024, max=65535, metavar="PORT",
        help="Show the run in a browser while it goes on.",
    ),
]  # fmt: skip
