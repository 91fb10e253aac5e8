"""``crowdbot validate``: report every error of a document; only robots from files are built."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from crowdbot.cli.output.checked_documents import check_documents
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, installed


class Format(StrEnum):
    """Output formats for errors."""

    TEXT = "text"
    JSON = "json"
    GITHUB = "github"


def validate(
    specs: Annotated[list[str], argument("SPEC...", "Files, or names of packaged suites.")],
    format_: Annotated[
        Format, typer.Option("--format", help="text on stderr; json or github on stdout.")
    ] = Format.TEXT,
    against_image: Annotated[
        bool,
        switch(
            "--against-image",
            "Compare the floor made of occupancy grids with their images, cell by cell.",
        ),
    ] = False,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: Annotated[bool, switch("--json", "Same as --format json.")] = False,
    overrides: Annotated[
        list[str] | None, option("KEY=VALUE", "Set a value in every scenario; repeatable.", "--set")
    ] = None,
) -> None:
    """Check suites and scenarios; report every error with its position.

    Example: crowdbot validate challenge-2020 my_suite.yaml

    Example: crowdbot validate my_building.yaml --against-image
    """
    form = "json" if as_json else format_.value
    registry = installed(plugin, no_plugins)
    if against_image:
        from crowdbot.cli.output.plan_agreement import check_against_images

        raise typer.Exit(
            check_against_images(specs, registry, overrides or (), as_json=form == "json")
        )
    raise typer.Exit(check_documents(specs, registry, form, overrides or ()))
