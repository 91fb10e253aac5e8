"""Selection: ``only`` and ``exclude`` keep some combinations of a matrix, with the same ids.

::

    only: {density: d0125, speed: [slow, fast]}     # all of one map's axes must fit
    exclude: [{flow: in}, {flow: counter, density: d0500}]   # any of the maps
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence

from crowdbot.dsl.suite.matrix import Axis
from crowdbot.dsl.text.diagnostics import Diagnostic
from crowdbot.dsl.text.nodes import Node
from crowdbot.errors import did_you_mean, nearest

_WANTED = "wants a map of axes with labels, or a list of such maps"

MAX_CHOICES = 500

#: Axis -> its labels; a combination matches if it has one of them on every named axis.
_Choice = Mapping[str, frozenset[str]]


Kept = frozenset[tuple[str, ...]]


def read_selection(root: Node, axes: Sequence[Axis], problems: list[Diagnostic]) -> Kept | None:
    """Return the label combinations that a suite keeps, in the axes' order; None for all.

    Args:
        root: the outermost map of the suite.
        axes: axes of the matrix.
        problems: errors are added.
    """
    known, before = {axis.name: axis for axis in axes}, len(problems)
    only = _choices(root, "only", known, problems)
    exclude = _choices(root, "exclude", known, problems)
    if len(problems) > before or (only is None and exclude is None):
        return None
    kept = frozenset(_kept(axes, only, exclude or ()))
    if not kept and all(axis.labels for axis in axes):
        text, key = "'only' and 'exclude' leave no scenario", "exclude" if exclude else "only"
        problems.append(Diagnostic("E211", text, root.entries[key].key))
    return kept


def _kept(
    axes: Sequence[Axis], only: Sequence[_Choice] | None, exclude: Sequence[_Choice]
) -> Iterator[tuple[str, ...]]:
    names = [axis.name for axis in axes]
    for product in itertools.product(*(axis.labels for axis in axes)):
        labels = dict(zip(names, product, strict=True))
        selected = only is None or any(_fits(choice, labels) for choice in only)
        if selected and not any(_fits(choice, labels) for choice in exclude):
            yield product


def _fits(choice: _Choice, labels: Mapping[str, str]) -> bool:
    return all(labels.get(axis) in label for axis, label in choice.items())


def _choices(
    root: Node, name: str, axes: Mapping[str, Axis], problems: list[Diagnostic]
) -> tuple[_Choice, ...] | None:
    node = root.child(name)
    if node is None or node.value is None:
        return None
    items = node.value if isinstance(node.value, tuple) else (node,)
    if len(items) > MAX_CHOICES:
        text = f"{name} has {len(items)} entries; at most {MAX_CHOICES} are allowed"
        problems.append(Diagnostic("E207", text, node.mark))
        return None
    choices = []
    for item in items:
        if isinstance(item.value, dict):
            choices.append({a: _labels(a, item, axes, problems) for a in item.entries})
        else:
            problems.append(Diagnostic("E111", f"{name} {_WANTED}", item.mark))
        if isinstance(item.value, dict) and not item.value:
            hint = f"remove '{name}' to select everything"
            problems.append(Diagnostic("E211", f"an empty map in {name}", item.mark, hint))
    if not items:
        problems.append(
            Diagnostic("E211", f"{name} has no entries", node.mark, f"{name} {_WANTED}")
        )
    return tuple(choices)


def _labels(
    axis: str, choice: Node, axes: Mapping[str, Axis], problems: list[Diagnostic]
) -> frozenset[str]:
    entry = choice.entries[axis]
    if axis not in axes:
        hint = did_you_mean(nearest(axis, axes)).removeprefix("; ") or f"axes: {', '.join(axes)}"
        text = f"the matrix has no axis '{axis}'"
        problems.append(Diagnostic("E208", text, entry.key, hint if axes else ""))
        return frozenset()
    if entry.node.value == ():
        problems.append(Diagnostic("E211", f"no label of axis '{axis}'", entry.node.mark))
    return frozenset(_known_labels(entry.node, axes[axis], problems))


def _known_labels(node: Node, axis: Axis, problems: list[Diagnostic]) -> Iterator[str]:
    for item in node.value if isinstance(node.value, tuple) else (node,):
        value = item.value
        if isinstance(value, bool) or not isinstance(value, str | int):
            text = f"axis '{axis.name}' wants a label or a list of labels"
            problems.append(Diagnostic("E111", text, item.mark, "quote it if it is a label"))
        elif str(value) in axis.labels:
            yield str(value)
        else:
            near = did_you_mean(nearest(str(value), axis.labels)).removeprefix("; ")
            hint = near or f"labels: {', '.join(list(axis.labels)[:12])}"
            text = f"axis '{axis.name}' has no label '{value}'"
            problems.append(Diagnostic("E210", text, item.mark, hint))
