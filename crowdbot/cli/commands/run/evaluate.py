"""``crowdbot evaluate``: score recordings again."""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatch
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, check_ending, installed
from crowdbot.errors import UnknownNameError, UsageError

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.runs.rescore import Rescored, RescoreRequest

_Runs = Annotated[
    list[Path] | None,
    argument(
        "RUN_DIR|FILE.mcap...",
        "Recordings, run directories, or folders with run directories below them.",
    ),
]
_Alone = Annotated[Path | None, option("FILE", "Recording of the same robot without people.")]
_Crowd = Annotated[Path | None, option("FILE", "Recording of the same people without robot.")]
_Metrics = Annotated[
    list[str] | None,
    option("GLOB", "Which metrics; default: all but experimental ones; repeatable."),
]
_Variant = Annotated[str, option("NAME|all", "Which variants of metrics.")]
_Experimental = Annotated[bool, switch("--experimental", "Score experimental metrics, too.")]
_Robot = Annotated[str | None, option("NAME", "Which of several robots: topics below /NAME.")]
_UserTopic = Annotated[str | None, option("TOPIC", "Twist or TwistStamped: what the user wants.")]
_CommandTopic = Annotated[str, option("TOPIC", "The same for the final command.")]
_Commands = Annotated[Path | None, option("FILE", "CSV t,v_user,w_user,v_sc,w_sc, or a recording.")]
_Baseline = Annotated[Path | None, option("FILE", "Commands of the user driving unassisted.")]
_VMax = Annotated[float | None, option("M_PER_S", "Largest commanded speed.")]
_WMax = Annotated[float | None, option("RAD_PER_S", "Largest commanded yaw rate.")]
_Answers = Annotated[Path | None, option("FILE", "CSV questionnaire,item,value: NASA-TLX, USE.")]
_Jobs = Annotated[int, typer.Option(metavar="N", min=0, help="Processes; 0: one for each core.")]
_Incomplete = Annotated[
    bool, switch("--allow-incomplete", "Score recordings that were cut off, as far as they go.")
]
_Out = Annotated[Path | None, option("FILE", "File to write, .csv or .json: all scores.")]
_Json = Annotated[bool, switch("--json", "JSON on stdout.")]


def evaluate(
    runs: _Runs = None,
    robot_alone: _Alone = None,
    crowd_alone: _Crowd = None,
    metrics: _Metrics = None,
    variant: _Variant = "all",
    experimental: _Experimental = False,
    robot: _Robot = None,
    user_topic: _UserTopic = None,
    command_topic: _CommandTopic = "/cmd_vel",
    commands: _Commands = None,
    commands_baseline: _Baseline = None,
    v_max: _VMax = None,
    w_max: _WMax = None,
    questionnaires: _Answers = None,
    jobs: _Jobs = 1,
    out: _Out = None,
    allow_incomplete: _Incomplete = False,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: _Json = False,
) -> None:
    """Score recorded runs. Nothing is simulated; run directories stay as they are.

    Example: crowdbot evaluate runs/challenge-2020/counter-d0500-fast-c20-r05/dwa/seed-0
    """
    from crowdbot.core.runs.recordings import expand_paths
    from crowdbot.core.runs.rescore import RescoreRequest
    from crowdbot.core.support.cores import available_cores
    from crowdbot.core.support.stdout_guard import stdout_to_stderr

    paths: list[Path | None] = [*expand_paths(runs or [])] or [None]
    _check_usage(len(paths), paths[0], out, (commands, questionnaires), user_topic)
    registry = installed(plugin, no_plugins)
    chosen = _chosen(registry, metrics or ["*"], variant, experimental)
    requests = [
        RescoreRequest(
            path=path,
            robot_alone=robot_alone,
            crowd_alone=crowd_alone,
            robot=robot,
            topics=None if user_topic is None else (user_topic, command_topic),
            commands=commands,
            commands_baseline=commands_baseline,
            limits=(v_max, w_max),
            questionnaires=questionnaires,
            metrics=chosen,
            variants=variant,
            allow_incomplete=allow_incomplete,
            plugins=tuple(plugin or ()),
            allow=registry.allowed,
        )
        for path in paths
    ]
    with stdout_to_stderr():
        if len(requests) == 1:
            results = [_one(requests[0], registry, as_json)]
        else:
            results = _each(requests, registry, jobs or available_cores())
    _tell(results, out, as_json)


def _one(request: RescoreRequest, registry: Registry, as_json: bool) -> Rescored:
    """Evaluate the only run; its error is raised, and also printed with --json."""
    from crowdbot.core.runs.recordings import RecordingSource
    from crowdbot.core.runs.rescore import IncompleteError, Rescored, rescore

    try:
        return rescore(request, registry)
    except IncompleteError as error:
        if not as_json or request.path is None:
            raise
        say(f"error: {error}", err=True)
        source = RecordingSource(path=request.path, recording=request.path)
        return Rescored(
            source=source, error=str(error), exit_code=1, until=error.until, complete=False
        )


def _check_usage(
    count: int,
    first: Path | None,
    out: Path | None,
    files: Sequence[Path | None],
    user_topic: str | None,
) -> None:
    if first is None and not any(files):
        raise UsageError("nothing to score: name a run directory or a recording")
    if first is None and user_topic is not None and files[0] is None:
        raise UsageError("--user-topic is a topic of a recording; name one")
    if count > 1 and any(files):
        raise UsageError("--commands and --questionnaires belong to one run; name only one")
    check_ending(out, ".csv", ".json")


def _chosen(
    registry: Registry, metrics: Sequence[str], variant: str, experimental: bool
) -> tuple[str, ...]:
    """Return the patterns of metrics; unknown names are reported before the first run is read."""
    from crowdbot.core.scoring.evaluate import metric_specs

    known = registry.components("metric")
    patterns = list(metrics)
    if experimental:
        also = [k for k, c in known.items() if c.experimental]
        patterns += [k for k in also if any(fnmatch(k, pattern) for pattern in metrics)]
    specs = metric_specs(registry, patterns, {})
    variants = {
        v
        for spec in specs
        for v in getattr(getattr(known[spec.kind], "label", None), "variants", (variant,))
    }
    if variant not in ("all", *variants):
        raise UnknownNameError("variant", variant, variants)
    return tuple(patterns)


def _each(requests: list[RescoreRequest], registry: Registry, jobs: int) -> list[Rescored]:
    """Evaluate all runs, with progress, then print the errors."""
    from crowdbot.cli.output.evaluate_output import show_progress
    from crowdbot.core.runs.rescore import rescore_all

    results: list[Rescored] = []
    failed = 0
    with show_progress(len(requests)) as advance:
        for result in rescore_all(requests, registry, jobs):
            results.append(result)
            failed += bool(result.error)
            advance(failed)
    for result in results:
        if result.error:
            say(f"error: {result.error}", err=True)
    return results


def _tell(results: list[Rescored], out: Path | None, as_json: bool) -> None:
    from crowdbot.cli.output.evaluate_output import as_document, print_table, write_file

    if out is not None:
        write_file(out, results)
    if as_json:
        say_json([as_document(r) for r in results], allow_nan=False)
    elif out is None:
        for result in results:
            if not result.error:
                print_table(result)
    failed = sum(bool(r.error) for r in results)
    if len(results) > 1:
        written = f", written to {out}" if out is not None else ""
        scored = len(results) - failed
        say(f"scored {scored} of {len(results)} runs, {failed} failed{written}", err=True)
    if failed:
        raise typer.Exit(max(r.exit_code for r in results))
