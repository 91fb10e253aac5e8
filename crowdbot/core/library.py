"""Opening suites by path or packaged name, and picking scenarios by id, prefix or pattern."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from fnmatch import fnmatchcase
from importlib.resources.abc import Traversable
from pathlib import Path

from crowdbot.core.registry import Registry
from crowdbot.dsl.expand import Expansion, expand_document, load_document
from crowdbot.dsl.scenario import Scenario
from crowdbot.errors import InputError, UnknownNameError

_BUILTIN = "builtin"


def open_spec(spec: str, registry: Registry, overrides: Sequence[str] = ()) -> Expansion:
    """Read, expand and validate a suite or scenario.

    Args:
        spec: a path, or the name of a packaged suite (``challenge-2020``, ``acme:office``).
        registry: the installed components.
        overrides: ``key=value`` texts, laid over every scenario.

    Raises:
        SpecError: the document is wrong; every error at once.
        UnknownNameError: neither a file nor a packaged suite has this name.
    """
    with _folders(registry) as roots:
        path, name = _find(spec, roots)
        suite = load_document(path, roots, name=name, metrics=registry.components("metric"))
        return expand_document(suite, registry.scenario_model, overrides)


def suite_names(registry: Registry) -> list[str]:
    """Names of all packaged suites."""
    with _folders(registry) as roots:
        return sorted(_packaged(roots))


def pick(expansion: Expansion, wanted: str | None) -> Scenario:
    """The one scenario that an id means.

    Args:
        expansion: from `open_spec`.
        wanted: an id, a unique prefix or pattern of one, with or without ``suite-id/`` in front;
            None means the only scenario.

    Raises:
        UnknownNameError: no scenario has such an id.
        InputError: several have.
    """
    if wanted is None:
        return _only(expansion, expansion.scenarios, "no id was given")
    found = select(expansion, wanted)
    exact = [s for s in found if s.id == _bare(expansion, wanted)]
    if not found:
        prefix = f"{expansion.suite_id}/" if "/" in wanted else ""
        raise UnknownNameError("scenario", wanted, [prefix + s.id for s in expansion.scenarios])
    return _only(expansion, exact or found, f"'{wanted}' fits more than one")


def select(expansion: Expansion, wanted: str) -> list[Scenario]:
    """All scenarios whose id fits: equal, beginning with ``wanted``, or matching it as a glob.

    A ``+`` suffix that ``--set`` gave to the ids need not be written.
    """
    bare = _bare(expansion, wanted)
    ids = [s for s in expansion.scenarios if bare in (s.id, s.id.partition("+")[0])]
    return ids or [
        s for s in expansion.scenarios if s.id.startswith(bare) or fnmatchcase(s.id, bare)
    ]


def _bare(expansion: Expansion, wanted: str) -> str:
    return wanted.removeprefix(f"{expansion.suite_id}/")


def _only(expansion: Expansion, found: Sequence[Scenario], why: str) -> Scenario:
    if len(found) == 1:
        return found[0]
    some = ", ".join(s.id for s in found[:3]) + (", …" if len(found) > 3 else "")
    raise InputError(
        f"{why}: {len(found)} scenarios of {expansion.suite_id} match ({some}); "
        "give one id, e.g. from 'crowdbot expand'"
    )


def _find(spec: str, roots: dict[str, list[Path]]) -> tuple[Path, str]:
    """The file that a SPEC means, and what messages call it."""
    path, packaged = Path(spec), _packaged(roots)
    looks_like_path = path.suffix in (".yaml", ".yml") or os.sep in spec or "/" in spec
    if not looks_like_path and spec in packaged:
        return packaged[spec], _shown(packaged[spec])
    if looks_like_path or os.path.lexists(spec):
        return path, spec
    raise UnknownNameError("suite", spec, packaged)


def _packaged(roots: dict[str, list[Path]]) -> dict[str, Path]:
    """Name -> file of every packaged suite; crowdbot's own have no prefix."""
    return {
        file.stem if plugin == _BUILTIN else f"{plugin}:{file.stem}": file
        for plugin, folders in roots.items()
        for folder in folders
        for file in sorted(folder.glob("*.yaml"))
    }


@contextmanager
def _folders(registry: Registry) -> Iterator[dict[str, list[Path]]]:
    """Plugin name -> its scenario folders as real ones; those inside archives are unpacked."""
    with ExitStack() as stack:
        roots: dict[str, list[Path]] = {}
        for plugin in registry.plugins:
            folders = [f for f in plugin.scenario_dirs if f.is_dir()]
            if folders:
                roots[plugin.name] = [_real(folder, stack) for folder in folders]
        yield roots


def _real(folder: Traversable, stack: ExitStack) -> Path:
    if isinstance(folder, Path):
        return folder
    target = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="crowdbot-")))
    _unpack(folder, target)
    return target


def _unpack(folder: Traversable, target: Path) -> None:
    for item in folder.iterdir():
        if item.is_dir():
            (target / item.name).mkdir()
            _unpack(item, target / item.name)
        else:
            (target / item.name).write_bytes(item.read_bytes())


def _shown(path: Path) -> str:
    """A path for messages: relative if it is below the working directory."""
    if path.is_absolute() and path.is_relative_to(Path.cwd()):
        return str(path.relative_to(Path.cwd()))
    return str(path)
