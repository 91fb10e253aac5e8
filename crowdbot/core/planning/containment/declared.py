"""Files and access that planners declare: files beside them, data, libraries of their own."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from crowdbot.core.planning.containment.libraries import environment_of
from crowdbot.core.planning.containment.offer import Needs
from crowdbot.core.registry.component_data import files_of_data
from crowdbot.core.registry.registry import Registry
from crowdbot.core.support.source_digest import data_files, parsed_source, source_files
from crowdbot.dsl.spec.component import Component
from crowdbot.errors import InputError


def needs_of_class(path: Path, name: str) -> Needs:
    """Return the needs of a class in a file: the file, modules beside it, data written as text.

    Data that the class computes is known only after it is imported: `with_data`.
    """
    needs = needs_of_files(source_files(path))
    try:
        return with_data(needs, path.parent, _written_data(path, name))
    except InputError:  # reported with the digest of the files
        return needs


def needs_of_kind(
    component: Component[Any], registry: Registry, read: Iterable[Path] = ()
) -> Needs:
    """Return the needs of a planner of a plugin: its data, and plugins that are not installed.

    Args:
        read: files that its parameters name.
    """
    given = registry.source.extra if registry.source is not None else ()
    folders = {str(p if p.is_dir() else p.parent) for p in given}
    files = {str(f) for p in given for f in ([p] if p.is_dir() else source_files(p))}
    module = Path(inspect.getfile(component.spec))
    files |= {str(f.resolve()) for f in (*files_of_data(component).values(), *read)}
    package = [str(p) for p in (module, *module.parents) if (p / "__init__.py").is_file()]
    return Needs(files=sorted({*files, *package}), folders=sorted(folders | {str(module.parent)}))


def needs_of_program(
    program: Path, files: Iterable[Path], libraries: Sequence[Path], *, network: bool
) -> Needs:
    """Return the needs of another program.

    Args:
        program: its file; of one in a Python or conda environment, all of that is readable.
        files: files that are part of it.
        libraries: folders that it may read, which are not part of its hash.
        network: True if its document asks for the network.
    """
    own = needs_of_files([program, *files])
    chosen = [str(p) for p in libraries]
    more = [*environment_of(program), *chosen]
    return Needs(files=[*own.files, *more], folders=own.folders, network=network, chosen=chosen)


def needs_of_files(files: Iterable[Path]) -> Needs:
    """Return the needs of a planner that consists of some files: these, and names beside them."""
    both = [p for file in files for p in (file.absolute(), file.resolve())]
    return Needs(
        files=sorted({str(p) for p in both}), folders=sorted({str(p.parent) for p in both})
    )


def with_data(needs: Needs, folder: Path, patterns: Iterable[str]) -> Needs:
    """Return a planner's needs with its declared data files added.

    Args:
        folder: folder that the names and patterns are relative to.

    Raises:
        InputError: a name matches no file.
    """
    more = needs_of_files(data_files(folder, patterns).values())
    return Needs(
        files=sorted({*needs.files, *more.files}),
        folders=sorted({*needs.folders, *more.folders}),
        network=needs.network,
        chosen=[*needs.chosen, *more.files],
    )


def _written_data(path: Path, name: str) -> tuple[str, ...]:
    """Return the attribute ``data`` of a class in a file, if it is a literal; else nothing."""
    tree = parsed_source(path)
    if tree is None:
        return ()
    for kind in (n for n in tree.body if isinstance(n, ast.ClassDef) and n.name == name):
        for node in kind.body:
            targets = node.targets if isinstance(node, ast.Assign) else ()
            if any(isinstance(t, ast.Name) and t.id == "data" for t in targets):
                assert isinstance(node, ast.Assign)
                return _texts(node.value)
    return ()


def _texts(node: ast.expr) -> tuple[str, ...]:
    try:
        value = ast.literal_eval(node)
    except (ValueError, TypeError, SyntaxError, MemoryError, RecursionError):
        return ()
    found = (value,) if isinstance(value, str) else value
    is_texts = isinstance(found, tuple | list) and all(isinstance(x, str) for x in found)
    return tuple(found) if is_texts else ()
