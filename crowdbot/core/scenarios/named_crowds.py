"""Crowds by name: parts in ``parts/crowds`` of all plugins, files, and kinds of policies."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from crowdbot.core.registry.registry import Registry
from crowdbot.core.scenarios.library import installed
from crowdbot.core.scenarios.plugin_folders import plugin_folders
from crowdbot.core.support.text_files import input_bytes
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.suite.expand import expand_document, load_document
from crowdbot.dsl.text.diagnostics import Diagnostic
from crowdbot.errors import InputError, SpecError, UnknownNameError

_BUILTIN = "builtin"
_PLACE = Path("parts") / "crowds"
_GIVEN = "given"
_DOCUMENT = """\
crowdbot: 1
scenario:
  id: crowd
  extends: [{extends}]
  environment:
    kind: corridor
    length: 50 m
    width: 10 m
    zones: {{crowd: {{x: [5 m, 45 m], y: [-5 m, 5 m]}}}}
    portals:
      a: {{x: [-1 m, 0 m], y: [-5 m, 5 m]}}
      b: {{x: [50 m, 51 m], y: [-5 m, 5 m]}}
  crowd:
    flow: {{direction: in, density: 0.25 1/m^2, area: crowd}}{policy}
"""
#: Defaults of a named crowd: the speeds of recorded people.
_USUAL = "crowd.speed: {mean: 1.5 m/s, std: 0.2 m/s}\n"


def crowd_parts(registry: Registry) -> dict[str, Path]:
    """Return name -> file of every named crowd; those of plugins have the plugin's prefix."""
    return {
        file.stem if plugin == _BUILTIN else f"{plugin}:{file.stem}": file
        for plugin, folders in plugin_folders(registry).items()
        for folder in folders
        for file in sorted((folder / _PLACE).glob("*.yaml"))
    }


def names_crowd(text: str, registry: Registry) -> bool:
    """Return True if a text names a crowd (a part or a policy's kind) rather than a suite."""
    if text in crowd_parts(registry) or text in registry.components("crowd policy"):
        return True
    path = Path(text)
    return path.is_file() and path.suffix in (".yaml", ".yml") and not _is_document(path)


def open_crowd(text: str, registry: Registry, overrides: Sequence[str] = ()) -> Crowd:
    """Return the crowd that a text names, with speeds of recorded people by default.

    Args:
        text: the name of a part, the path of one, or the kind of a crowd policy.
        overrides: ``key=value`` texts; keys as in a scenario, ``crowd.`` is optional.

    Raises:
        UnknownNameError: there is no crowd with this name.
        SpecError: the part or an override is invalid.
    """
    parts, path = crowd_parts(registry), Path(text)
    known = sorted({*parts, *registry.components("crowd policy")})
    if text in parts:
        plugin, _, stem = text.rpartition(":")
        return _opened(f"{plugin or _BUILTIN}:{_PLACE}/{stem}.yaml", None, registry, overrides)
    if path.suffix in (".yaml", ".yml") or "/" in text:
        if not path.is_file():
            raise InputError(f"{text}: no such file")
        try:
            return _opened(f"{_GIVEN}:{path.name}", path.resolve().parent, registry, overrides)
        except SpecError as error:
            raise SpecError([_as_given(d, text) for d in error.diagnostics]) from None
    if text in registry.components("crowd policy"):
        return _opened("", None, registry, overrides, policy=text)
    raise UnknownNameError("crowd", text, known)


def _opened(
    extends: str,
    folder: Path | None,
    registry: Registry,
    overrides: Sequence[str],
    policy: str = "",
) -> Crowd:
    roots = dict(plugin_folders(registry))
    if folder is not None:
        roots[_GIVEN] = [folder]
    text = _DOCUMENT.format(
        extends=", ".join(['"usual.yaml"'] + [f'"{extends}"'] * bool(extends)),
        policy=f"\n    policy: {{kind: {policy}}}" if policy else "",
    )
    with tempfile.TemporaryDirectory(prefix="crowdbot-crowd-") as made:
        path = Path(made) / "crowd.yaml"
        path.write_text(text, encoding="utf-8")
        path.with_name("usual.yaml").write_text(_USUAL, encoding="utf-8")
        document = load_document(path, roots, name="crowd", installed=installed(registry))
        changes = [(o if o.startswith("crowd.") else f"crowd.{o}") for o in overrides]
        found = expand_document(document, registry.scenario_model, changes)
    crowd = found.scenarios[0].crowd
    if crowd is None:
        raise InputError(f"{extends or policy}: it has no crowd")
    return crowd


def _as_given(diagnostic: Diagnostic, text: str) -> Diagnostic:
    """Return an error with the user's own name of the file."""
    mark = diagnostic.mark
    if mark is None or not mark.source.name.startswith(f"{_GIVEN}:"):
        return diagnostic
    return replace(diagnostic, mark=replace(mark, source=replace(mark.source, name=text)))


def _is_document(path: Path) -> bool:
    """Return True if a file is a suite or a scenario: parts have no ``crowdbot: 1``."""
    text = input_bytes(path).decode(errors="replace")
    return any(line.startswith("crowdbot:") for line in text.splitlines())
