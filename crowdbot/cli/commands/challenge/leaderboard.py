"""``crowdbot leaderboard``: build one page from a folder of bundles."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.folder_of_bundles import Accept, Keys, read_bundles
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, check_ending, installed
from crowdbot.core.support.text import plural


def leaderboard(
    folder: Annotated[Path, argument("FOLDER", "Folder with bundles (*.cbz).")],
    out: Annotated[Path, option("FILE", "File to write, .html: the page.")] = (
        Path("leaderboard.html")
    ),
    by: Annotated[
        str, option("METRIC", "Metric that decides the order; rule: the ranking rule.")
    ] = "rule",
    title: Annotated[str, option("TEXT", "Heading.")] = "Leaderboard",
    suite: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SPEC",
            help="Only bundles of this suite, by the dates and form of its round, whatever they "
            "say; repeatable.",
        ),
    ] = None,
    accept: Accept = None,
    audit: Annotated[
        list[Path] | None,
        option("FILE", "Audit of a suite; repeatable. Default: FOLDER/*audit.json."),
    ] = None,
    key: Keys = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: Annotated[bool, switch("--json", "The order as JSON on stdout.")] = False,
) -> None:
    """Rank the bundles of a folder, by edition and class, on one offline page.

    Bundles are ordered by the ranking rule: safety is a condition, efficiency and acceptance are
    weighed up. Bundles without a significant difference share a rank. Scores of older metric
    versions are computed again if a bundle has recordings, and otherwise left out.

    Example: crowdbot leaderboard bundles --out leaderboard.html --by spl
    """
    from crowdbot.core.bundle.leaderboard import write_leaderboard
    from crowdbot.core.scenarios.library import open_suite
    from crowdbot.core.statistics.rules import RULE
    from crowdbot.errors import UnknownNameError

    check_ending(out, ".html")
    registry = installed(plugin, no_plugins)
    if by != RULE and by not in registry.components("metric"):
        raise UnknownNameError("metric", by, registry.components("metric"), registry.why_absent(by))
    found = read_bundles(
        folder, registry, by, accept=accept or (), keys=key or (), audits=audit or (),
        suites=[open_suite(name, registry)[0] for name in suite or ()],
    )  # fmt: skip
    tables = found.tables
    write_leaderboard(out, tables, found.left_out, title)
    if as_json:
        document = [
            {"edition": t.edition, "class": t.classed, "by": t.by, "suspicion": t.suspicion,
             "crowds": t.crowds,
             "by_crowd": None if t.by_crowd is None else t.by_crowd.as_json(),
             "entries": [{"name": e.name, "rank": t.rank(by, e), "file": e.path.name}
                         for e in t.entries]}
            for t in tables
        ]  # fmt: skip
        whole = {"page": str(out), "tables": document, "left_out": dict(found.left_out)}
        say_json(whole)
        return
    count = sum(len(table.entries) for table in tables)
    counts = f"{plural(count, 'bundle')}, {plural(len(tables), 'table')}"
    say(f"{counts}; wrote {out}")
