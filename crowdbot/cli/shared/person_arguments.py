"""Arguments shared by commands that put a person into a run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from crowdbot.cli.shared.option import option, switch

PagePort = Annotated[
    int, typer.Option(min=0, max=65535, help="Port of the page on 127.0.0.1; 0: a free one.")
]
OpenPage = Annotated[bool, switch("--open", "Open the page in the browser.")]
Rate = Annotated[
    float,
    typer.Option(
        min=0.1, max=10.0, metavar="FACTOR", help="Speed of the simulation; 1: real time."
    ),
]
ReplayRun = Annotated[
    Path | None, option("RUN_DIR", "No page: the commands that this run recorded, once more.")
]
