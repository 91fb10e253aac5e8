"""``crowdbot validate``: every error of a document, without building anything."""

from __future__ import annotations

import json
import logging
from collections.abc import Iterator
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli._options import NoPlugins, Plugins, installed
from crowdbot.errors import SpecError, UnknownNameError

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.dsl.diagnostics import Diagnostic
    from crowdbot.dsl.lock import LockFiles

_LOG = logging.getLogger(__name__)


class Format(StrEnum):
    """How errors are written."""

    TEXT = "text"
    JSON = "json"
    GITHUB = "github"


def validate(
    specs: Annotated[
        list[str], typer.Argument(metavar="SPEC...", help="Files, or names of packaged suites.")
    ],
    format_: Annotated[
        Format, typer.Option("--format", help="text on stderr; json or github on stdout.")
    ] = Format.TEXT,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: Annotated[bool, typer.Option("--json", help="Same as --format json.")] = False,
) -> None:
    """Check suites and scenarios; report every error with its place.

    Example: crowdbot validate challenge-2020 my_suite.yaml
    """
    registry = installed(plugin, no_plugins)
    results = {spec: _check(spec, registry) for spec in dict.fromkeys(specs)}
    errors = [d for _, found in results.values() for d in found]
    if as_json or format_ is Format.JSON:
        typer.echo(_as_json(results))
    elif format_ is Format.GITHUB:
        for diagnostic in errors:
            typer.echo(_as_github(diagnostic))
    else:
        _print_text(results, errors)
    raise typer.Exit(1 if errors else 0)


def _check(spec: str, registry: Registry) -> tuple[int, list[Diagnostic]]:
    """Number of scenarios, errors."""
    from crowdbot.core.support.seldom_collected import seldom_collected

    with seldom_collected():
        return _check_all(spec, registry)


def _check_all(spec: str, registry: Registry) -> tuple[int, list[Diagnostic]]:
    from crowdbot.core.scenarios.library import open_suite
    from crowdbot.dsl.diagnostics import Diagnostic, Mark, Source

    try:
        expansion, files = open_suite(spec, registry)
        return len(expansion.scenarios), list(_lock_problems(files))
    except SpecError as error:
        return 0, list(error.diagnostics)
    except UnknownNameError as error:
        return 0, [Diagnostic("E001", str(error), Mark(Source(spec)))]


def _lock_problems(files: LockFiles) -> Iterator[Diagnostic]:
    """What is wrong with the files of a lock as such; whether it fits is 'lock --check'."""
    from crowdbot.dsl.diagnostics import Diagnostic, Mark, Source
    from crowdbot.errors import InputError

    if not files.lock_path.exists():
        return
    checks = ((files.lock_path, lambda: files.lock), (files.agents_path, files.check_tables))
    for path, check in checks:
        try:
            check()
        except InputError as error:
            yield Diagnostic("E001", str(error), Mark(Source(str(path))))


def _print_text(results: dict[str, tuple[int, list[Diagnostic]]], errors: list[Diagnostic]) -> None:
    from crowdbot.dsl.diagnostics import render

    for spec, (count, found) in results.items():
        if not found and _LOG.isEnabledFor(logging.INFO):
            typer.echo(f"{spec}: ok, {'1 scenario' if count == 1 else f'{count} scenarios'}")
    if errors:
        typer.echo(render(errors), err=True)


def _as_json(results: dict[str, tuple[int, list[Diagnostic]]]) -> str:
    listed = [
        {"spec": spec, "ok": not found, "scenarios": count, "errors": [d.as_dict() for d in found]}
        for spec, (count, found) in results.items()
    ]
    return json.dumps(listed, indent=2)


def _as_github(diagnostic: Diagnostic) -> str:
    """A workflow command; its own characters are escaped."""
    mark = diagnostic.mark
    text = diagnostic.message + (f" ({diagnostic.hint})" if diagnostic.hint else "")
    place = f"file={_escape(mark.source.name, ':,')},line={mark.line + 1},col={mark.column + 1}"
    return f"::error {place},title={diagnostic.code}::{_escape(text)}"


def _escape(text: str, more: str = "") -> str:
    return "".join(f"%{ord(c):02X}" if c in "%\r\n" + more else c for c in text)
