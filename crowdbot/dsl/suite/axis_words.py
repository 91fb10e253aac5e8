"""Readable names for a suite's axes: ``c20`` of ``coeff`` is "20" of "ttca_dca weight"."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import takewhile
from typing import NamedTuple

from crowdbot.dsl.suite.matrix import Axis
from crowdbot.dsl.text.merge import kind_of
from crowdbot.dsl.text.nodes import Node

#: Longer values are replaced by the label's title, or by the label.
LONGEST = 80
#: Fields for people, not for the simulator.
_FOR_PEOPLE = ("title", "description")
#: Maps of named parts; each part is called by its kind.
_SEVERAL = frozenset(("costs", "sensors"))
#: Parts of a path that carry no information for readers.
_SILENT = frozenset(("crowd", "robots", "task"))

_Path = tuple[str, ...]


class AxisWords(NamedTuple):
    """One label: the quantity that its axis varies, and the label's value."""

    title: str
    value: str


def axis_words(
    base: Node, axes: Sequence[Axis], changed: Node | None = None
) -> dict[str, dict[str, AxisWords]]:
    """Return axis -> label -> readable names.

    The title is the field that all labels of the axis write, or the innermost map around all fields
    that they write; a cost function or sensor is called by its kind. The value is the document's,
    with its unit; if long, the label's title.

    Args:
        base: base of the suite, with the kind of each part.
        axes: axes of its matrix.
        changed: overrides of all scenarios (``--set``); axes that they change get no names.
    """
    return {
        axis.name: _of(base, axis)
        for axis in axes
        if changed is None or not any(_reaches(changed, path) for path in _paths(axis))
    }


def _paths(axis: Axis) -> set[_Path]:
    return {path for node in axis.labels.values() for path, _ in _leaves((), node)}


def _reaches(changed: Node, path: _Path) -> bool:
    """Return True if a change writes a field, or something around or below it."""
    node: Node | None = changed
    for name in path:
        if node is None or not node.entries:
            break
        node = node.child(name)
    return node is not None and node is not changed


def _of(base: Node, axis: Axis) -> dict[str, AxisWords]:
    written = {label: dict(_leaves((), node)) for label, node in axis.labels.items()}
    paths = sorted({path for fields in written.values() for path in fields})
    common = _common(paths)
    title = _title(base, common)
    if len({path[-1] for path in paths}) == 1 and all(map(_agree, written.values())):
        # several parts get the same value of the same field: one is enough
        written = {label: dict(list(fields.items())[:1]) for label, fields in written.items()}
        last = paths[0][-1]
        title = title if common[-1:] == (last,) else f"{title} {last.replace('_', ' ')}".strip()
        common = paths[0]
    return {
        label: AxisWords(
            title or axis.name.replace("_", " "),
            _value(axis.labels[label], fields, len(common)) or label,
        )
        for label, fields in written.items()
    }


def _agree(fields: dict[_Path, Node]) -> bool:
    return len({_text(node) for node in fields.values()}) <= 1


def _leaves(path: _Path, node: Node) -> Iterator[tuple[_Path, Node]]:
    """Yield path and value of fields that a label writes; not ``title`` and ``description``."""
    if not node.entries:
        if path and path[-1] not in _FOR_PEOPLE:
            yield path, node
        return
    for name, entry in node.entries.items():
        yield from _leaves((*path, name), entry.node)


def _common(paths: Sequence[_Path]) -> _Path:
    if not paths:
        return ()
    columns = zip(*paths, strict=False)
    return tuple(c[0] for c in takewhile(lambda column: len(set(column)) == 1, columns))


def _title(base: Node, path: _Path) -> str:
    """Return the last two names of a path in words; parts such as sensors go by their kind."""
    words, node, above = list[str](), base, ""
    for name in path:
        below = node.child(name)
        node = Node(base.mark, {}) if below is None else below
        kind = kind_of(node) if above in _SEVERAL else None
        if name not in _SILENT:
            words.append(name.replace("_", " ") if kind is None else str(kind))
        above = name
    return " ".join(words[-2:])


def _value(label: Node, fields: dict[_Path, Node], depth: int) -> str:
    """Return the value of a label's field, or each field with name and value; else its title."""
    texts = {path: _text(node) for path, node in fields.items()}
    parts = [
        f"{' '.join(path[depth:]).replace('_', ' ')} {text}".strip() for path, text in texts.items()
    ]
    text = ", ".join(parts)
    if len(text) <= LONGEST and "" not in texts.values():
        return text
    title = label.child("title")
    return str(title.value) if title is not None and isinstance(title.value, str) else ""


def _text(node: Node) -> str:
    """Return a value as written; empty if it has named parts."""
    if isinstance(node.value, tuple):
        texts = [_text(item) for item in node.value]
        return ", ".join(texts) if all(texts) else ""
    if isinstance(node.value, dict):
        return ""
    if isinstance(node.value, bool):
        return "yes" if node.value else "no"
    text = "none" if node.value is None else str(node.value).replace("_", " ")
    return text.replace("^2", "²").replace("^3", "³")
