"""Named axes -> ordered, named combinations; the first axis is the slowest."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from crowdbot.dsl.diagnostics import Diagnostic, Mark
from crowdbot.dsl.merge import kind_of, merge
from crowdbot.dsl.nodes import Node

MAX_COMBINATIONS = 10_000

_NAME = re.compile(r"[A-Za-z0-9_]+")
_Path = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Axis:
    """A named axis: label -> what it overrides."""

    name: str
    labels: dict[str, Node]


@dataclass(frozen=True, slots=True)
class Combination:
    """One label of each axis, and the base with their overrides laid over it."""

    labels: tuple[str, ...]
    tree: Node


def read_axes(matrix: Node | None, problems: list[Diagnostic]) -> tuple[Axis, ...]:
    """Axes as they are written, dotted keys written out; errors are added to ``problems``."""
    if matrix is None or matrix.value is None:
        return ()
    if not isinstance(matrix.value, dict):
        problems.append(Diagnostic("E111", "matrix wants a map of axes", matrix.mark))
        return ()
    axes = [
        _read_axis(name, entry.key, entry.node, problems) for name, entry in matrix.entries.items()
    ]
    _check_overlap(axes, problems)
    count = math.prod(len(axis.labels) for axis in axes)
    if count > MAX_COMBINATIONS:
        text = f"the matrix has {count} combinations; at most {MAX_COMBINATIONS} are allowed"
        problems.append(Diagnostic("E207", text, matrix.mark))
        return ()
    return tuple(axes)


def combinations(base: Node, axes: Sequence[Axis]) -> Iterator[Combination]:
    """All combinations; those with equal first labels share the merged trees of these."""
    if not axes:
        yield Combination((), base)
        return
    for before in combinations(base, axes[:-1]):
        for label, over in axes[-1].labels.items():
            yield Combination((*before.labels, label), merge(before.tree, over))


def _read_axis(name: str, key: Mark, node: Node, problems: list[Diagnostic]) -> Axis:
    _check_name("axis", name, key, problems)
    if not node.entries:
        text = f"axis '{name}' wants a map of labels with overrides"
        problems.append(Diagnostic("E209", text, node.mark))
    labels = {}
    for label, entry in node.entries.items():
        _check_name("label", label, entry.key, problems)
        if not isinstance(entry.node.value, dict):
            text = f"label '{label}' wants a map of overrides"
            problems.append(Diagnostic("E111", text, entry.node.mark, "write {} for none"))
        elif not entry.node.entries:
            labels[label] = Node(entry.node.mark, {}, implied=True)
        else:
            labels[label] = entry.node
    return Axis(name, labels)


def _check_name(what: str, name: str, key: Mark, problems: list[Diagnostic]) -> None:
    """Ids are labels joined by '-', so that a label may not hold one."""
    if not _NAME.fullmatch(name):
        text = f"{what} '{name}' may have letters, digits and '_' only"
        problems.append(Diagnostic("E010", text, key))


def _check_overlap(axes: Sequence[Axis], problems: list[Diagnostic]) -> None:
    """Order would decide which of two axes wins, so that they may not write the same field."""
    written = [_written(axis) for axis in axes]
    for (i, first), (j, second) in itertools.combinations(enumerate(written), 2):
        clash = next(
            (p for p in second for q in first if p[: len(q)] == q or q[: len(p)] == p), None
        )
        if clash is not None:
            text = f"axes '{axes[i].name}' and '{axes[j].name}' both write {'.'.join(clash)}"
            other = next(q for q in first if clash[: len(q)] == q or q[: len(clash)] == clash)
            also = (("also written at", first[other]),)
            problems.append(Diagnostic("E205", text, second[clash], also=also))


def _written(axis: Axis) -> dict[_Path, Mark]:
    found: dict[_Path, Mark] = {}
    for node in axis.labels.values():
        for key, entry in node.entries.items():
            for path, mark in _leaves((key,), entry.node, entry.key):
                found.setdefault(path, mark)
    return found


def _leaves(path: _Path, node: Node, key: Mark) -> Iterator[tuple[_Path, Mark]]:
    """Fields that an override writes; a map with a ``kind`` may replace everything below it."""
    if not node.entries or kind_of(node) is not None:
        yield path, key
        return
    for name, entry in node.entries.items():
        yield from _leaves((*path, name), entry.node, entry.key)
