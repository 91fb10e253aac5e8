"""``crowdbot draws``: hide a suite's draws until a deadline, reveal them, and check."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, SuiteArgument, installed

if TYPE_CHECKING:
    from crowdbot.core.scenarios.hidden_draws import Change

draws = typer.Typer(add_completion=False, no_args_is_help=True, pretty_exceptions_enable=False)

_Suite = Annotated[str, argument("SUITE", "File of the suite.")]
_Secret = Annotated[
    Path | None, option("FILE", "Seed and salt; default: NAME.secret.json beside the suite.")
]
_Print = Annotated[bool, switch("--print", "Print the lines and leave the suite's file as it is.")]
_Json = Annotated[bool, switch("--json", "JSON on stdout.")]


@draws.callback()
def about() -> None:
    """Hide the draws of a suite until a deadline: commit first, reveal after it.

    Example: crowdbot draws commit my_suite.yaml
    """


@draws.command("commit")
def commit(
    suite: _Suite,
    secret: _Secret = None,
    seed_file: Annotated[
        Path | None, option("FILE", "The seed; default: from the system's entropy.")
    ] = None,
    print_only: _Print = False,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: _Json = False,
) -> None:
    """Choose seed and salt, keep them in a separate file, and write their hash into the suite.

    Example: crowdbot draws commit my_suite.yaml --secret ../my_suite.secret.json
    """
    from crowdbot.core.scenarios import hidden_draws as hidden

    seed = None if seed_file is None else hidden.read_seed(seed_file)
    chosen, change = hidden.commit(suite, installed(plugin, no_plugins), seed)
    path = secret or hidden.secret_path(change.path)
    hidden.write_secret(path, chosen)
    if not print_only:
        try:
            hidden.write_change(change)
        except BaseException:
            with contextlib.suppress(OSError):
                path.unlink()  # a secret whose commitment was not published
            raise
    if as_json:
        document = {"suite": chosen.suite, "commitment": chosen.commitment, "secret": str(path)}
        say_json(document | _what(change, print_only))
        return
    _say(change, print_only)
    say(f"{chosen.suite}: publish {chosen.commitment}")
    say(f"seed and salt are in {path}: keep it, and keep it to yourself, until the deadline")


@draws.command("reveal")
def reveal(
    suite: _Suite,
    secret: _Secret = None,
    print_only: _Print = False,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: _Json = False,
) -> None:
    """Write seed and salt into the suite, if they fit its commitment.

    Example: crowdbot draws reveal my_suite.yaml --secret ../my_suite.secret.json
    """
    from crowdbot.core.scenarios import hidden_draws as hidden
    from crowdbot.core.scenarios.library import open_document

    registry = installed(plugin, no_plugins)
    path = secret or hidden.secret_path(open_document(suite, registry).path)
    found, change = hidden.reveal(suite, registry, path)
    if not print_only:
        hidden.write_change(change)
    if as_json:
        document = {"suite": found.suite, "commitment": found.commitment, "seed": found.seed}
        document |= {"salt": found.salt}
        say_json(document | _what(change, print_only))
        return
    _say(change, print_only)
    say(f"{found.suite}: seed {found.seed} is what was committed to; now: crowdbot lock")


@draws.command("check")
def check(
    suite: SuiteArgument,
    commitment: Annotated[
        str | None,
        option(
            "sha256:HEX", "The hash that the organiser published before the draws were revealed."
        ),
    ] = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: _Json = False,
) -> None:
    """Check that the draws of a suite are hidden, or revealed as committed.

    Exit code 1 if seed and salt do not fit, or the commitment is not the given one.

    Example: crowdbot draws check my_suite.yaml --commitment sha256:0123…
    """
    from crowdbot.core.scenarios.hidden_draws import expanded
    from crowdbot.core.scenarios.library import open_document
    from crowdbot.errors import InputError

    registry = installed(plugin, no_plugins)
    document = open_document(suite, registry)
    expanded(document, registry)  # its files, too, are those of the commitment
    found = document.suite
    if commitment is not None and found.commitment != commitment:
        there = found.commitment or "none"
        raise InputError(f"{document.name}: its commitment is {there}, not {commitment}")
    state = "open"
    if found.commitment:
        state = "hidden" if found.hidden else "revealed"
    if as_json:
        row = {"suite": found.id, "commitment": found.commitment or None, "draws": state}
        say_json(row)
        return
    texts = {
        "open": "its draws are open; nothing was committed to",
        "hidden": f"its draws are hidden, committed to by {found.commitment}",
        "revealed": f"its draws are revealed, and are those of {found.commitment}",
    }
    say(f"{found.id}: {texts[state]}")


def _what(change: Change, print_only: bool) -> dict[str, object]:
    return {"file": None if print_only else str(change.path), "lines": list(change.lines)}


def _say(change: Change, print_only: bool) -> None:
    for line in change.lines:
        say(line)
    if not print_only:
        say(f"wrote {change.path}")
