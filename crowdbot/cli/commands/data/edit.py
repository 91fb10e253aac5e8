"""``crowdbot edit``: draw a scenario in the browser."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Annotated

import typer

from crowdbot.cli.output.say import say
from crowdbot.cli.shared.option import argument, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, check_ending, installed


def edit(
    spec: Annotated[Path, argument("FILE", "A scenario, .yaml; a new one may not exist yet.")],
    port: Annotated[
        int, typer.Option(min=0, max=65535, metavar="PORT", help="Port; 0: a free one.")
    ] = 0,
    browser: Annotated[bool, switch("--open/--no-open", "Show the page in the browser.")] = True,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
) -> None:
    """Draw a scenario on a local page; comments and order of its YAML are kept.

    Example: crowdbot edit my_scenario.yaml
    """
    from crowdbot.core.editor.desk import Desk
    from crowdbot.core.editor.server import Server
    from crowdbot.errors import InputError

    check_ending(spec, ".yaml", ".yml")
    desk = Desk(spec, installed(plugin, no_plugins))
    desk.opened()  # compiles nothing, and says early what cannot be read
    try:
        server = Server(desk, port)
    except OSError as error:
        raise InputError(f"--port {port}: {error.strerror or error}") from error
    say(f"edit: {server.url} (Ctrl-C ends it)", err=True)
    if browser:
        typer.launch(server.url)
    with suppress(KeyboardInterrupt):
        server.run()
