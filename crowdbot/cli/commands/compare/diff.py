"""``crowdbot diff``: compare two scenarios or two runs, field by field."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import argument, option
from crowdbot.cli.shared.options import NoPlugins, Plugins, installed
from crowdbot.cli.shared.run_arguments import AsJson

if TYPE_CHECKING:
    from crowdbot.core.runs.diff_side import DiffSide
    from crowdbot.core.support.json_diff import Difference

#: A longer value moves only its right neighbour.
_WIDEST = 72
_SIDE = "SUITE/ID, FILE#ID, a file with one scenario, or a run directory."


def diff(
    a: Annotated[str, argument("A", _SIDE)],
    b: Annotated[str, argument("B", _SIDE)],
    overrides: Annotated[
        list[str] | None,
        option("KEY=VALUE", "Set a value of B before comparing; repeatable.", "--set"),
    ] = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: AsJson = False,
) -> None:
    """Compare two scenarios or two runs; exit 0 when equal, 1 when not.

    Example: crowdbot diff challenge-2020/in-d0125-slow-c01-r02 challenge-2020/in-d0125-slow-c20-r02
    """
    from crowdbot.core.runs.diff_side import read_diff_side
    from crowdbot.core.support.json_diff import differences

    registry = installed(plugin, no_plugins)
    first = read_diff_side(a, registry)
    second = read_diff_side(b, registry, overrides or ())
    found = {"scenario": list(differences(first.scenario, second.scenario))}
    if first.run is not None and second.run is not None:
        found["run"] = list(differences(first.run, second.run))
        found["scores"] = list(differences(first.scores, second.scores))
    if as_json:
        say_json(_document(first, second, found), ensure_ascii=False)
    else:
        _print(first, second, found)
    raise typer.Exit(1 if any(found.values()) else 0)


def _document(a: DiffSide, b: DiffSide, found: dict[str, list[Difference]]) -> dict[str, Any]:
    return {
        "equal": not any(found.values()),
        "a": {"name": a.name, "hash": a.hash},
        "b": {"name": b.name, "hash": b.hash},
        **{part: [d.as_dict() for d in listed] for part, listed in found.items()},
    }


def _print(a: DiffSide, b: DiffSide, found: dict[str, list[Difference]]) -> None:
    from crowdbot.core.support.json_diff import shown

    for letter, side in (("a", a), ("b", b)):
        say(f"{letter}  {side.name}  {side.hash}")
    for part, listed in found.items():
        if not listed:
            say(f"{part}: equal")
            continue
        count = "1 difference" if len(listed) == 1 else f"{len(listed)} differences"
        say(f"{part}: {count}")
        rows = [(d.path, shown(d.a), shown(d.b)) for d in listed]
        widths = [min(_WIDEST, max(len(row[i]) for row in rows)) for i in range(2)]
        for path, left, right in rows:
            say(f"  {path:<{widths[0]}}  {left:<{widths[1]}}  {right}")
