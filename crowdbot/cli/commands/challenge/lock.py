"""``crowdbot lock``: freeze the agents and hashes of a suite, or check them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, SuiteArgument, installed
from crowdbot.cli.shared.run_arguments import AsJson
from crowdbot.core.support.text import plural

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.dsl.scenario.lock import LockFiles
    from crowdbot.dsl.suite.expansion import Expansion


def lock(
    spec: SuiteArgument,
    check: Annotated[
        bool, switch("--check", "Write nothing; exit 1 if the lock does not fit.")
    ] = False,
    redraw: Annotated[
        bool, switch("--redraw", "Sample all agents again, even if nothing changed.")
    ] = False,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: AsJson = False,
) -> None:
    """Draw the agents of a suite once and freeze them, with the hashes of its scenarios.

    NAME.lock.json and NAME.agents.csv are written beside NAME.yaml; crowdbot simulate then reads
    the agents and never draws them. Agents whose scenarios did not change are kept. A suite that
    draws the same agents as one that it extends shares the other's file.

    Example: crowdbot lock my_suite.yaml; crowdbot lock challenge-2020 --check
    """
    from crowdbot.core.scenarios.library import open_suite

    if check and redraw:
        raise typer.BadParameter("--check writes nothing, --redraw writes; give one of them")
    registry = installed(plugin, no_plugins)
    expansion, files = open_suite(spec, registry)
    if check:
        _check(expansion, files, registry, as_json=as_json)
    else:
        _write(expansion, files, registry, redraw=redraw, as_json=as_json)
        if not expansion.commitment and _without_seed(spec, registry):
            say("warning: the suite gives no seed, so 0 holds; suite.seed says another", err=True)


def _without_seed(spec: str, registry: Registry) -> bool:
    """Return True for a suite that draws people without naming a seed."""
    from crowdbot.core.scenarios.library import open_document

    document = open_document(spec, registry).suite
    head = document.tree.child("suite")
    return document.seed is not None and (head is None or head.child("seed") is None)


def _check(expansion: Expansion, files: LockFiles, registry: Registry, *, as_json: bool) -> None:
    from crowdbot.core.scenarios.lock_check import differences
    from crowdbot.errors import InputError

    if not files.lock_path.exists():
        raise InputError(f"{files.spec} has no lock ({files.lock_path.name}); run {files.command}")
    found = differences(expansion, files, registry)
    count = len(expansion.scenarios)
    if as_json:
        listed = [d.as_dict() for d in found]
        document = {"suite": expansion.suite_id, "ok": not found, "differences": listed}
        say_json(document)
    elif found:
        for difference in found:
            say(str(difference))
        say(f"{plural(len(found), 'difference')}; to accept: {files.command}", err=True)
    else:
        say(f"{expansion.suite_id}: the lock fits, {plural(count, 'scenario')}")
    raise typer.Exit(1 if found else 0)


def _write(
    expansion: Expansion, files: LockFiles, registry: Registry, *, redraw: bool, as_json: bool
) -> None:
    from crowdbot.core.scenarios.library import check_writable
    from crowdbot.core.scenarios.lock import make_lock, write_lock

    check_writable(files)
    made = make_lock(expansion, registry, files, redraw=redraw)
    write_lock(files, made)
    scenarios, draws = len(made.lock.scenarios), len(made.lock.draws)
    if as_json:
        document = {
            "suite": expansion.suite_id,
            "lock": str(files.lock_path),
            "agents": str(made.agents_path(files)),
            "scenarios": scenarios,
            "draws": draws,
            "drawn": made.drawn,
        }
        say_json(document)
        return
    say(
        f"{expansion.suite_id}: {plural(scenarios, 'scenario')}, "
        f"{plural(draws, 'table')} of agents ({made.drawn} drawn, {draws - made.drawn} kept)"
    )
    shared = made.lock.agents
    agents = f"which shares {shared}" if shared else f"and {files.own_agents_path.name}"
    say(f"wrote {files.lock_path} {agents}")
