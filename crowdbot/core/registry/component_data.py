"""Files that the specs of components declare as data, such as the weights of a network."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from crowdbot.core.support.source_digest import data_files, declared_data, digest_of_files
from crowdbot.dsl.spec.component import Component


def files_of_data(component: Component[Any]) -> dict[str, Path]:
    """Return the files that a component's spec declares in ``data``, relative to its module.

    Raises:
        InputError: a name matches no file.
    """
    patterns = declared_data(component.spec)
    if not patterns:
        return {}
    files = data_files(Path(inspect.getfile(component.spec)).parent, patterns)
    return {f"{component.kind}/{name}": file for name, file in files.items()}


def data_digest(components: Sequence[Component[Any]]) -> str:
    """Return the SHA-256 of the files that components declare as data; empty without any."""
    found: dict[str, Path] = {}
    for component in components:
        found |= files_of_data(component)
    return digest_of_files(found) if found else ""
