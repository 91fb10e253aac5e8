"""``crowdbot sweep``: try parameters of a planner on crowds that no challenge edition uses."""

from __future__ import annotations

import time
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import option
from crowdbot.cli.shared.options import Jobs, NoPlugins, Plugins, SuiteArgument, installed
from crowdbot.cli.shared.run_arguments import AsJson
from crowdbot.core.scoring.four_scores import PRIMARY
from crowdbot.core.support.text import rough_time

if TYPE_CHECKING:
    from crowdbot.core.campaign.plan import Plan
    from crowdbot.core.campaign.run import State


class SweepHow(StrEnum):
    """Ways in which trials are chosen."""

    grid = "grid"
    random = "random"
    optuna = "optuna"


def sweep(
    suite: SuiteArgument,
    planner: Annotated[str, option("NAME|FILE|file.py:Class", "The planner.")],
    vary: Annotated[
        list[str],
        option(
            "KEY=A,B|KEY=LOW..HIGH",
            "A parameter and its values, or range (:log, :int); repeatable.",
        ),
    ],
    how: Annotated[SweepHow, typer.Option(help="How trials are chosen.")] = SweepHow.random,
    trials: Annotated[
        int, typer.Option(min=1, max=10_000, metavar="N", help="Trials, unless --how grid.")
    ] = 20,
    steps: Annotated[
        int, typer.Option(min=2, max=100, metavar="N", help="Grid: values of a range.")
    ] = 4,
    metric: Annotated[str, option("NAME", "The score.")] = PRIMARY.metric,
    only: Annotated[list[str] | None, option("GLOB", "Only these scenarios; repeatable.")] = None,
    sample: Annotated[
        int, typer.Option(min=0, metavar="N", help="Number of scenarios, drawn at random; 0: all.")
    ] = 9,
    check: Annotated[
        int,
        typer.Option(min=0, metavar="N", help="Number of best trials to check with other people."),
    ] = 3,
    planner_set: Annotated[
        list[str] | None, option("KEY=VALUE", "Fixed parameters of the planner; repeatable.")
    ] = None,
    seed: Annotated[
        int,
        typer.Option(
            min=0, metavar="N", help="Seed of people and trials; people differ from the suite's."
        ),
    ] = 1,
    out: Annotated[Path, option("DIR", "Folder to write; the same one resumes the sweep.")] = Path(
        "sweep"
    ),
    jobs: Jobs = 0,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: AsJson = False,
) -> None:
    """Try parameters of a planner on crowds that no edition uses; check the best on other crowds.

    Example: crowdbot sweep challenge-2020 --planner dwa --vary margin=0.02..0.2 --vary speed=0.7,1
    """
    from crowdbot.cli.shared.campaign_run import run_plan, worker_count
    from crowdbot.core.campaign.sweep.axes import parse_axes
    from crowdbot.core.campaign.sweep.page import as_json as plain
    from crowdbot.core.campaign.sweep.page import render, verdict
    from crowdbot.core.campaign.sweep.search import PAGE, SweepRequest, known_metric, search
    from crowdbot.core.support.atomic_write import atomic_write

    registry = installed(plugin, no_plugins)
    variant, better = known_metric(registry, metric)
    request = SweepRequest(
        suite=suite, planner=planner, axes=parse_axes(vary), how=how.value, count=trials,
        steps=steps, seed=seed, metric=metric, variant=variant, better=better, only=only or (),
        sample=sample or None, check=check, out=out, settings=planner_set or (),
        plugins=plugin or (),
    )  # fmt: skip

    began, done = time.monotonic(), 0

    def execute(plan: Plan, title: str) -> State:
        nonlocal done
        left = (time.monotonic() - began) / max(1, done) * (request.rounds - done)
        say(title + (f" (about {rough_time(left)} left)" if done else ""), err=True)
        done += 1
        return run_plan(plan, worker_count(jobs), None)

    try:
        found = search(request, registry, execute)
    except KeyboardInterrupt:
        say("interrupted; the same command resumes the sweep", err=True)
        raise
    atomic_write(out / PAGE, render(found))
    if as_json:
        say_json(plain(found))
        return
    for line in verdict(found):
        say(line)
    say(f"page: {out / PAGE}")
