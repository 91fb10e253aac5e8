"""``crowdbot plugins``: list installed plugins, show their components, and check them."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Annotated

import typer

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, installed

plugins = typer.Typer(
    add_completion=False, context_settings={"help_option_names": ["-h", "--help"]}
)
_Json = Annotated[bool, switch("--json", "JSON on stdout.")]
_LOG = logging.getLogger("crowdbot")


@plugins.callback(invoke_without_command=True)
def listing(
    context: typer.Context,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: _Json = False,
) -> None:
    """List plugins, working or not, and their components; -v shows tracebacks.

    Example: crowdbot plugins show lidar2d
    """
    if context.invoked_subcommand is not None:
        if plugin or no_plugins or as_json:
            context.fail(f"options of '{context.invoked_subcommand}' stand behind it")
        return
    from crowdbot.cli.output.plugin_table import as_dicts, as_text, tracebacks

    registry = installed(plugin, no_plugins, strict=False)
    registry.import_components()
    if as_json:
        say_json(as_dicts(registry))
        return
    say(as_text(registry))
    if _LOG.isEnabledFor(logging.DEBUG):
        for text in tracebacks(registry):
            say(text, err=True)


@plugins.command()
def show(
    kind: Annotated[str, argument("KIND", "Name of a component.")],
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: _Json = False,
) -> None:
    """Show a component: summary, fields, an example, documentation and source.

    Example: crowdbot plugins show ttca_dca
    """
    from crowdbot.cli.output.component_page import as_dict, as_text
    from crowdbot.errors import UnknownNameError

    registry = installed(plugin, no_plugins)
    everything = [c for p in registry.plugins for c in p.components]
    found = [c for c in everything if c.kind == kind]
    if not found:
        known = {c.kind for c in everything}
        raise UnknownNameError("kind", kind, known, registry.why_absent(kind))
    if as_json:
        say_json([as_dict(c, registry) for c in found])
    else:
        say("\n\n".join(as_text(c, registry) for c in found))


@plugins.command()
def check(
    name: Annotated[str | None, argument("[NAME]", "A plugin, or the kind of a component.")] = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: _Json = False,
) -> None:
    """Check that components satisfy crowdbot's contracts; exit code 1 if a check fails.

    Without NAME, the plugins given by --plugin are checked.

    Example: crowdbot plugins check goal_seek
    """
    from crowdbot.cli.output.check import Result, as_table, chosen, failed_plugins, run_checks
    from crowdbot.core.support.stdout_guard import stdout_to_stderr

    if name is None and not plugin:
        raise typer.BadParameter("name a plugin or a kind, or give one by --plugin")
    registry = installed(plugin, no_plugins, strict=False)
    registry.import_components()
    results: list[Result] = failed_plugins(registry, name)
    if not results:
        components = chosen(registry, name)
        with stdout_to_stderr():
            results = [r for c in components for r in run_checks(c, registry)]
    if as_json:
        say_json([r.as_dict() for r in results])
    else:
        chatty, all_lines = (_LOG.isEnabledFor(n) for n in (logging.INFO, logging.DEBUG))
        say(as_table(results, passed=chatty, all_lines=all_lines))
    raise typer.Exit(1 if any(r.bad for r in results) else 0)


@plugins.command()
def new(
    name: Annotated[str, argument("NAME", "Name of the plugin: a word such as acme.")],
    out: Annotated[Path | None, option("DIR", "Folder to write; default: crowdbot-NAME.")] = None,
    planner: Annotated[
        bool, switch("--planner", "One planner alone, which sees people with the tracker.")
    ] = False,
) -> None:
    """Write a starter package with one component of each kind, a suite and tests.

    Example: crowdbot plugins new acme
    """
    from crowdbot.cli.output.new import write_package

    folder = write_package(name, out, installed(None), "planner" if planner else "plugin")
    say(f"{folder}: plugin '{name}'; next:", err=True)
    say(f"  pip install -e {folder}", err=True)
    say(f"  crowdbot plugins check {name}", err=True)
    first = "social-guidelines frontal_approach" if planner else f"{name}:first strolling"
    say(
        f"  crowdbot simulate {first} --planner {name}.{'give_way' if planner else 'wander'}",
        err=True,
    )
    say(str(folder))
