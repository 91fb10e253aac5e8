"""Merge layers of a document into one tree; each field keeps its own position.

Three rules besides "maps are merged, everything else is replaced": a map with another ``kind``
replaces the old map, ``null`` over something removes it, and ``{}`` over a map empties it.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

from crowdbot.dsl.text.diagnostics import Diagnostic, Mark
from crowdbot.dsl.text.nodes import MAX_DEPTH, Entry, Node

#: Pairs of trees, by their ids, with their merge result; keeps them alive.
Merged = dict[tuple[int, int], tuple[Node, Node, Node]]


def merge(base: Node, over: Node, known: Merged | None = None) -> Node:
    """Merge one tree over another. Both stay unchanged; untouched parts are shared.

    Args:
        base, over: trees.
        known: earlier merges: equal pairs, also below, give the same node, so that each node is
            validated once.
    """
    if known is None:
        return _merge(base, over, None)
    pair = id(base), id(over)
    if pair not in known:
        known[pair] = base, over, _merge(base, over, known)
    return known[pair][2]


def _merge(base: Node, over: Node, known: Merged | None) -> Node:
    if over.implied and not over.entries:  # not written, so it empties nothing
        return base
    if not (base.entries and over.entries) or _changes_kind(base, over):
        return over
    entries, removed = dict(base.entries), {**base.removed, **over.removed}
    for key, entry in over.entries.items():
        old = entries.get(key)
        if old is None:
            entries[key] = entry
        elif entry.node.value is None:
            del entries[key]
            removed[key] = entry.node.mark
        else:
            winner = old if entry.node.implied else entry
            entries[key] = replace(winner, node=merge(old.node, entry.node, known))
    place = base if over.implied else over
    return Node(place.mark, entries, base.implied and over.implied, removed)


def kind_of(node: Node) -> object:
    """Return the ``kind`` of a map, or None."""
    kind = node.child("kind")
    return kind.value if kind else None


def undot(
    node: Node, problems: list[Diagnostic], depth: int = 0, verbatim: Collection[str] = ()
) -> Node:
    """Convert ``a.b: x`` to ``a: {b: x}`` everywhere below a node.

    Args:
        node: the tree as read.
        problems: keys that clash with others of the same map are added here.
        depth: levels above the node.
        verbatim: keys of the node whose maps have names with dots.
    """
    if isinstance(node.value, tuple):
        return replace(node, value=tuple(undot(item, problems, depth + 1) for item in node.value))
    if not node.entries:
        return node
    out: dict[str, Entry] = {}
    for key, entry in node.entries.items():
        parts = key.split(".")
        if not all(parts):
            problems.append(Diagnostic("E010", f"empty name in key '{key}'", entry.key))
            continue
        below = depth + len(parts)
        if below > MAX_DEPTH:
            text = f"key nested deeper than {MAX_DEPTH} levels"
            problems.append(Diagnostic("E009", text, entry.key))
            continue
        inner = entry.node if key in verbatim else undot(entry.node, problems, below)
        _join(out, parts[0], _nest(parts, replace(entry, node=inner)), problems)
    return replace(node, value=out)


def nest(path: Sequence[str], node: Node, mark: Mark) -> Node:
    """Return a tree with only ``node``, under a path; ``mark`` is the position of all keys."""
    for key in reversed(path):
        node = Node(mark, {key: Entry(mark, node)}, implied=True)
    return node


def _changes_kind(base: Node, over: Node) -> bool:
    old, new = kind_of(base), kind_of(over)
    return old is not None and new is not None and old != new


def _nest(parts: list[str], entry: Entry) -> Entry:
    """Return nested maps for the parts of a dotted key, each with the position of its part."""
    if len(parts) == 1:
        return entry
    dotted, node = ".".join(parts), entry.node
    marks = _part_marks(parts, dotted, entry.key)
    for part, mark in zip(parts[:0:-1], marks[:0:-1], strict=True):
        node = Node(mark, {part: Entry(mark, node, dotted)}, implied=True)
    return Entry(marks[0], node, dotted)


def _part_marks(parts: list[str], dotted: str, mark: Mark) -> list[Mark]:
    quotes = (mark.width - len(dotted)) // 2
    if mark.width - len(dotted) not in (0, 2):  # escapes or several lines: columns are unknown
        return [mark] * len(parts)
    marks, column = [], mark.column + quotes
    for part in parts:
        marks.append(replace(mark, column=column, width=len(part)))
        column += len(part) + 1
    return marks


def _join(out: dict[str, Entry], key: str, entry: Entry, problems: list[Diagnostic]) -> None:
    """Add an entry to a map; writing one field twice in the same map is an error.

    `undot` created every map, so they can be changed in place.
    """
    old = out.get(key)
    if old is None:
        out[key] = entry
    elif old.node.entries and entry.node.entries:
        swap = old.node.implied and not entry.node.implied
        plain, other = (entry, old) if swap else (old, entry)
        for name, child in other.node.entries.items():
            _join(plain.node.entries, name, child, problems)
        out[key] = plain
    else:
        also = (("first written at", old.key),)
        problems.append(Diagnostic("E003", f"duplicate key '{key}'", entry.key, also=also))
