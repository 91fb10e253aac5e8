"""``crowdbot challenge-page``: write the site of a challenge."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from crowdbot.cli.output.say import say
from crowdbot.cli.shared.folder_of_bundles import (
    Accept,
    FolderOfBundles,
    Keys,
    read_bundles,
)
from crowdbot.cli.shared.options import NoPlugins, Plugins, installed
from crowdbot.core.support.text import plural


def challenge_page(
    suite: Annotated[str, typer.Argument(metavar="SUITE", help="File or name of the suite.")],
    bundles: Annotated[
        Path | None,
        typer.Argument(metavar="[BUNDLES]", help="Folder of bundles (*.cbz); default: none yet."),
    ] = None,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder to write.")] = Path("site"),
    accept: Accept = None,
    key: Keys = None,
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
    from crowdbot.core.scenarios.library import open_suite
    from crowdbot.core.site.write import Site, write_site
    from crowdbot.core.statistics.rules import RULE

    registry = installed(plugin, no_plugins)
    expansion, _ = open_suite(suite, registry)
    found = FolderOfBundles(tables=(), left_out={})
    if bundles is not None:
        found = read_bundles(
            bundles, registry, RULE, accept=accept or (), keys=key or (), suites=[expansion]
        )
    site = Site(suite=suite, expansion=expansion, tables=found.tables, left_out=found.left_out)
    files = write_site(out, site, registry)
    if as_json:
        document = {"files": [str(file) for file in files], "left_out": dict(site.left_out)}
        say(json.dumps(document, indent=2))
    else:
        counts = f"{plural(len(site.entries), 'bundle')}, {plural(len(files), 'file')}"
        say(f"{counts}; wrote {files[0]}")
