"""``crowdbot verify``: check a bundle and repeat a random sample of its runs."""

from __future__ import annotations

import json
import secrets
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import crowdbot.cli.shared.options as shared
from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.run_arguments import AsJson
from crowdbot.cli.shared.verify_references import outcome_lines, verify_references

if TYPE_CHECKING:
    from crowdbot.core.bundle.archive import Archive
    from crowdbot.core.bundle.check import ClaimedRun
    from crowdbot.core.bundle.rerun_verdict import RerunVerdict
    from crowdbot.core.planning.choice import PlannerPlace
    from crowdbot.core.registry.registry import Registry
    from crowdbot.dsl.suite.expansion import Expansion

_SAYS = {
    "verified": "every run that was made again is the same, bit by bit",
    "within tolerance": "runs differ no more than processors and software explain",
    "nondeterministic": "the planner does not give the same run twice here: rule 4 of the suites",
    "worse on new people": "the scores are not those of the planner in general",
    "untrusted plugin": "the planner's plugin is loaded into the simulator, which it can change",
    "not comparable": "scores are of other versions of metrics than those that are installed here",
    "suspicious": "ask the team before anything else; see above what does not fit",
    "cannot be re-run": "nothing was simulated",
    "invalid": "it is damaged, incomplete, or of another suite or state of it; see above",
    "not re-run": "the archive is whole and fits the suite; nothing was simulated",
}


def verify(
    bundle: Annotated[
        Path, argument("BUNDLE", "A bundle; or reference scores: 'references', or a .json.xz.")
    ],
    sample: Annotated[
        int, typer.Option(min=0, metavar="N", help="How many runs to make again; 0: none.")
    ] = 5,
    everything: Annotated[bool, switch("--all", "Make all runs again.")] = False,
    seed: Annotated[
        int | None,
        typer.Option(min=0, metavar="S", help="Seed of the sample; default: a new one each time."),
    ] = None,
    source: Annotated[
        str | None,
        option("FILE.py:CLASS|FILE.yaml|FILE.cbs", "The planner, where it is not installed."),
    ] = None,
    planner: Annotated[str | None, typer.Option(hidden=True, help="The same, as before.")] = None,
    suite: Annotated[
        str | None, option("SPEC", "The suite, where it is not a packaged one.")
    ] = None,
    save: Annotated[
        bool, switch("--save", "Write the signed outcome to NAME.verified.json beside it.")
    ] = False,
    trust: Annotated[
        list[str] | None,
        option("PLUGIN", "You have read the code of this planner's plugin; repeatable."),
    ] = None,
    fresh_draws: Annotated[
        int,
        typer.Option(
            min=0, metavar="N", help="Also make N runs with new people, and compare the means."
        ),
    ] = 0,
    in_process: shared.InProcess = None,
    planner_memory: shared.PlannerMemory = shared.MEMORY_GIB,
    not_contained: Annotated[
        bool,
        switch(
            "--not-contained",
            "Run the planner even if this system cannot keep it from files and processes.",
        ),
    ] = False,
    plugin: shared.Plugins = None,
    no_plugins: shared.NoPlugins = False,
    as_json: AsJson = False,
) -> None:
    """Check a bundle and repeat some of its runs; exit code 1 if anything does not match.

    Example: crowdbot verify team.cbz --sample 10 --seed 7
    """
    from crowdbot.core.bundle.signature import own_public_key, sign
    from crowdbot.core.bundle.verification import record_path, save_verification

    if save:
        sign({})  # fails at once where the key or the library is missing, not after all runs
    place = shared.planner_place(in_process, planner_memory, contained=not not_contained)
    registry = shared.installed(plugin, no_plugins)
    size = None if everything else sample
    if (document := verify_references(str(bundle), registry, size, seed)) is not None:
        say(json.dumps(document, indent=2) if as_json else "\n".join(outcome_lines(document)))
        raise typer.Exit(0 if document["ok"] else 1)
    options = VerifyOptions(
        size=None if everything else sample, seed=seed, trusted=tuple(trust or ()),
        fresh=fresh_draws,
    )  # fmt: skip
    document = verify_bundle(bundle, registry, suite, (source or planner, place), options)
    if save:
        save_verification(bundle, document)
    if as_json:
        say_json({"bundle": str(bundle), **document})
    else:
        print_verdict(document)
        if save:
            say(f"wrote {record_path(bundle)}, signed with the public key {own_public_key()}")
    raise typer.Exit(0 if document["ok"] else 1)


@dataclass(frozen=True, kw_only=True)
class VerifyOptions:
    """The extent of a verification.

    Attributes:
        size: number of runs to repeat; None: all.
        seed: seed of the sample; None: random.
        trusted: plugins of planners whose code the user has read.
        fresh: number of runs with new people.
    """

    size: int | None
    seed: int | None = None
    trusted: Sequence[str] = ()
    fresh: int = 0


def verify_bundle(
    bundle: Path,
    registry: Registry,
    suite: str | None,
    planner: tuple[str | None, PlannerPlace],
    options: VerifyOptions,
) -> dict[str, Any]:
    """Return the verdict on a bundle as a document, also used by `crowdbot bundle --check`.

    Args:
        bundle: the archive.
        registry: the installed components.
        suite: value of the option ``--suite``.
        planner: value of the option ``--source``, and where it runs.
        options: the extent of the verification.
    """
    from crowdbot.core.bundle.archive import open_archive
    from crowdbot.core.bundle.check_edition import late
    from crowdbot.core.bundle.odds import odds_of_finding
    from crowdbot.core.bundle.verification import content_hash
    from crowdbot.core.support.stdout_guard import stdout_to_stderr

    seed = secrets.randbelow(2**32) if options.seed is None else options.seed
    options = replace(options, seed=seed)
    with open_archive(bundle) as archive, stdout_to_stderr():
        digest = content_hash(bundle)
        expansion = _suite(archive, registry, suite)
        verdict = _verify(archive, registry, (suite, expansion), planner, options, digest)
        manifest = archive.manifest
    names = {"planner": manifest.label, "edition": manifest.edition_name}
    odds = odds_of_finding(len(manifest.runs), len(verdict.relations))
    return names | _document(verdict, seed, digest) | {
        "odds": {str(k): round(p, 4) for k, p in odds.items()}, "trusted": list(options.trusted),
        "late": late(bundle, (expansion.round and expansion.round.closes) or ""),
    }  # fmt: skip


def _verify(
    archive: Archive,
    registry: Registry,
    suite: tuple[str | None, Expansion],
    planner: tuple[str | None, PlannerPlace],
    options: VerifyOptions,
    digest: str,
) -> RerunVerdict:
    from crowdbot.core.bundle.check import problems_of
    from crowdbot.core.bundle.rerun_verdict import RerunVerdict

    given, expansion = suite
    runs, problems = problems_of(archive, expansion, registry)
    if problems:
        return RerunVerdict(outcome="invalid", findings=tuple(problems))
    if options.size == 0 and not options.fresh:
        return RerunVerdict(outcome="not re-run")
    verdict = _make_reruns(archive, expansion, registry, planner, given, runs, options, digest)
    return _trusting(archive, registry, verdict, options.trusted)


def _trusting(
    archive: Archive, registry: Registry, verdict: RerunVerdict, trusted: Sequence[str]
) -> RerunVerdict:
    """Return the verdict; it becomes "untrusted plugin" if the planner's plugin is not trusted."""
    from crowdbot.core.bundle.rerun_verdict import FINE
    from crowdbot.core.campaign.verify import foreign_owners

    owners = {n: o for n, o in foreign_owners(archive.manifest, registry).items()
              if n not in trusted}  # fmt: skip
    if not owners or verdict.outcome not in FINE:
        return verdict
    findings = tuple(
        f"the planner comes with plugin '{name}' ({origin}), which is loaded into the simulator; "
        f"read its code, then --trust {name}, or have the planner handed in as a file (--source)"
        for name, origin in owners.items()
    )
    return replace(verdict, outcome="untrusted plugin", findings=(*verdict.findings, *findings))


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
        say(f"{name}: seed and salt fit {expansion.commitment}", err=True)
    return expansion


def _make_reruns(
    archive: Archive,
    expansion: Expansion,
    registry: Registry,
    planner: tuple[str | None, PlannerPlace],
    suite: str | None,
    runs: Sequence[ClaimedRun],
    options: VerifyOptions,
    digest: str,
) -> RerunVerdict:
    from crowdbot.cli.shared.one_run import end_hung_process, import_simulate, interruptible
    from crowdbot.cli.shared.progress import show_progress
    from crowdbot.core.bundle.fresh_verdict import with_fresh
    from crowdbot.core.bundle.planner_files import planner_files_of
    from crowdbot.core.bundle.rerun_verdict import RerunVerdict, verdict_of
    from crowdbot.core.campaign.unsealed import unsealed

    text, place = planner
    import_simulate()  # reports what is missing if Drake cannot be imported
    from crowdbot.core.campaign.verify import (
        NotRunnable,
        RerunSetup,
        choose_planner,
        draw_sample,
        make_fresh,
        make_reruns,
    )

    with (
        planner_files_of(archive) as kept,
        unsealed(text, replace(place, kept=kept)) as (text, place),
        interruptible() as stop,
        show_progress() as progress,
    ):
        try:
            choice = choose_planner(archive.manifest, registry, text, place)
        except NotRunnable as error:
            return RerunVerdict(outcome="cannot be re-run", findings=(str(error),))
        setup = RerunSetup(
            expansion=expansion, registry=registry, choice=choice, progress=progress, stop=stop,
            on_hang=end_hung_process,
        )  # fmt: skip
        numbers = draw_sample(runs, options.size, options.seed or 0, digest)
        reruns = make_reruns(setup, [runs[number] for number in numbers])
        verdict = verdict_of(reruns) if reruns else RerunVerdict(outcome="not re-run")
        if not options.fresh:
            return verdict
        name = suite or archive.manifest.edition.suite
        return with_fresh(verdict, make_fresh(setup, name, runs, options.fresh, options.seed or 0))


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
        "not_compared": list(verdict.not_compared),
        "fresh": list(verdict.fresh),
        "runs": dict(verdict.relations),
        "crowdbot": provenance.versions()["crowdbot"],
        "machine": provenance.machine(),
    }


def print_verdict(document: dict[str, Any]) -> None:
    """Print the findings in readable form."""
    for finding in document["findings"]:
        say(finding)
    for name, relation in document["runs"].items():
        say(f"{name}: {relation}")
    for line in document["fresh"]:
        say(line)
    if document["not_compared"]:
        say(f"not compared, since no tolerance is known: {', '.join(document['not_compared'])}")
    if document["runs"]:
        chances = (
            f"{100.0 * p:.0f} % if {k} {'is' if k == '1' else 'are'}"
            for k, p in document["odds"].items()
        )
        say(f"chance that this sample shows that runs were edited: {', '.join(chances)}")
    if document["late"]:
        say(f"warning: {document['late']}", err=True)
    head, outcome = f"{document['edition']}: {document['planner']}", document["outcome"]
    chosen = f", sample seed {document['seed']}" if document["runs"] else ""
    say(f"{head}: {outcome}: {_SAYS[outcome]}{chosen}")
