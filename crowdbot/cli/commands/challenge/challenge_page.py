"""``crowdbot challenge-page``: write the site of a challenge."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli.output.say import say
from crowdbot.cli.shared.options import NoPlugins, Plugins, installed
from crowdbot.core.support.text import plural
from crowdbot.errors import InputError

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.site.write import Site


def challenge_page(
    suite: Annotated[str, typer.Argument(metavar="SUITE", help="File or name of the suite.")],
    bundles: Annotated[
        Path | None,
        typer.Argument(metavar="[BUNDLES]", help="Folder of bundles (*.cbz); default: none yet."),
    ] = None,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder to write.")] = Path("site"),
    accept: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Compare although this differs; repeatable."),
    ] = None,
    key: Annotated[
        list[str] | None,
        typer.Option(
            metavar="HEX", help="Believe records that this public key signed; repeatable."
        ),
    ] = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: Annotated[bool, typer.Option("--json", help="The files as JSON on stdout.")] = False,
) -> None:
    """Write the site of a challenge: dates, rules, how to take part, scenarios, leaderboard.

    Dates and rules are the suite's round. Pictures show the first draw of each condition, once
    the draws are revealed. Replays show the best and a typical run of the first three planners
    whose bundles have recordings. All pages work offline.

    Example: crowdbot challenge-page challenge.yaml bundles --out site
    """
    from crowdbot.core.site.write import write_site

    registry = installed(plugin, no_plugins)
    site = _site(suite, bundles, registry, accept or [], key or [])
    for name, why in site.left_out.items():
        say(f"warning: {name} is left out: {why}", err=True)
    files = write_site(out, site, registry)
    if as_json:
        document = {"files": [str(file) for file in files], "left_out": dict(site.left_out)}
        say(json.dumps(document, indent=2))
    else:
        counts = f"{plural(len(site.entries), 'bundle')}, {plural(len(files), 'file')}"
        say(f"{counts}; wrote {files[0]}")


def _site(
    suite: str, bundles: Path | None, registry: Registry, accept: list[str], keys: list[str]
) -> Site:
    """Return the contents of a site.

    Raises:
        InputError: bundles cannot be read, or one is of another suite.
    """
    from crowdbot.core.bundle.entries import load_entries
    from crowdbot.core.bundle.signature import check_public_key, own_public_key
    from crowdbot.core.bundle.standings import set_apart, standings
    from crowdbot.core.scenarios.library import open_suite
    from crowdbot.core.scoring.score_scale import score_scales
    from crowdbot.core.site.write import Site
    from crowdbot.core.statistics.audit import AUDIT, read_audit
    from crowdbot.core.statistics.rules import RULE

    expansion, _ = open_suite(suite, registry)
    if bundles is None:
        return Site(suite=suite, expansion=expansion, tables=())
    trusted = {check_public_key(text) for text in keys} | {own_public_key()} - {""}
    entries, left_out = load_entries(bundles, registry, trusted)
    other = {e.path.name for e in entries if e.manifest.edition.suite != expansion.suite_id}
    if len(other) == len(entries):
        raise InputError(f"{bundles}: no bundle of {expansion.suite_id} there")
    left_out |= dict.fromkeys(sorted(other), f"it is not of {expansion.suite_id}")
    kept, apart = set_apart([e for e in entries if e.path.name not in other], accept)
    audits = [read_audit(path) for path in sorted(bundles.glob(f"*{AUDIT}"))]
    tables = standings(kept, RULE, accept, audits, score_scales(registry))
    return Site(
        suite=suite, expansion=expansion, tables=tables,
        entries=[e for table in tables for e in table.entries],
        left_out=dict(sorted((left_out | apart).items())),
    )  # fmt: skip
