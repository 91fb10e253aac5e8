"""``crowdbot bundle``: pack the runs of one planner into a checkable archive."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, installed
from crowdbot.core.support.text import plural, size_text
from crowdbot.dsl.suite.suite_entry import NO_SUITE
from crowdbot.errors import UsageError

if TYPE_CHECKING:
    from crowdbot.core.bundle.manifest import Manifest
    from crowdbot.core.registry.registry import Registry
    from crowdbot.dsl.suite.expansion import Expansion


def bundle(
    root: Annotated[Path, argument("[ROOT]", "Root of the run directories.")] = Path("runs"),
    suite: Annotated[str | None, option("SPEC", "The suite that was run: file or name.")] = None,
    planner: Annotated[str | None, option("LABEL", "The planner: name of its folders.")] = None,
    out: Annotated[
        Path | None, option("FILE", "File to write; default: SUITE-PLANNER.cbz.")
    ] = None,
    team: Annotated[str, option("NAME", "Name of the team, for the leaderboard.")] = "",
    contact: Annotated[str, option("TEXT", "Whom to ask about the bundle.")] = "",
    partial: Annotated[
        bool, switch("--partial", "Pack the runs that are there, even if some are missing.")
    ] = False,
    recordings: Annotated[bool, switch("--recordings", "Pack the recordings, too.")] = False,
    check: Annotated[bool, switch("--check", "Also do what the organiser's verify does.")] = False,
    sample: Annotated[
        int, typer.Option(min=0, metavar="N", help="--check: how many runs to make again.")
    ] = 5,
    seed: Annotated[
        int | None,
        typer.Option(min=0, metavar="S", help="--check: seed of the sample; default: a new one."),
    ] = None,
    source: Annotated[
        str | None, option("FILE.py:CLASS|FILE.yaml", "--check: the planner, if not installed.")
    ] = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: Annotated[bool, switch("--json", "The manifest as JSON on stdout.")] = False,
) -> None:
    """Pack scores, hashes, scenarios and provenance of one planner's runs into one archive.

    The same runs give the same bytes. crowdbot verify checks the archive and repeats some of its
    runs.

    Example: crowdbot bundle runs --suite challenge-2020 --planner dwa --out team.cbz --check
    """
    from crowdbot.cli.commands.challenge.verify import VerifyOptions, print_verdict, verify_bundle
    from crowdbot.core.bundle.pack import Submission, other_seeds, pack
    from crowdbot.core.planning.choice import ANYWHERE
    from crowdbot.core.registry.plugin import BUILTIN
    from crowdbot.core.scenarios.library import open_suite
    from crowdbot.core.scenarios.lock_check import check_revealed

    registry = installed(plugin, no_plugins)
    if root.is_file() or suite is None:
        raise _usage(root, suite, registry)
    expansion, lock = open_suite(suite, registry)
    for scenario in expansion.scenarios:
        check_revealed(scenario)
    if planner is None:
        raise _usage(root, suite, registry)
    submission = Submission(
        root=root, planner=planner, team=team, contact=contact, partial=partial,
        recordings=recordings,
    )  # fmt: skip
    target = out or Path(f"{expansion.suite_id}-{planner}.cbz")
    manifest = pack(submission, expansion, lock, registry, target)
    for line in _warnings(expansion, other_seeds(submission, expansion)):
        say(f"warning: {line}", err=True)
    verdict = None
    if check:
        # The team trusts its own plugins.
        own = tuple(p.name for p in registry.plugins if p.name != BUILTIN)
        options = VerifyOptions(size=sample, seed=seed, trusted=own)
        verdict = verify_bundle(target, registry, suite, (source, ANYWHERE), options)
    if as_json:
        document = {"bundle": str(target), **manifest.model_dump(mode="json")}
        say_json(document | ({"check": verdict} if verdict else {}))
    else:
        _print_manifest(manifest, target)
        if verdict is not None:
            print_verdict(verdict)
    if verdict is not None and not verdict["ok"]:
        raise typer.Exit(1)


def _usage(root: Path, suite: str | None, registry: Registry) -> UsageError:
    """Return the error of a command without runs, suite or planner."""
    if root.is_file():
        return UsageError(
            f"{root} is a file; ROOT is a folder of runs. To check a bundle that is there: "
            f"crowdbot verify {root}"
        )
    if suite is None:
        question = "which runs? Give --suite SPEC and --planner LABEL"
    else:
        question = "which planner? Give --planner LABEL"
    return UsageError(f"{question}; {_offer(root, registry)}")


def _print_manifest(manifest: Manifest, target: Path) -> None:
    lacking = f", {len(manifest.missing)} missing" if manifest.missing else ""
    say(
        f"{manifest.edition_name}: {manifest.label}, {plural(len(manifest.runs), 'run')}{lacking}, "
        f"{plural(len(manifest.members), 'file')}, {size_text(target.stat().st_size)}"
    )
    say(f"wrote {target}")


def _warnings(expansion: Expansion, other_seeds: Sequence[int]) -> list[str]:
    """Return warnings: conflicts with the suite's challenge round, and seeds left out."""
    lines = _round_lines(expansion)
    if other_seeds:
        seeds = ", ".join(map(str, other_seeds))
        lines.append(f"left out: seeds {seeds}, which the suite does not name")
    return lines


def _round_lines(expansion: Expansion) -> list[str]:
    """Return why the suite's challenge round would not accept this bundle now, if it would not."""
    if expansion.round is None:
        return []
    lines = [expansion.round.problem(datetime.now(UTC))]
    if expansion.round.planners == "sealed":
        lines.append("this round ranks sealed planners only: hand in what crowdbot seal writes")
    return [line for line in lines if line]


def _offer(root: Path, registry: Registry) -> str:
    """Return the suites and planners of the runs below a folder, in words.

    Raises:
        InputError: there is no such folder.
    """
    from crowdbot.core.results.results import Results
    from crowdbot.core.scenarios.library import suite_names

    packaged = suite_names(registry)
    runs = Results.open(root).without_altered().runs
    counts = Counter((run.suite, run.planner) for run in runs if run.suite != NO_SUITE)
    if not counts:
        return f"no run of a suite is below {root}"
    offers = [
        f"  --suite {s if s in packaged else 'FILE'} --planner {p}   "
        f"({plural(n, 'run')}{'' if s in packaged else f', FILE: that of {s}'})"
        for (s, p), n in counts.items()
    ]
    return "\n".join([f"below {root} there are:", *offers])
