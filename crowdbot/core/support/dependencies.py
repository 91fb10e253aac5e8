"""The installed packages that crowdbot needs, with their licences."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import metadata

from packaging.markers import default_environment
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

_PREFIX = "License :: "
#: Longest licence that is a name rather than a text.
_LONGEST = 80


@dataclass(frozen=True, slots=True)
class Dependency:
    """An installed package: version, licence and the packages it needs.

    Attributes:
        licence: SPDX expression or name; empty if the package does not say.
        needs: names of the installed packages that it needs.
        extra: True if only an extra of crowdbot needs it.
    """

    name: str
    version: str
    licence: str
    needs: tuple[str, ...]
    extra: bool


def dependencies(root: str = "crowdbot") -> list[Dependency]:
    """Return the installed packages that a package needs at any depth, by name.

    Packages of extras are included where they are installed.

    Raises:
        PackageNotFoundError: the package itself is not installed.
    """
    metadata.distribution(root)
    extras = frozenset(metadata.distribution(root).metadata.get_all("Provides-Extra") or ())
    needed = _reached(root, frozenset())
    every = needed | _reached(root, extras)
    return [_dependency(name, extra=name not in needed) for name in sorted(every)]


def _reached(root: str, extras: frozenset[str]) -> set[str]:
    """Return the names of all installed packages that a package needs with some extras."""
    waiting, found = [(root, extras)], set[str]()
    done = set[tuple[str, frozenset[str]]]()
    while waiting:
        name, requested = waiting.pop()
        if (name, requested) in done:
            continue
        done.add((name, requested))
        for requirement in _requirements(name, requested):
            other = canonicalize_name(requirement.name)
            if _is_installed(other):
                found.add(other)
                waiting.append((other, frozenset(requirement.extras)))
    return found - {canonicalize_name(root)}


def _requirements(name: str, extras: frozenset[str]) -> Iterator[Requirement]:
    environment = {k: str(v) for k, v in default_environment().items()}
    for text in metadata.distribution(name).requires or ():
        requirement = Requirement(text)
        marker = requirement.marker
        if marker is None or any(
            marker.evaluate({**environment, "extra": extra}) for extra in ("", *extras)
        ):
            yield requirement


def _is_installed(name: str) -> bool:
    try:
        metadata.distribution(name)
    except metadata.PackageNotFoundError:
        return False
    return True


def _dependency(name: str, *, extra: bool) -> Dependency:
    found = metadata.distribution(name)
    needs = {canonicalize_name(r.name) for r in _requirements(name, frozenset())}
    return Dependency(
        name=name,
        version=found.version,
        licence=_licence(found.metadata),
        needs=tuple(sorted(n for n in needs if _is_installed(n))),
        extra=extra,
    )


def _licence(about: metadata.PackageMetadata) -> str:
    """Return the licence by the expression, the classifiers, or the first line of the field."""
    if expression := about["License-Expression"]:
        return str(expression)
    classifiers = [c for c in about.get_all("Classifier") or () if c.startswith(_PREFIX)]
    names = [c.rpartition(" :: ")[2] for c in classifiers]
    if names := [n for n in names if n != "OSI Approved"]:
        return ", ".join(names)
    first = str(about["License"] or "").strip().partition("\n")[0]
    return re.sub(r"\s+", " ", first)[:_LONGEST]
