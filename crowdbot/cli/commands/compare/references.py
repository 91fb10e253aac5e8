"""``crowdbot references``: reference scores, to compare planners with."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.options import Jobs, NoPlugins, OnlyScenarios, Plugins, installed
from crowdbot.core.support.text import plural

if TYPE_CHECKING:
    from crowdbot.core.campaign.plan import Plan
    from crowdbot.core.campaign.request import CampaignRequest
    from crowdbot.core.results.results import Results
    from crowdbot.core.results.rows import RunRow

references = typer.Typer(
    add_completion=False, invoke_without_command=True, pretty_exceptions_enable=False
)
_Json = Annotated[bool, switch("--json", "JSON on stdout.")]


@references.callback()
def show(
    context: typer.Context,
    file: Annotated[
        str, option("crowdbot|FILE", "Default: those that come with crowdbot.")
    ] = "crowdbot",
    as_json: _Json = False,
) -> None:
    """Show the contents of the reference scores: suites, planners, seeds, machine and command.

    Example: crowdbot references
    """
    if context.invoked_subcommand is not None:
        return
    from crowdbot.core.results.reference_file import opened

    found = opened(file)
    about: dict[str, Any] = {
        "commands": list(found.commands), "runs": len(found.results.runs),
        "held": list(found.held), "made": _makers(found.results.runs),
    }  # fmt: skip
    if as_json:
        say_json(about)
        return
    say("\n".join(found.held))
    for maker in about["made"]:
        say(f"{plural(maker['runs'], 'run')} made with:")
        for name in ("machine", "versions"):
            say(f"  {name}: {', '.join(f'{k} {v}' for k, v in maker[name].items())}")
    for command in found.commands:
        say(f"made by: {command}")


def _makers(runs: Sequence[RunRow]) -> list[dict[str, Any]]:
    """Return each combination of machine and package versions, and its number of runs."""
    makers: list[dict[str, Any]] = []
    for run in runs:
        own = {"machine": run.record.machine, "versions": run.record.versions}
        known = next((m for m in makers if own.items() <= m.items()), None)
        if known is None:
            makers.append(known := {"runs": 0, **own})
        known["runs"] += 1
    return makers


@references.command()
def make(
    suites: Annotated[list[str], argument("SUITE...", "Files or names.")],
    planner: Annotated[
        list[str] | None, option("NAME", "Default: all but adversaries; repeatable.")
    ] = None,
    seeds: Annotated[str, option("0,1,2|0..2", "Run seeds of every scenario.")] = "0..2",
    only: OnlyScenarios = None,
    runs: Annotated[Path, option("DIR", "Root of the run directories, which are kept.")] = Path(
        "reference_runs"
    ),
    out: Annotated[Path, option("FILE", "File to write, .json.xz.")] = Path(
        "reference_scores.json.xz"
    ),
    extend: Annotated[
        str | None, option("crowdbot|FILE", "Add to these; runs that they have are not made again.")
    ] = None,
    jobs: Jobs = 0,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: _Json = False,
) -> None:
    """Run planners in suites, and keep their scores in one file; finished runs are skipped.

    Examples:
    crowdbot references make challenge-2026 --only '*-n01' --seeds 0
    crowdbot references make challenge-2026 --planner dwa --seeds 1 --extend crowdbot
    """
    from crowdbot.cli.shared.campaign_run import read_seeds, run_plan, worker_count
    from crowdbot.core.campaign.extend_references import extended, without_known
    from crowdbot.core.campaign.plan import make_plan
    from crowdbot.core.campaign.request import CampaignRequest
    from crowdbot.core.results.reference_file import SUFFIX, opened, write_references
    from crowdbot.core.results.results import Results
    from crowdbot.core.runs.run_options import RunOptions
    from crowdbot.errors import UsageError

    if not out.name.endswith(SUFFIX):
        raise UsageError(f"--out {out}: the name must end in {SUFFIX}")
    registry = installed(plugin, no_plugins)
    request = CampaignRequest(
        suites=suites, planners=planner or _all_planners(registry), seeds=read_seeds(seeds),
        only=only or (), out=runs, options=RunOptions(replay=False), plugins=plugin or (),
    )  # fmt: skip
    old = None if extend is None else opened(extend)
    plan = make_plan(request, registry)
    if old is not None:
        plan = without_known(plan, old.results.runs)
    state = run_plan(plan, worker_count(jobs), None)
    if state.exit_code:
        raise typer.Exit(state.exit_code)
    made = _made(plan) if plan.runs else Results(runs=(), scores=())
    kept = made if old is None else extended(old.results, made)
    commands = [*(old.commands if old else ()), *([_command(request, seeds)] if made.runs else ())]
    size = write_references(out, kept, commands)
    about = {"file": str(out), "bytes": size, "runs": len(kept.runs), "made": len(made.runs)}
    if as_json:
        say_json(about)
    else:
        say(f"{out}: {plural(len(kept.runs), 'run')}, {len(made.runs)} of them now, {size} bytes")


def _made(plan: Plan) -> Results:
    """Return the results of a plan's runs."""
    from crowdbot.core.results.results import Results

    directories = {str(r.directory.relative_to(plan.out)) for r in plan.runs}
    results = Results.open(plan.out)
    chosen = tuple(r for r in results.runs if r.directory in directories)
    ids = {r.run_id for r in chosen}
    return Results(runs=chosen, scores=tuple(s for s in results.scores if s.run_id in ids))


def _command(request: CampaignRequest, seeds: str) -> str:
    """Return the command that repeats these runs on any machine; it contains no local folders."""
    named = {
        "--only": request.only, "--planner": request.planners, "--seeds": [seeds],
        "--plugin": request.plugins,
    }  # fmt: skip
    options = [word for name, values in named.items() for v in values for word in (name, str(v))]
    return shlex.join(["crowdbot", "references", "make", *request.suites, *options])


def _all_planners(registry: Any) -> list[str]:
    from crowdbot.core.planning.resolve import kinds_of_role
    from crowdbot.dsl.spec.component_specs import PlannerRole

    roles: tuple[PlannerRole, ...] = ("floor", "baseline", "candidate", "ceiling")
    return [kind for role in roles for kind in kinds_of_role(role, registry)]
