"""``crowdbot results``: query the results of a campaign."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer
from typer.core import TyperGroup

from crowdbot.cli.output.results_by_planner import print_by_planner
from crowdbot.cli.output.results_lines import line_of, print_lines
from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.open_results import (
    Altered,
    Reference,
    named_by_suite,
    of_each_suite,
    open_results,
    with_scales,
)
from crowdbot.cli.shared.option import option, switch
from crowdbot.core.scoring.four_scores import MAIN_SCORES
from crowdbot.core.support.text import plural

if TYPE_CHECKING:
    from crowdbot.core.results.results import Results


class _Tables(TyperGroup):
    """The group of ``crowdbot results``; a folder in place of a command gives a hint."""

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        found = super().get_command(ctx, cmd_name)
        if found is None and Path(cmd_name).is_dir():
            ctx.fail(f"a folder of runs is given with --runs {cmd_name}")
        return found


results = typer.Typer(
    cls=_Tables,
    add_completion=False,
    invoke_without_command=True,
    pretty_exceptions_enable=False,
)

_Out = Annotated[Path, option("DIR", "Root of the run directories.", "--runs", "--out")]
_Planners = Annotated[
    list[str] | None, option("GLOB", "Only planners with such labels; repeatable.")
]
_Json = Annotated[bool, switch("--json", "JSON on stdout.")]
_ROOT = Path("runs")
#: Scores shown for every planner by default.
_HEADLINES = (
    *(s.metric for s in MAIN_SCORES),
    "success", "collision_count", "min_clearance", "relative_time_to_goal", "delay",
    "evasive_acceleration",
)  # fmt: skip


@results.callback()
def show(
    context: typer.Context,
    out: _Out = _ROOT,
    metric: Annotated[
        list[str] | None,
        option("GLOB", "A metric to show; default: the suite's, and a few; repeatable."),
    ] = None,
    variant: Annotated[
        str | None, option("NAME", "Variant; default: rate or pace, or else corrected.")
    ] = None,
    by: Annotated[
        str, option("AXIS,AXIS", "Group by these: planner, seed, status, axes of the suite.")
    ] = "planner",
    planner: _Planners = None,
    status: Annotated[
        str | None, option("STATUS", "Only runs that ended so, such as timeout.")
    ] = None,
    reference: Reference = None,
    worst: Annotated[
        int, typer.Option(min=0, metavar="N", help="The N worst runs by --metric instead.")
    ] = 0,
    details: Annotated[
        bool, switch("--details", "A line for each planner, with medians and counts.")
    ] = False,
    altered: Altered = False,
    as_csv: Annotated[bool, switch("--csv", "CSV on stdout.")] = False,
    as_json: _Json = False,
) -> None:
    """Show the scores of planners side by side, by metric and group.

    Example: crowdbot results --runs runs --metric 'collision*' --by planner,density
    """
    if context.invoked_subcommand is not None:
        return
    from crowdbot.core.results.chosen_planners import of_planners
    from crowdbot.core.results.with_reference import (
        among_references,
        reference_results,
        with_reference,
    )
    from crowdbot.errors import UsageError

    given = reference_results(reference) if reference else None
    found, references = with_reference(open_results(out, altered, metric or ()), given)
    found = with_scales(_ended(of_planners(found, planner or ()), status))
    if worst:
        if metric is None or len(metric) != 1:
            raise UsageError("--worst needs one --metric NAME")
        print_lines(_worst(found, metric[0], variant, worst), as_csv=as_csv, as_json=as_json)
        return
    groups = [name.strip() for name in by.split(",") if name.strip()]
    if "suite" not in groups and len(found.suites) > 1:
        groups.append("suite")  # each change to a scenario is a suite of its own, too
    shown = _summaries(found, groups, metric, variant)
    if shown and "planner" in groups and not (details or as_csv or as_json):
        print_by_planner(shown)
    else:
        print_lines(shown, as_csv=as_csv, as_json=as_json)
    if not (as_csv or as_json):
        damaged = f", {len(found.damaged)} damaged" if found.damaged else ""
        runs, failures = plural(len(found.runs), "run"), plural(len(found.failures), "failure")
        say("\n".join([f"{runs}, {failures}{damaged}", *among_references(found, references)]))


def _summaries(
    found: Results, groups: Sequence[str], metrics: Sequence[str] | None, variant: str | None
) -> list[dict[str, Any]]:
    """Return a line per group and metric; by default the suites' metrics and the headlines."""
    from crowdbot.core.results.rows import named_metrics
    from crowdbot.core.results.score_columns import metrics_of
    from crowdbot.core.statistics.groups import Grouped

    known = metrics_of(found.scores)
    first = [*named_metrics(found.runs), *_HEADLINES]
    names = metrics or [m for m in dict.fromkeys(first) if m in known]
    grouped = Grouped(found, groups)
    lines = [line_of(s) for m in names for s in grouped.summaries(m, variant)]
    once = {tuple(sorted(line.items(), key=lambda cell: cell[0])): line for line in lines}
    return [*once.values()]  # patterns may overlap


@results.command()
def export(
    out: _Out = _ROOT,
    csv: Annotated[Path | None, option("FILE", "Write CSV.")] = None,
    parquet: Annotated[Path | None, option("FILE", "Write Parquet.")] = None,
    table: Annotated[Literal["scores", "runs"], typer.Option(help="Which table.")] = "scores",
    altered: Altered = False,
) -> None:
    """Write all scores, or all runs, as one table.

    Example: crowdbot results export --runs runs --csv scores.csv
    """
    from crowdbot.core.results import tables
    from crowdbot.errors import UsageError

    if csv is None and parquet is None:
        raise UsageError("write --csv FILE or --parquet FILE")
    found = open_results(out, altered)
    lines = (
        tables.score_lines(found.runs, found.scores)
        if table == "scores"
        else tables.run_lines(found.runs)
    )
    if csv is not None:
        tables.write_csv(csv, lines)
    if parquet is not None:
        tables.write_parquet(parquet, lines)


@results.command()
def failures(
    out: _Out = _ROOT,
    traceback: Annotated[bool, switch("--traceback", "Print Python's tracebacks, too.")] = False,
    as_json: _Json = False,
) -> None:
    """List the runs of a campaign that failed.

    Example: crowdbot results failures --runs runs --traceback
    """
    from crowdbot.core.results.results import Results

    found = Results.open(out).failures
    if as_json:
        say_json([asdict(f) for f in found])
        return
    for failure in found:
        name = f"{failure.suite}/{failure.scenario} {failure.planner} seed {failure.seed}"
        say(f"{name}: {failure.error}")
        if traceback:
            say(failure.traceback)
    if not found:
        say("no failures")


@results.command()
def tracking(
    out: _Out = _ROOT,
    within: Annotated[
        list[float] | None,
        typer.Option(min=0.6, metavar="M", help="Distance from the robot; default: 3 and 6."),
    ] = None,
    planner: _Planners = None,
    altered: Altered = False,
    as_csv: Annotated[bool, switch("--csv", "CSV on stdout.")] = False,
    as_json: _Json = False,
) -> None:
    """Show how well planners track people: recall, false tracks, switches and errors.

    Example: crowdbot results tracking --runs runs --within 3
    """
    from crowdbot.core.results.chosen_planners import of_planners
    from crowdbot.core.results.tracking import tracking_lines

    found = of_planners(open_results(out, altered), planner or ())
    lines = list(tracking_lines(found, out, within or [3.0, 6.0]))
    print_lines(lines, as_csv=as_csv, as_json=as_json)
    if not (lines or as_csv or as_json):
        say("no run has tracks of people: its planner draws none, or it was not recorded")


@results.command()
def atlas(
    out: _Out = _ROOT,
    floor: Annotated[
        list[str] | None, option("NAME", "A planner that others ought to beat; repeatable.")
    ] = None,
    md: Annotated[Path | None, option("FILE", "Write Markdown.")] = None,
    altered: Altered = False,
    as_json: _Json = False,
) -> None:
    """Show what drives each metric, and which metrics are redundant.

    Example: crowdbot results atlas --runs runs --floor goal_seek --md atlas.md
    """
    from crowdbot.cli.output.atlas_page import atlas_page
    from crowdbot.core.statistics.atlas import atlas as entries_of
    from crowdbot.core.support.atomic_write import atomic_write

    found = with_scales(open_results(out, altered))
    entries = of_each_suite(found, lambda part: entries_of(part, floor or ()))
    if md is not None:
        atomic_write(md, atlas_page(entries))
    if as_json:
        lines = named_by_suite({suite: map(asdict, some) for suite, some in entries.items()})
        say_json(lines)
    elif md is None:
        say(atlas_page(entries), nl=False)


@results.command()
def power(
    out: _Out = _ROOT,
    metric: Annotated[str, option("NAME", "The score.")] = MAIN_SCORES[0].metric,
    variant: Annotated[str, option("NAME", "Its variant.")] = "corrected",
    size: Annotated[
        list[float] | None, option("X", "A difference to find; default 0.05, 0.02; repeatable.")
    ] = None,
    tests: Annotated[
        int, typer.Option(min=1, metavar="N", help="Tests that share the chance of 5 %.")
    ] = 1,
    planner: _Planners = None,
    by: Annotated[str, option("AXIS", "A line for each label of this, not condition.")] = "",
    reference: Annotated[
        str | None, option("crowdbot|FILE|ROOT", "These reference scores, not --runs.")
    ] = None,
    altered: Altered = False,
    as_csv: Annotated[bool, switch("--csv", "CSV on stdout.")] = False,
    as_json: _Json = False,
) -> None:
    """Show how many runs are needed to detect a difference with 80 % power, per condition.

    Example: crowdbot results power --runs runs --size 0.05 --planner dwa --planner stop_and_go
    """
    from crowdbot.cli.output.power_lines import lines_of
    from crowdbot.core.results.chosen_planners import of_planners
    from crowdbot.core.results.with_reference import reference_results
    from crowdbot.core.statistics.power import SIZES

    sizes = tuple(size or SIZES)
    opened = open_results(out, altered) if reference is None else reference_results(reference)
    found = with_scales(of_planners(opened, planner or ()))
    name = (metric, variant)
    parts = of_each_suite(found, lambda part: lines_of(part, name, sizes, tests, by))
    print_lines(named_by_suite(parts), as_csv=as_csv, as_json=as_json)


@results.command()
def ladder(
    out: _Out = _ROOT,
    metric: Annotated[str | None, option("NAME", "The score; default: safe efficiency.")] = None,
    variant: Annotated[str, option("NAME", "Its variant.")] = "corrected",
    altered: Altered = False,
    as_csv: Annotated[bool, switch("--csv", "CSV on stdout.")] = False,
    as_json: _Json = False,
) -> None:
    """Show each planner's score on the rungs of the ladder of sensing.

    Example: crowdbot results ladder --runs runs
    """
    from crowdbot.cli.output.ladder_lines import lines_of

    found = with_scales(open_results(out, altered))
    name = None if metric is None else (metric, variant)
    parts = of_each_suite(found, lambda part: lines_of(part, name))
    print_lines(named_by_suite(parts), as_csv=as_csv, as_json=as_json)


def _ended(found: Results, status: str | None) -> Results:
    """Return runs with this status, and their scores; None: all runs, and failures.

    Raises:
        UnknownNameError: there is no such status.
    """
    from crowdbot.core.results.score_columns import of_runs
    from crowdbot.core.types.ending import ATTEMPTED, Ending
    from crowdbot.errors import UnknownNameError

    if status is None:
        return found
    if status not in ATTEMPTED:
        raise UnknownNameError("status", status, ATTEMPTED)
    runs = tuple(r for r in found.runs if r.status == status)
    return replace(
        found,
        runs=runs,
        scores=of_runs(found.scores, {r.run_id for r in runs}),
        failures=found.failures if status == Ending.NO_RUN else (),
    )


def _worst(found: Results, metric: str, variant: str | None, count: int) -> list[dict[str, Any]]:
    """Return runs with the worst values of one metric; missing values come first."""
    from crowdbot.core.results.tables import score_lines
    from crowdbot.core.statistics.groups import by_group

    summaries = by_group(found, metric, (), variant)
    if len(summaries) != 1:
        from crowdbot.errors import InputError

        names = ", ".join(s.metric for s in summaries) or "no metric"
        raise InputError(f"--worst wants one metric; '{metric}' fits {names}")
    (summary,) = summaries
    lines = [
        line
        for line in score_lines(found.runs, found.scores)
        if (line["metric"], line["variant"]) == (summary.metric, summary.variant)
    ]
    sign = 1.0 if summary.better == "higher" else -1.0
    lines.sort(key=lambda n: (n["value"] is not None, sign * (n["value"] or 0.0)))
    directories = {r.run_id: r.directory for r in found.runs}
    kept = ("scenario", "planner", "seed", "run_status", "value", "unit", "status", "reason")
    return [
        {**{k: line[k] for k in kept}, "directory": directories[line["run_id"]]}
        for line in lines[:count]
    ]
