"""Matrix: named axes -> ordered, named combinations; the first axis varies slowest."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from crowdbot.dsl.text.diagnostics import Diagnostic, Mark, Source
from crowdbot.dsl.text.merge import kind_of, merge
from crowdbot.dsl.text.nodes import Node

MAX_COMBINATIONS = 10_000
MAX_AXES = 64

#: Name of the last axis, added by ``draws: N``.
DRAW = "draw"

_NAME = re.compile(r"[A-Za-z0-9_]+")
_Path = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Axis:
    """A named axis: label -> override, and label -> source position."""

    name: str
    labels: dict[str, Node]
    keys: dict[str, Mark] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Combination:
    """One label per axis, and the base merged with their overrides."""

    labels: tuple[str, ...]
    tree: Node


def read_axes(
    matrix: Node | None, problems: list[Diagnostic], draws: Node | None = None
) -> tuple[Axis, ...]:
    """Return the axes as written, with dotted keys resolved; errors are added to ``problems``.

    Args:
        matrix: the map of axes.
        problems: errors so far.
        draws: number of crowds per condition; more than one adds the axis `DRAW`.
    """
    if matrix is not None and matrix.value is not None and not isinstance(matrix.value, dict):
        problems.append(Diagnostic("E111", "matrix wants a map of axes", matrix.mark))
        return ()
    listed = matrix.entries if matrix else {}
    axes = [_read_axis(name, entry.key, entry.node, problems) for name, entry in listed.items()]
    _check_overlap(axes, problems)
    if draws is not None and isinstance(draws.value, int) and draws.value > 1:
        if DRAW in listed:
            text = f"axis '{DRAW}' is the one that 'draws' adds; rename it"
            problems.append(Diagnostic("E010", text, listed[DRAW].key))
            return tuple(axes)
        if draws.value <= MAX_COMBINATIONS:
            axes.append(_draw_axis(draws.value, draws.mark))
    if _too_many(axes, problems, (matrix or draws or Node(Mark(Source("")), {})).mark):
        return ()
    return tuple(axes)


def _draw_axis(count: int, mark: Mark) -> Axis:
    """Return labels n01, n02, …; a larger count keeps the labels of a smaller one."""
    nothing = Node(mark, {}, implied=True)
    return Axis(DRAW, {f"n{number:02d}": nothing for number in range(1, count + 1)})


def _too_many(axes: Sequence[Axis], problems: list[Diagnostic], mark: Mark) -> bool:
    count = math.prod(len(axis.labels) for axis in axes)
    if count <= MAX_COMBINATIONS and len(axes) <= MAX_AXES:
        return False
    size = f"{count} combinations" if count > MAX_COMBINATIONS else f"{len(axes)} axes"
    most = MAX_COMBINATIONS if count > MAX_COMBINATIONS else MAX_AXES
    text = f"the suite has {size}; at most {most} are allowed"
    problems.append(Diagnostic("E207", text, mark))
    return True


def combinations(base: Node, axes: Sequence[Axis]) -> Iterator[Combination]:
    """Yield all combinations; those whose leading labels are equal share merged trees."""
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
        problems.append(Diagnostic("E209", text, node.mark, "{label: {some.field: value}}"))
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
    return Axis(name, labels, {label: entry.key for label, entry in node.entries.items()})


def _check_name(category: str, name: str, key: Mark, problems: list[Diagnostic]) -> None:
    """Refuse labels that contain '-', which joins labels to ids."""
    if not _NAME.fullmatch(name):
        text = f"{category} '{name}' may have letters, digits and '_' only"
        problems.append(Diagnostic("E010", text, key))


def _check_overlap(axes: Sequence[Axis], problems: list[Diagnostic]) -> None:
    """Refuse axes that write the same field, since their order would decide."""
    leaves: dict[_Path, tuple[str, Mark]] = {}
    above: dict[_Path, tuple[str, Mark]] = {}  # paths with a written field below them
    for axis in axes:
        written, reported = _written(axis), set[str]()
        for path, mark in written.items():
            found = [leaves[path[:n]] for n in range(len(path) + 1) if path[:n] in leaves]
            for name, place in [*found, *([above[path]] if path in above else [])]:
                if name not in reported:
                    reported.add(name)
                    text = f"axes '{name}' and '{axis.name}' both write {'.'.join(path)}"
                    also = (("also written at", place),)
                    hint = "make them one axis"
                    problems.append(Diagnostic("E205", text, mark, hint, also))
        for path, mark in written.items():
            leaves.setdefault(path, (axis.name, mark))
            for n in range(len(path)):
                above.setdefault(path[:n], (axis.name, mark))


def _written(axis: Axis) -> dict[_Path, Mark]:
    found: dict[_Path, Mark] = {}
    for node in axis.labels.values():
        for key, entry in node.entries.items():
            for path, mark in _leaves((key,), entry.node, entry.key):
                found.setdefault(path, mark)
    return found


def _leaves(path: _Path, node: Node, key: Mark) -> Iterator[tuple[_Path, Mark]]:
    """Yield path and key position of the fields that an override writes.

    A map with a ``kind`` may replace everything below it.
    """
    if not node.entries or kind_of(node) is not None:
        yield path, key
        return
    for name, entry in node.entries.items():
        yield from _leaves((*path, name), entry.node, entry.key)
