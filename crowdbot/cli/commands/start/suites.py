"""``crowdbot suites``: list all suites with a sentence, an example and a picture."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.options import NoPlugins, Plugins, installed
from crowdbot.cli.shared.run_arguments import AsJson
from crowdbot.core.support.text import plural
from crowdbot.errors import CrowdbotError, InputError

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry

_PICTURE = re.compile(r"!\[[^\]]*\]\(([^)\s]+)\)")


def suites(
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: AsJson = False,
) -> None:
    """List all suites, also those of plugins: number of scenarios, a sentence, and a picture.

    Example: crowdbot suites
    """
    from crowdbot.core.scenarios.library import suite_names

    registry = installed(plugin, no_plugins)
    found = [_about(name, registry) for name in suite_names(registry)]
    if as_json:
        say_json(found)
        return
    for one in found:
        say(f"{one['suite']}: {one['title']}")
        if one["error"]:
            say(f"  cannot be read: {one['error']}")
            continue
        shown = one["picture"] or f"crowdbot view {one['suite']} {one['first']} --out scenario.html"
        say(f"  {plural(int(one['scenarios']), 'scenario')}, such as {one['first']}")
        say(f"  picture: {shown}")


def _about(name: str, registry: Registry) -> dict[str, str | int]:
    """Return name, title, number of scenarios, first id and picture of a suite."""
    from crowdbot.core.scenarios.library import open_spec

    about: dict[str, str | int] = {"suite": name, "title": "", "scenarios": 0, "first": ""}
    try:
        expansion = open_spec(name, registry)
    except CrowdbotError as error:
        return {**about, "picture": "", "error": str(error).splitlines()[0]}
    return {
        "suite": name,
        "title": expansion.title,
        "scenarios": len(expansion.scenarios),
        "first": expansion.scenarios[0].id if len(expansion.scenarios) else "",
        "picture": _picture(name),
        "error": "",
    }


def _picture(suite: str) -> str:
    """Return the first picture of a suite in the gallery of the documentation, if there is one."""
    from crowdbot.cli.commands.start.docs import documents

    try:
        gallery = documents() / "gallery.md"
    except InputError:
        return ""
    text = gallery.read_text(encoding="utf-8") if gallery.is_file() else ""
    section = text.partition(f"\n## {suite}\n")[2].partition("\n## ")[0]
    found = _PICTURE.search(section)
    picture = gallery.parent / found[1] if found else Path()
    return str(picture) if found and picture.is_file() else ""
