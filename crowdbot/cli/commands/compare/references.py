"""``crowdbot references``: reference scores, to compare planners with."""

from __future__ import annotations

import json
import shlex
import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from crowdbot.cli.output.say import say
from crowdbot.cli.shared.options import NoPlugins, Plugins, installed
from crowdbot.core.support.text import plural

references = typer.Typer(
    add_completion=False, invoke_without_command=True, pretty_exceptions_enable=False
)
_Json = Annotated[bool, typer.Option("--json", help="JSON on stdout.")]


@references.callback()
def show(
    context: typer.Context,
    file: Annotated[
        str,
        typer.Option(metavar="crowdbot|FILE", help="Default: those that come with crowdbot."),
    ] = "crowdbot",
    as_json: _Json = False,
) -> None:
    """Show what the reference scores contain: suites, planners, seeds, machine and command.

    Example: crowdbot references
    """
    if context.invoked_subcommand is not None:
        return
    from crowdbot.core.results.reference_file import open_references
    from crowdbot.errors import InputError

    found = open_references(file)
    if found is None:
        raise InputError(f"{file}: a file of reference scores ends in .json.xz")
    record = found.results.runs[0].record
    about: dict[str, Any] = {
        "command": found.command, "runs": len(found.results.runs), "held": list(found.held),
        "versions": record.versions, "machine": record.machine,
    }  # fmt: skip
    if as_json:
        say(json.dumps(about, indent=2))
        return
    say("\n".join(found.held))
    for name in ("machine", "versions"):
        say(f"{name}: {', '.join(f'{k} {v}' for k, v in about[name].items())}")
    say(f"made by: {found.command}")


@references.command()
def make(
    suites: Annotated[list[str], typer.Argument(metavar="SUITE...", help="Files or names.")],
    planner: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Default: all but adversaries; repeatable."),
    ] = None,
    seeds: Annotated[
        str, typer.Option(metavar="0,1,2|0..2", help="Run seeds of every scenario.")
    ] = "0..2",
    only: Annotated[
        list[str] | None,
        typer.Option(metavar="GLOB", help="Only scenarios that match; repeatable."),
    ] = None,
    runs: Annotated[
        Path, typer.Option(metavar="DIR", help="Root of the run directories, which are kept.")
    ] = Path("reference_runs"),
    out: Annotated[Path, typer.Option(metavar="FILE", help="File to write, .json.xz.")] = Path(
        "reference_scores.json.xz"
    ),
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0 is one for each core.")] = 0,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: _Json = False,
) -> None:
    """Run planners in suites, and keep their scores in one file; finished runs are skipped.

    Example: crowdbot references make challenge-2026 --only '*-n01' --seeds 0
    """
    from crowdbot.cli.shared.campaign_run import read_seeds, run_plan, worker_count
    from crowdbot.core.campaign.plan import make_plan
    from crowdbot.core.campaign.request import CampaignRequest
    from crowdbot.core.results.reference_file import SUFFIX, write_references
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
    plan = make_plan(request, registry)
    state = run_plan(plan, worker_count(jobs), None)
    if state.exit_code:
        raise typer.Exit(state.exit_code)
    wanted = {str(r.directory.relative_to(plan.out)) for r in plan.runs}
    found = Results.open(runs)
    chosen = [r for r in found.runs if r.directory in wanted]
    kept = Results(runs=tuple(chosen), scores=found.scores)
    size = write_references(out, kept, shlex.join(["crowdbot", *sys.argv[1:]]))
    if as_json:
        say(json.dumps({"file": str(out), "bytes": size, "runs": len(chosen)}, indent=2))
    else:
        say(f"{out}: {plural(len(chosen), 'run')}, {size} bytes")


def _all_planners(registry: Any) -> list[str]:
    from crowdbot.core.planning.resolve import kinds_of_role
    from crowdbot.dsl.spec.component_specs import PlannerRole

    roles: tuple[PlannerRole, ...] = ("floor", "baseline", "candidate", "ceiling")
    return [kind for role in roles for kind in kinds_of_role(role, registry)]
