"""``crowdbot audit``: check that a suite separates floors from baselines."""

from __future__ import annotations

import json
from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import crowdbot.cli.shared.options as shared
from crowdbot.cli.output.plugin_table import table
from crowdbot.cli.output.say import say
from crowdbot.cli.shared.campaign_run import print_plan, read_seeds, run_plan, worker_count
from crowdbot.cli.shared.option import option, switch
from crowdbot.errors import InputError

if TYPE_CHECKING:
    from crowdbot.core.campaign.plan import Plan
    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.results.results import Results
    from crowdbot.core.statistics.audit import Audit

#: Planners besides baselines and floors that no adversary may be ahead of.
_CAREFUL = ("people_mpc",)


def audit(
    suite: shared.SuiteArgument,
    scenarios: Annotated[
        int | None,
        typer.Option(
            min=1, metavar="N", help="Only N scenarios, with many different crowds; default: all."
        ),
    ] = None,
    only: shared.OnlyScenarios = None,
    seeds: Annotated[str, option("0,1,2|0..4", "Run seeds.")] = "0",
    overrides: shared.EveryScenarioSet = None,
    out: Annotated[Path, option("DIR", "Root of the run directories.")] = Path("runs"),
    jobs: shared.Jobs = 0,
    dry_run: Annotated[bool, switch("--dry-run", "Print the plan only.")] = False,
    adversaries: Annotated[
        bool, switch("--adversaries", "Check that no adversary is ahead of a careful planner.")
    ] = False,
    careful: Annotated[
        list[str] | None,
        option(
            "NAME|FILE|file.py:Class",
            "With --adversaries: a further planner that none may be ahead of; repeatable.",
        ),
    ] = None,
    plugin: shared.Plugins = None,
    no_plugins: shared.NoPlugins = False,
    as_json: Annotated[bool, switch("--json", "The audit as JSON on stdout.")] = False,
) -> None:
    """Check that a suite tells careful planners from blind ones; exit code 1 if it does not.

    Example: crowdbot audit challenge-2020 --scenarios 18 --jobs 2

    Example: crowdbot audit challenge-2026 --adversaries --careful rds --only 'counter-*'
    """
    from crowdbot.core.campaign.plan import make_plan
    from crowdbot.core.campaign.request import CampaignRequest
    from crowdbot.core.runs.run_options import RunOptions

    registry = shared.installed(plugin, no_plugins)
    if careful and not adversaries:
        raise InputError("--careful names planners to compare adversaries with: add --adversaries")
    named = _careful(registry, careful or ())
    request = CampaignRequest(
        suites=[suite],
        planners=tuple(named.values()) if adversaries else (),
        roles=("baseline", "adversary") if adversaries else ("floor", "baseline", "ceiling"),
        seeds=read_seeds(seeds),
        only=only or (),
        sample=scenarios,
        out=out,
        options=RunOptions(replay=False, references=not adversaries),
        overrides=overrides or (),
        plugins=plugin or (),
    )
    plan = make_plan(request, registry)
    if dry_run:
        print_plan(plan, worker_count(jobs), as_json=as_json)
        return
    state = run_plan(plan, worker_count(jobs), None)
    if adversaries:
        _tell_adversaries(plan, registry, named, state.exit_code, as_json=as_json)
        return
    found, path = _judged(plan, registry)
    say(json.dumps(found.model_dump(), indent=1) if as_json else _text(found, path))
    if state.exit_code or not found.tells_apart:
        raise typer.Exit(state.exit_code or 1)


def _judged(plan: Plan, registry: Registry) -> tuple[Audit, Path]:
    """Audit a plan's runs; return the audit and the path of the file written."""
    from crowdbot.core.results.results import Results
    from crowdbot.core.scoring.score_scale import score_scales
    from crowdbot.core.statistics.audit import AUDIT, write_audit
    from crowdbot.core.statistics.audit import audit as judge

    results = replace(_of(Results.open(plan.out), plan), scales=score_scales(registry))
    found = judge(results, _seeing_floors(registry))
    path = plan.out / found.suite / AUDIT
    write_audit(path, found)
    return found, path


def _tell_adversaries(
    plan: Plan, registry: Registry, careful: Collection[str], exit_code: int, *, as_json: bool
) -> None:
    """Print what each adversary gains; exit code 1 if one is ahead of a careful planner."""
    from crowdbot.cli.output.adversary_lines import adversary_lines, adversary_text
    from crowdbot.core.results.results import Results
    from crowdbot.core.scoring.score_scale import score_scales

    results = replace(_of(Results.open(plan.out), plan), scales=score_scales(registry))
    lines = adversary_lines(results, careful)
    say(json.dumps(lines, indent=1) if as_json else adversary_text(lines))
    if exit_code or any(line["standing"] == "ahead" for line in lines):
        raise typer.Exit(exit_code or 1)


def _careful(registry: Registry, more: Sequence[str]) -> dict[str, str]:
    """Return label -> planner of careful planners, which adversaries must not outrank.

    Raises:
        InputError: a planner in ``more`` is an adversary.
    """
    from crowdbot.core.planning.resolve import resolve_planner

    found = dict[str, str]()
    for planner in (*_seeing_floors(registry), *_CAREFUL, *more):
        choice = resolve_planner(planner, registry)
        if choice.role == "adversary":
            raise InputError(f"--careful {planner}: this planner is an adversary")
        found.setdefault(choice.label, planner)
    return found


def _seeing_floors(registry: Registry) -> list[str]:
    """Return the labels of floors that read any sensor."""
    from crowdbot.core.planning.resolve import kinds_of_role, resolve_planner

    floors = [resolve_planner(kind, registry) for kind in kinds_of_role("floor", registry)]
    return [floor.label for floor in floors if floor.needs is None or floor.needs]


def _of(results: Results, plan: Plan) -> Results:
    """Return the results of a plan's runs only, not of other runs below the same folder."""
    from crowdbot.core.results.score_columns import of_runs

    keys = {run.key for run in plan.runs}
    folders = {run.directory.relative_to(plan.out).as_posix() for run in plan.runs}
    runs = tuple(r for r in results.runs if r.run_id in keys)
    places = {(r.suite, r.scenario, r.planner, r.seed) for r in runs}
    failures = tuple(
        f
        for f in results.failures
        if f"{f.suite}/{f.scenario}/{f.planner}/seed-{f.seed}" in folders
        and (f.suite, f.scenario, f.planner, f.seed) not in places
    )
    scores = of_runs(results.scores, keys)
    return replace(results, runs=runs, scores=scores, failures=failures)


def _text(found: Audit, path: Path) -> str:
    rows = [["better", "worse", "needed", "lead", "interval", "pairs", "draws", "verdict"]]
    for pair in found.pairs:
        ends = (
            "–" if pair.low is None or pair.high is None else f"{pair.low:.3g} to {pair.high:.3g}"
        )
        by = "–" if pair.by is None else f"{pair.by:+.3g}"
        rows.append([
            pair.better, pair.worse, "yes" if pair.required else "no", by, ends, str(pair.pairs),
            str(pair.draws), pair.verdict + f" ({pair.reason})" * bool(pair.reason),
        ])  # fmt: skip
    return "\n".join([table(rows), "", found.text, f"wrote {path}"])
