"""``crowdbot simulate``: run one scenario with one planner, record it, score it."""

from __future__ import annotations

import json
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli._options import (
    MEMORY_GIB,
    InProcess,
    NoPlugins,
    PlannerMemory,
    Plugins,
    installed,
    planner_place,
)
from crowdbot.cli._run_arguments import (
    AsJson,
    MeshcatPort,
    OutRoot,
    Overrides,
    Record,
    RecordChoice,
    RunSeed,
    ScenarioArgument,
    SpecArgument,
)

if TYPE_CHECKING:
    from crowdbot.core.runs.request import Run


def simulate(
    spec: SpecArgument,
    scenario: ScenarioArgument = None,
    planner: Annotated[
        list[str] | None,
        typer.Option(
            metavar="[ROBOT=]NAME|FILE|file.py:Class",
            help="The planner under test, dwa by default; repeatable with the names of robots.",
        ),
    ] = None,
    overrides: Overrides = None,
    planner_set: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=VALUE", help="Change the planner; repeatable."),
    ] = None,
    seed: RunSeed = 0,
    out: OutRoot = Path("runs"),
    record: Record = RecordChoice.all,
    references: Annotated[
        bool, typer.Option(help="Run robot_alone and crowd_alone where they are missing.")
    ] = True,
    force: Annotated[bool, typer.Option("--force", help="Run again what is complete.")] = False,
    step_budget: Annotated[
        float | None,
        typer.Option(metavar="SECONDS", help="Wall time that a planner step may take."),
    ] = None,
    in_process: InProcess = None,
    planner_memory: PlannerMemory = MEMORY_GIB,
    meshcat: MeshcatPort = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: AsJson = False,
) -> None:
    """Simulate one scenario with one planner; record, score and replay it.

    Example: crowdbot simulate challenge-2020 counter-d0250-dispersed-c20-r05 --planner dwa

    Several robots: crowdbot simulate two.yaml --planner a=dwa --planner b=mine.py:Mine
    """
    from crowdbot.cli._progress import show_progress
    from crowdbot.cli._serve_options import meshcat_view
    from crowdbot.core.scenarios.library import open_spec, pick
    from crowdbot.core.support.stdout_guard import stdout_to_stderr

    place = planner_place(in_process, planner_memory)
    with stdout_to_stderr():
        registry = installed(plugin, no_plugins)
        expansion = open_spec(spec, registry, overrides or ())
        chosen = pick(expansion, scenario)
        simulate_it = _import_simulate()
        watchers = meshcat_view(meshcat)
        with _interruptible() as stop, show_progress() as progress:
            run = simulate_it(
                chosen,
                registry,
                planner=_one_or_several(planner),
                planner_settings=planner_set or (),
                seed=seed,
                out=out,
                suite="scenarios" if expansion.single else expansion.suite_id,
                metrics=expansion.metrics,
                axes=expansion.axes.get(chosen.id, {}),
                words=expansion.words_of(chosen.id),
                position=expansion.scenarios.index(chosen),
                record=record.value,
                references=references,
                force=force,
                progress=progress,
                stop=stop,
                on_hang=_end_hung_process,
                step_budget=step_budget,
                place=place,
                watchers=watchers,
            )
    _print(run, as_json=as_json)
    if run.status == "planner_failed":
        raise typer.Exit(3)


def _one_or_several(planners: Sequence[str] | None) -> str:
    """The planner of all robots, or those of each, as `resolve_planner` takes them.

    Raises:
        UsageError: there are several, and one does not say of which robot it is.
    """
    from crowdbot.core.planning.fleet_choice import planners_by_robot
    from crowdbot.errors import UsageError

    given = list(planners or ("dwa",))
    for text in given if len(given) > 1 else ():
        if not planners_by_robot(text):
            raise UsageError(f"--planner {text}: of which robot? Write ROBOT={text}")
    return ",".join(given)


def _import_simulate() -> Callable[..., Run]:
    """Import Drake, which needs a system library that a bare machine may lack.

    Raises:
        MissingLibraryError: it is missing.
    """
    from crowdbot.errors import MissingLibraryError

    try:
        from crowdbot.core.sim.simulate import simulate as simulate_it
    except ImportError as error:
        if "libglib" not in str(error):
            raise
        raise MissingLibraryError(
            "Drake needs the system library libglib2.0; install it with "
            "'sudo apt-get install libglib2.0-0' (libglib2.0-0t64 on newer systems)"
        ) from error
    return simulate_it


class _Pressed(KeyboardInterrupt):
    """Ctrl-C, as opposed to a plugin that raises KeyboardInterrupt itself."""


@contextmanager
def _interruptible() -> Iterator[Callable[[], bool]]:
    """The first Ctrl-C asks the run to end and keep its recording; the second one insists.

    While nothing runs yet, as when kernels are compiled, the first one is enough.
    """
    asked = running = False

    def handler(number: int, frame: FrameType | None) -> None:
        nonlocal asked
        del number, frame
        if asked or not running:
            raise _Pressed
        asked = True

    def stop() -> bool:
        nonlocal running
        running = True
        return asked

    previous = signal.signal(signal.SIGINT, handler)
    try:
        yield stop
    finally:
        signal.signal(signal.SIGINT, previous)


def _end_hung_process() -> None:
    """A planner that swallows every interruption cannot be left in any other way."""
    print(
        "error: the planner did not return and could not be interrupted; "
        "the recording up to here is in the .partial directory",
        file=sys.stderr,
        flush=True,
    )
    os._exit(3)


def _print(run: Run, *, as_json: bool) -> None:
    from crowdbot.core.runs.run_directory import REPLAY, SCORES
    from crowdbot.core.scoring.scores_csv import headlines, read_scores_csv, scores_table

    rows = read_scores_csv(run.directory / SCORES)
    if run.replaced:
        print(
            f"note: it replaces a run that was recorded differently: {', '.join(run.replaced)}",
            file=sys.stderr,
        )
    if run.record["status"] == "planner_failed":
        print(f"error: {run.record['reason']}", file=sys.stderr)
    if as_json:
        scores = [
            {
                "metric": r.score.metric,
                "variant": r.score.variant,
                "value": r.score.value,
                "unit": r.score.unit,
                "status": r.score.status,
                "reason": r.score.reason,
                "lower": r.score.lower,
                "upper": r.score.upper,
            }
            for r in rows
        ]
        typer.echo(
            json.dumps(
                {**run.record, "directory": str(run.directory), "reused": run.reused,
                 "replaced": list(run.replaced), "scores": scores},
                indent=2,
            )
        )  # fmt: skip
        return
    from rich.console import Console

    console = Console()
    console.print(scores_table(headlines([r.score for r in rows])))
    console.print(_summary(run), highlight=False)
    console.print(f"all variants: {run.directory / SCORES}", soft_wrap=True, highlight=False)
    console.print(f"replay: {run.directory / REPLAY}", soft_wrap=True, highlight=False)


def _summary(run: Run) -> str:
    from crowdbot.core.runs.outcome import toppled
    from crowdbot.core.runs.provenance import remarks

    record = run.record
    ending = {
        "arrived": "arrived after {:.1f} s",
        "timeout": "did not arrive within {:.1f} s",
        "planner_failed": "planner failed at {:.1f} s",
    }[record["status"]].format(record["goal_time"] or record["sim_time"])
    if (fallen := record.get("toppled_time")) is not None:
        ending += f", {toppled(fallen)}"
    speed = f"{record['real_time_factor']:.1f} times real time"
    note = "; was complete already, --force runs it again" if run.reused else f" ({speed})"
    who = f"{record['scenario']} · {record['planner']['name']} · seed {record['seed']}"
    flags = "".join(f"; {flag.lower()}" for flag in remarks(record))
    return f"{who}: {ending}{note}{flags}"
