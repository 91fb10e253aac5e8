"""``crowdbot challenge-page``: write the site of a challenge."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.folder_of_bundles import (
    Accept,
    FolderOfBundles,
    Keys,
    read_bundles,
    trusted_keys,
)
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, installed
from crowdbot.core.support.text import plural


def challenge_page(
    suite: Annotated[str, argument("SUITE", "File or name of the suite.")],
    bundles: Annotated[
        Path | None, argument("[BUNDLES]", "Folder of bundles (*.cbz); default: none yet.")
    ] = None,
    out: Annotated[Path, option("DIR", "Folder to write.")] = Path("site"),
    accept: Accept = None,
    key: Keys = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: Annotated[bool, switch("--json", "The files as JSON on stdout.")] = False,
) -> None:
    """Write the site of a challenge: dates, rules, how to take part, scenarios, leaderboard.

    Dates and rules come from the suite's round. Pictures show the first draw of each
    condition, without people while the draws are hidden. Replays show the best and a typical run
    of the three best planners that have recordings. The suite's files and the bundles are
    copied into the folder.
    While a judge only receives planners, give its folder: the page shows their number.

    Example: crowdbot challenge-page challenge.yaml bundles --out site
    """
    from crowdbot.core.bundle.judge_log import LOG, RECEIVED, read_log
    from crowdbot.core.scenarios.library import open_suite
    from crowdbot.core.site.write import Site, write_site
    from crowdbot.core.statistics.rules import RULE

    registry = installed(plugin, no_plugins)
    expansion, lock = open_suite(suite, registry)
    folder = FolderOfBundles(tables=(), left_out={})
    lines = [] if bundles is None else read_log(bundles / LOG, trusted_keys(key or ()))
    if bundles is not None and (not lines or any(bundles.glob("*.cbz"))):
        folder = read_bundles(
            bundles, registry, RULE, accept=accept or (), keys=key or (), suites=[expansion]
        )
    site = Site(
        suite=suite, expansion=expansion, lock=lock, tables=folder.tables, left_out=folder.left_out,
        received=sum(line.event == RECEIVED for line in lines),
        log_hash=lines[-1].sha256 if lines else "",
    )  # fmt: skip
    if site.few_crowds and not site.entries:
        say(f"warning: {site.few_crowds}", err=True)
    files = write_site(out, site, registry)
    if as_json:
        document = {"files": [str(file) for file in files], "left_out": dict(site.left_out)}
        say_json(document)
    else:
        received = f"{site.received} received, " if site.received else ""
        counts = f"{received}{plural(len(site.entries), 'bundle')}, {plural(len(files), 'file')}"
        say(f"{counts}; wrote {files[0]}")
