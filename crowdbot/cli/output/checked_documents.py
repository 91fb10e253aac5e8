"""Run ``crowdbot validate`` on documents and format the errors."""

from __future__ import annotations

import json
import logging
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from crowdbot.cli.output.described_robots import robot_faults
from crowdbot.cli.output.say import say
from crowdbot.errors import SpecError, UnknownNameError

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.dsl.scenario.lock import LockFiles
    from crowdbot.dsl.text.diagnostics import Diagnostic

_LOG = logging.getLogger(__name__)


def check_documents(
    specs: Sequence[str], registry: Registry, form: str = "text", overrides: Sequence[str] = ()
) -> int:
    """Check documents and print errors: as text on stderr, other formats on stdout.

    Args:
        specs: files, or names of packaged suites.
        form: ``text``, ``json`` or ``github``.
        overrides: ``KEY=VALUE`` for every scenario.

    Returns:
        The exit code: 1 if there are errors.
    """
    results = {spec: _check(spec, registry, overrides) for spec in dict.fromkeys(specs)}
    errors = [d for _, found in results.values() for d in found]
    if form == "json":
        say(_as_json(results))
    elif form == "github":
        for diagnostic in errors:
            say(_as_github(diagnostic))
    else:
        _print_text(results, errors)
    return 1 if errors else 0


def _check(spec: str, registry: Registry, overrides: Sequence[str]) -> tuple[int, list[Diagnostic]]:
    """Return the number of scenarios, and the errors."""
    from crowdbot.core.support.gc_throttle import throttled_gc

    with throttled_gc():
        return _check_all(spec, registry, overrides)


def _check_all(
    spec: str, registry: Registry, overrides: Sequence[str]
) -> tuple[int, list[Diagnostic]]:
    from crowdbot.core.scenarios.library import open_suite
    from crowdbot.dsl.text.diagnostics import Diagnostic, Mark, Source

    try:
        expansion, files = open_suite(spec, registry, overrides)
        faults = [*_lock_problems(files), *robot_faults(expansion, registry)]
        return len(expansion.scenarios), faults
    except SpecError as error:
        return 0, list(error.diagnostics)
    except UnknownNameError as error:
        return 0, [Diagnostic("E001", str(error), Mark(Source(spec)))]


def _lock_problems(files: LockFiles) -> Iterator[Diagnostic]:
    """Yield errors in a lock's files; only `crowdbot lock --check` tests if they are current."""
    from crowdbot.dsl.text.diagnostics import Diagnostic, Mark, Source
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
    from crowdbot.dsl.text.diagnostics import render

    for spec, (count, found) in results.items():
        if not found and _LOG.isEnabledFor(logging.INFO):
            say(f"{spec}: ok, {'1 scenario' if count == 1 else f'{count} scenarios'}")
    if errors:
        say(render(errors), err=True)


def _as_json(results: dict[str, tuple[int, list[Diagnostic]]]) -> str:
    listed = [
        {"spec": spec, "ok": not found, "scenarios": count, "errors": [d.as_dict() for d in found]}
        for spec, (count, found) in results.items()
    ]
    return json.dumps(listed, indent=2)


def _as_github(diagnostic: Diagnostic) -> str:
    """Return a workflow command with its special characters escaped."""
    mark = diagnostic.mark
    text = diagnostic.message + (f" ({diagnostic.hint})" if diagnostic.hint else "")
    place = f"file={_escape(mark.source.name, ':,')},line={mark.line + 1},col={mark.column + 1}"
    return f"::error {place},title={diagnostic.code}::{_escape(text)}"


def _escape(text: str, more: str = "") -> str:
    return "".join(f"%{ord(c):02X}" if c in "%\r\n" + more else c for c in text)
