"""``crowdbot verify``: check a bundle and repeat a random sample of its runs."""

from __future__ import annotations

import json
import secrets
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crowdbot.cli.shared.options import (
    MEMORY_GIB,
    InProcess,
    NoPlugins,
    PlannerMemory,
    Plugins,
    installed,
    planner_place,
)
from crowdbot.errors import printable

if TYPE_CHECKING:
    from crowdbot.core.bundle.archive import Archive
    from crowdbot.core.bundle.check import ClaimedRun
    from crowdbot.core.bundle.rerun_verdict import RerunVerdict
    from crowdbot.core.planning.choice import PlannerPlace
    from crowdbot.core.registry.registry import Registry
    from crowdbot.dsl.suite.expand import Expansion

_SAYS = {
    "verified": "every run that was made again is the same, bit by bit",
    "within tolerance": "runs differ no more than processors and software explain",
    "not comparable": "scores are of other versions of metrics than those that are installed here",
    "suspicious": "ask the team before anything else; see above what does not fit",
    "cannot be re-run": "nothing was simulated",
    "invalid": "the archive is damaged, or its parts contradict each other",
    "not re-run": "the archive is whole and fits the suite; nothing was simulated",
}


def verify(
    bundle: Annotated[
        Path, typer.Argument(metavar="BUNDLE", help="A bundle, made by crowdbot bundle.")
    ],
    sample: Annotated[
        int, typer.Option(min=0, metavar="N", help="How many runs to make again; 0: none.")
    ] = 5,
    everything: Annotated[bool, typer.Option("--all", help="Make all runs again.")] = False,
    seed: Annotated[
        int | None,
        typer.Option(min=0, metavar="S", help="Seed of the sample; default: a new one each time."),
    ] = None,
    source: Annotated[
        str | None,
        typer.Option(
            metavar="FILE.py:CLASS|FILE.yaml", help="The planner, where it is not installed."
        ),
    ] = None,
    planner: Annotated[str | None, typer.Option(hidden=True, help="The same, as before.")] = None,
    suite: Annotated[
        str | None, typer.Option(metavar="SPEC", help="The suite, where it is not a packaged one.")
    ] = None,
    save: Annotated[
        bool, typer.Option("--save", help="Write the outcome to NAME.verified.json beside it.")
    ] = False,
    in_process: InProcess = None,
    planner_memory: PlannerMemory = MEMORY_GIB,
    not_contained: Annotated[
        bool,
        typer.Option(
            "--not-contained",
            help="Run the planner also where this system cannot keep it from files and processes.",
        ),
    ] = False,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: Annotated[bool, typer.Option("--json", help="JSON on stdout.")] = False,
) -> None:
    """Check a bundle and repeat some of its runs; exit code 1 if anything does not match.

    Example: crowdbot verify team.cbz --sample 10 --seed 7
    """
    from crowdbot.core.bundle.verification import save_verification

    place = planner_place(in_process, planner_memory, contained=not not_contained)
    registry = installed(plugin, no_plugins)
    size = None if everything else sample
    document = verify_bundle(bundle, registry, suite, (source or planner, place), size, seed)
    if save:
        save_verification(bundle, document)
    if as_json:
        typer.echo(json.dumps({"bundle": str(bundle), **document}, indent=2))
    else:
        print_verdict(document)
    raise typer.Exit(0 if document["ok"] else 1)


def verify_bundle(
    bundle: Path,
    registry: Registry,
    suite: str | None,
    planner: tuple[str | None, PlannerPlace],
    sample: int | None,
    seed: int | None,
) -> dict[str, Any]:
    """Return the verdict on a bundle as a document, also used by `crowdbot bundle --check`.

    Args:
        bundle: the archive.
        registry: the installed components.
        suite: value of the option ``--suite``.
        planner: value of the option ``--source``, and where it runs.
        sample: number of runs to repeat; None: all.
        seed: seed of the sample; None: random.
    """
    from crowdbot.core.bundle.archive import open_archive
    from crowdbot.core.bundle.verification import content_hash
    from crowdbot.core.support.stdout_guard import stdout_to_stderr

    seed = secrets.randbelow(2**32) if seed is None else seed
    with open_archive(bundle) as archive, stdout_to_stderr():
        digest = content_hash(bundle)
        verdict = _verify(archive, registry, suite, planner, (sample, seed, digest))
        manifest = archive.manifest
    names = {"planner": manifest.label, "edition": manifest.edition_name}
    return names | _document(verdict, seed, digest)


def _verify(
    archive: Archive,
    registry: Registry,
    suite: str | None,
    planner: tuple[str | None, PlannerPlace],
    sample: tuple[int | None, int, str],
) -> RerunVerdict:
    from crowdbot.core.bundle.check import problems_of
    from crowdbot.core.bundle.rerun_verdict import RerunVerdict

    expansion = _suite(archive, registry, suite)
    runs, problems = problems_of(archive, expansion, registry)
    if problems:
        return RerunVerdict(outcome="invalid", findings=tuple(problems))
    if sample[0] == 0:
        return RerunVerdict(outcome="not re-run")
    return _make_reruns(archive, expansion, registry, planner, runs, sample)


def _suite(archive: Archive, registry: Registry, given: str | None) -> Expansion:
    from crowdbot.core.scenarios.library import open_spec, suite_names
    from crowdbot.errors import InputError

    name = archive.manifest.edition.suite
    if given is None and name not in suite_names(registry):
        raise InputError(
            f"{archive.path}: suite '{name}' is not installed; name its file with --suite"
        )
    expansion = open_spec(given or name, registry)
    if expansion.suite_id != name:
        raise InputError(f"{archive.path} is of suite '{name}', not of '{expansion.suite_id}'")
    if expansion.commitment:  # bundles of hidden draws are refused below
        typer.echo(f"{name}: seed and salt fit {expansion.commitment}", err=True)
    return expansion


def _make_reruns(
    archive: Archive,
    expansion: Expansion,
    registry: Registry,
    planner: tuple[str | None, PlannerPlace],
    runs: Sequence[ClaimedRun],
    sample: tuple[int | None, int, str],
) -> RerunVerdict:
    from crowdbot.cli.shared.one_run import end_hung_process, import_simulate, interruptible
    from crowdbot.cli.shared.progress import show_progress
    from crowdbot.core.bundle.rerun_verdict import RerunVerdict, verdict_of

    import_simulate()  # reports what is missing if Drake cannot be imported
    from crowdbot.core.campaign.verify import (
        NotRunnable,
        RerunSetup,
        choose_planner,
        draw_sample,
        make_rerun,
    )

    try:
        choice = choose_planner(archive.manifest, registry, *planner)
    except NotRunnable as error:
        return RerunVerdict(outcome="cannot be re-run", findings=(str(error),))
    size, seed, content = sample
    with interruptible() as stop, show_progress() as progress:
        setup = RerunSetup(
            expansion=expansion, registry=registry, choice=choice, progress=progress, stop=stop,
            on_hang=end_hung_process,
        )  # fmt: skip
        numbers = draw_sample(runs, size, seed, content)
        reruns = [make_rerun(setup, runs[number]) for number in numbers]
    return verdict_of(reruns)


def _document(verdict: RerunVerdict, seed: int, digest: str) -> dict[str, Any]:
    from crowdbot.core.bundle.rerun_verdict import FINE
    from crowdbot.core.runs import provenance

    return {
        "outcome": verdict.outcome,
        "ok": verdict.outcome in FINE,
        "sha256": digest,
        "seed": seed,
        "findings": list(verdict.findings),
        "not_comparable": list(verdict.not_comparable),
        "runs": dict(verdict.relations),
        "crowdbot": provenance.versions()["crowdbot"],
        "machine": provenance.machine(),
    }


def print_verdict(document: dict[str, Any]) -> None:
    """Print the findings in readable form."""
    for finding in document["findings"]:
        typer.echo(printable(finding))
    for name, relation in document["runs"].items():
        typer.echo(f"{name}: {relation}")
    head, outcome = f"{document['edition']}: {document['planner']}", document["outcome"]
    chosen = f", sample seed {document['seed']}" if document["runs"] else ""
    typer.echo(printable(f"{head}: {outcome}: {_SAYS[outcome]}{chosen}"))
