"""Convert YAML text to nodes that know their position.

YAML 1.2 core schema with our own small resolver over a parser's events: ``no``, ``on``, ``12:30``
and dates stay text, ``1e-3`` is a number. ruamel's own ``compose`` expands aliases and merges keys;
here such documents are refused instead.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from crowdbot.dsl.text.diagnostics import Diagnostic, Mark, Source
from crowdbot.dsl.text.yaml_events import events_of
from crowdbot.errors import SpecError, hidden_character

MAX_DEPTH = 32

Scalar = str | int | float | bool | None

_INT = re.compile(r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_LEADING_ZERO = re.compile(r"[-+]?0[0-9]")
_NOT_FINITE = re.compile(r"[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)")
_WORDS: dict[str, Scalar] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
}
#: Characters that YAML does not allow, except tab and line feed.
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x84\x86-\x9f\ud800-\udfff\ufffe\uffff]")


@dataclass(frozen=True, slots=True, eq=False)
class Entry:
    """A key and its value. ``dotted`` is the whole key if it was written with dots."""

    key: Mark
    node: Node
    dotted: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Node:
    """A scalar, a list or a map.

    Attributes:
        implied: True for a map that only a dotted key created.
        removed: fields that ``null`` removed from the map, with positions.
    """

    mark: Mark
    value: Scalar | tuple[Node, ...] | dict[str, Entry]
    implied: bool = False
    removed: Mapping[str, Mark] = field(default_factory=dict)

    @property
    def entries(self) -> dict[str, Entry]:
        """Return the entries of a map; empty for anything else."""
        return self.value if isinstance(self.value, dict) else {}

    def child(self, key: str | int) -> Node | None:
        """Return the value under a key or an index, if there is one."""
        if isinstance(self.value, dict):
            entry = self.value.get(str(key))
            return entry.node if entry else None
        if isinstance(self.value, tuple) and isinstance(key, int) and key < len(self.value):
            return self.value[key]
        return None


def to_data(node: Node, memo: dict[Node, Any] | None = None) -> Any:
    """Return plain data, maps sorted by key: the order of keys in a file never matters.

    Args:
        node: root of the tree.
        memo: cache of nodes' data; trees that share nodes then share data.
    """
    memo = {} if memo is None else memo
    if node not in memo:
        if isinstance(node.value, dict):
            items = sorted(node.value.items())
            memo[node] = {key: to_data(entry.node, memo) for key, entry in items}
        elif isinstance(node.value, tuple):
            memo[node] = [to_data(item, memo) for item in node.value]
        else:
            memo[node] = node.value
    return memo[node]


def count(node: Node) -> int:
    """Return the number of values in a tree."""
    items = node.value if isinstance(node.value, tuple) else ()
    return 1 + sum(count(e.node) for e in node.entries.values()) + sum(map(count, items))


def parse(text: str, source: Source, problems: list[Diagnostic], shift: int = 0) -> Node:
    """Parse text into a tree.

    Args:
        text: one YAML document, lines end with a line feed.
        source: source of the marks.
        problems: non-fatal errors are added here.
        shift: columns by which the first line of the text is moved in the source.

    Raises:
        SpecError: the text is not YAML, or cannot be parsed further.
    """
    return _Builder(text, source, problems, shift).document()


def _explained(error: Any, shift: int) -> tuple[str, str]:
    """Return message and hint for a YAML parser's error, whose own text is hard to understand."""
    problem, context, start = error.problem or "", error.context or "", error.context_mark
    if ("flow mapping" in context or "flow sequence" in context) and start is not None:
        bracket = "'{'" if "mapping" in context else "'['"
        column = start.column + 1 + (shift if start.line == 0 else 0)
        where = f"line {start.line + 1}, column {column}"
        return f"{problem or 'something is wrong'} after the {bracket} of {where}", ""
    if "'\\t'" in problem:
        return "a tab, which YAML does not take for indentation", "use blanks"
    if "mapping values are not allowed" in problem:
        text = "a second ':' on this line, or a line that is indented too far"
        return text, "quote text that holds ': '"
    return " ".join(filter(None, (problem, context))), ""


def _kind(event: Any) -> str:
    """Return the type of an event, the same for both parsers."""
    return type(event).__name__


class _Builder:
    """Build nodes from parser events by recursive descent; events are known by class name."""

    def __init__(
        self, text: str, source: Source, problems: list[Diagnostic], shift: int = 0
    ) -> None:
        self._text, self._source, self._problems, self._shift = text, source, problems, shift
        self._events: Iterator[Any] = events_of(text)
        self._last = Mark(source, 0, shift)

    def document(self) -> Node:
        if found := _CONTROL.search(self._text):
            line = self._text.count("\n", 0, found.start())
            column = found.start() - (self._text.rfind("\n", 0, found.start()) + 1)
            text = f"character U+{ord(found[0]):04X} is not allowed"
            self._stop("E002", text, "", line, column)
        self._next()
        start = self._next()
        if _kind(start) == "StreamEndEvent":
            return Node(self._last, None)
        if _kind(start) == "DocumentStartEvent" and (start.version or start.tags):
            self._add("E007", "directives (%YAML, %TAG) are not allowed", self._mark(start))
        root = self._node(self._next(), 0)
        self._next()
        after = self._next()
        if _kind(after) != "StreamEndEvent":
            self._add("E007", "a file holds one document", self._mark(after))
        return root

    def _next(self) -> Any:
        try:
            event = next(self._events)
        except Exception as error:  # ruamel does not catch ValueError and OverflowError of escapes
            if not hasattr(error, "problem_mark"):
                column = self._last.column - self._shift
                self._stop("E002", str(error), "", self._last.line, column)
            marked: Any = error  # a MarkedYAMLError
            mark = marked.problem_mark or marked.context_mark
            line, column = (mark.line, mark.column) if mark else (0, 0)
            self._stop("E002", *_explained(marked, self._shift), line, column)
        self._last = self._mark(event)
        return event

    def _stop(self, code: str, message: str, hint: str, line: int, column: int) -> None:
        mark = Mark(self._source, line, column + (self._shift if line == 0 else 0))
        stop = Diagnostic(code, message.replace("\n", " "), mark, hint)
        raise SpecError([*self._problems, stop])

    def _add(self, code: str, message: str, mark: Mark, hint: str = "") -> None:
        self._problems.append(Diagnostic(code, message, mark, hint))

    def _mark(self, event: Any) -> Mark:
        start, end = event.start_mark, event.end_mark
        width = end.column - start.column if end.line == start.line else 1
        column = start.column + (self._shift if start.line == 0 else 0)
        return Mark(self._source, start.line, column, max(1, width))

    def _node(self, event: Any, depth: int) -> Node:
        mark = self._mark(event)
        if depth > MAX_DEPTH:
            text = f"nested deeper than {MAX_DEPTH} levels"
            self._stop("E009", text, "", mark.line, mark.column)
        self._refuse_indirection(event, mark)
        kind = _kind(event)
        if kind == "ScalarEvent":
            return Node(mark, self._scalar(event, mark))
        if kind == "MappingStartEvent":
            return Node(mark, self._map(depth))
        if kind == "SequenceStartEvent":
            return Node(mark, self._list(depth))
        return Node(mark, None)

    def _refuse_indirection(self, event: Any, mark: Mark) -> None:
        feature = "alias" if _kind(event) == "AliasEvent" else "anchor"
        if getattr(event, "anchor", None):
            self._add("E004", f"{feature} '{event.anchor}' is not allowed", mark, "use 'extends'")
        if getattr(event, "ctag", None):
            self._add("E005", f"tag '{event.tag}' is not allowed", mark)

    def _list(self, depth: int) -> tuple[Node, ...]:
        items = []
        while _kind(event := self._next()) != "SequenceEndEvent":
            items.append(self._node(event, depth + 1))
        return tuple(items)

    def _map(self, depth: int) -> dict[str, Entry]:
        entries: dict[str, Entry] = {}
        while _kind(event := self._next()) != "MappingEndEvent":
            mark = self._mark(event)
            key = event.value if _kind(event) == "ScalarEvent" else None
            if key is None:
                self._node(event, depth + 1)
            else:
                self._refuse_hidden(key, mark)
                self._refuse_indirection(event, mark)
            node = self._node(self._next(), depth + 1)
            if self._usable(key, event, mark, entries):
                entries[str(key)] = Entry(mark, node)
        return entries

    def _usable(self, key: str | None, event: Any, mark: Mark, entries: dict[str, Entry]) -> bool:
        if key in (None, ""):
            self._add("E010", "a key must be text", mark)
        elif key == "<<" and event.implicit[0]:
            self._add("E006", "merge key '<<' is not allowed", mark, "use 'extends'")
        elif key in entries:
            first = (("first written at", entries[str(key)].key),)
            self._problems.append(Diagnostic("E003", f"duplicate key '{key}'", mark, also=first))
        else:
            return True
        return False

    def _refuse_hidden(self, text: str, mark: Mark) -> None:
        """Refuse invisible characters, as results and bundles do."""
        if hidden := hidden_character(text):
            hint = "it comes from a web page or an editor; write the text again"
            self._add("E016", f"the text has the hidden character {hidden}", mark, hint)

    def _scalar(self, event: Any, mark: Mark) -> Scalar:
        text: str = event.value
        self._refuse_hidden(text, mark)
        if not event.implicit[0]:
            return text
        if text in _WORDS:
            return _WORDS[text]
        if _INT.fullmatch(text) or _FLOAT.fullmatch(text):
            return self._number(text, mark)
        if _NOT_FINITE.fullmatch(text):
            self._add("E008", f"{text} is not allowed", mark, "numbers are finite")
        return text

    def _number(self, text: str, mark: Mark) -> Scalar:
        if _LEADING_ZERO.match(text):
            self._add("E008", f"'{text}' has a leading zero", mark, "quote it if it is text")
        elif not _INT.fullmatch(text):
            if math.isfinite(value := float(text)):
                return value
            self._add("E008", f"'{text}' is too large", mark)
        elif len(text) <= 40:
            return int(text, 0) if text[:2] in ("0x", "0o") else int(text)
        else:
            self._add("E008", f"'{text[:12]}…' is too large", mark)
        return text
