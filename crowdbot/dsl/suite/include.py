"""Resolve ``extends``: files merged below the map that names them; and tables of agents.

A path is relative to the file that contains it, never to the working directory.
"""

from __future__ import annotations

import os.path
from dataclasses import dataclass, field, replace
from pathlib import Path

from crowdbot.dsl.suite.agents_csv import read_agents
from crowdbot.dsl.text.bounded_files import read_text
from crowdbot.dsl.text.diagnostics import OTHER_FILES, Diagnostic, Mark, Source
from crowdbot.dsl.text.finder import Finder, Roots
from crowdbot.dsl.text.merge import merge, undot
from crowdbot.dsl.text.nodes import Node, parse
from crowdbot.errors import SpecError

MAX_INCLUDES = 64

#: Top-level maps whose keys are kinds, which contain dots.
_VERBATIM = ("kinds",)


@dataclass(frozen=True, slots=True)
class _File:
    """A file being read: its path, its name for messages, and the files that included it."""

    path: Path
    name: str
    chain: tuple[Path, ...]


def _refuse_xml(text: str, source: Source) -> None:
    """Raise E011 for XML, since the YAML parser's error would be misleading."""
    if text.lstrip("\ufeff \t\r\n").startswith("<"):
        message = "the document is XML, and must be a map of fields in YAML"
        raise SpecError([Diagnostic("E011", message, Mark(source), OTHER_FILES)])


@dataclass
class Loader:
    """Reads a file and everything it extends, and collects errors."""

    top: Path
    roots: Roots
    problems: list[Diagnostic] = field(default_factory=list)
    files: list[Path] = field(default_factory=list)
    _count: int = 0

    def load(self, name: str) -> Node:
        """Return the top-level file as one tree, with ``extends`` and dotted keys resolved."""
        return self._read(_File(self.top, name, ()), None)

    def _read(self, file: _File, included_from: Mark | None) -> Node:
        """Read one file; an unreadable one counts as an empty map, and its error is recorded."""
        source = Source(file.name, (), included_from, file.path)
        try:
            text = _read_text(file, source)
            source = replace(source, lines=text.split("\n"))
            _refuse_xml(text, source)
            root = parse(text, source, self.problems)
        except SpecError as error:
            self.problems += [d for d in error.diagnostics if d not in self.problems]
            return Node(Mark(source), {}, implied=True)
        if not isinstance(root.value, dict):
            problem = "is empty" if root.value is None else "must be a map of fields"
            hint = OTHER_FILES if isinstance(root.value, str) else ""
            self.problems.append(Diagnostic("E011", f"the document {problem}", root.mark, hint))
            return Node(root.mark, {})
        here = replace(file, chain=(*file.chain, file.path.resolve()))
        return self._resolve(
            self._with_rows(undot(root, self.problems, verbatim=_VERBATIM), here), here
        )

    def _with_rows(self, node: Node, file: _File, below: str = "") -> Node:
        """Return a tree with the rows of each table in place of ``crowd.agents: {csv: FILE}``."""
        changed = {}
        for key, entry in node.entries.items():
            table = entry.node.child("csv") if (below, key) == ("crowd", "agents") else None
            made = (
                self._with_rows(entry.node, file, key)
                if table is None
                else self._rows(entry.node, table, file)
            )
            if made is not entry.node:
                changed[key] = replace(entry, node=made)
        return replace(node, value={**node.entries, **changed}) if changed else node

    def _rows(self, agents: Node, table: Node, file: _File) -> Node:
        """Return the rows of a table of agents; empty if unreadable, and its error is recorded."""
        nothing = Node(table.mark, ())
        for key, entry in agents.entries.items():
            if key != "csv":
                self._add("E102", f"unknown field '{key}' beside 'csv'", entry.key)
        found = self._named_file(table, file, "E015", "csv wants the path of a table")
        if found is None:
            return nothing
        source = Source(found.name, (), table.mark)
        try:
            text = _read_text(found, source)
        except SpecError as error:
            self.problems += [d for d in error.diagnostics if d not in self.problems]
            return nothing
        source = Source(found.name, text.split("\n"), table.mark)
        return replace(read_agents(text, source, self.problems), mark=table.mark)

    def _resolve(self, root: Node, file: _File) -> Node:
        """Resolve ``extends`` at the root and wherever a scenario's fields are allowed."""
        entries = dict(root.entries)
        for key, depth in (("matrix", 2), ("references", 1)):
            if key in entries:
                part = entries[key]
                entries[key] = replace(part, node=self._below(part.node, file, depth))
        for key in ("base", "scenario"):
            if key in entries and entries[key].node.entries:
                part = entries[key]
                entries[key] = replace(part, node=self._extended(part.node, file, within=True))
        return self._extended(replace(root, value=entries), file)

    def _below(self, node: Node, file: _File, depth: int) -> Node:
        """Resolve ``extends`` in the maps that lie ``depth`` levels below a map."""
        if depth == 0:
            return self._extended(node, file, within=True)
        if not node.entries:
            return node
        below = {
            k: replace(e, node=self._below(e.node, file, depth - 1))
            for k, e in node.entries.items()
        }
        return replace(node, value=below)

    def _extended(self, node: Node, file: _File, *, within: bool = False) -> Node:
        """Return a map merged over the files it extends; ``within``: they hold scenario parts."""
        if "extends" not in node.entries:
            return node
        entries = dict(node.entries)
        extends = entries.pop("extends")
        own = replace(node, value=entries)
        items = extends.node.value if isinstance(extends.node.value, tuple) else (extends.node,)
        tree = Node(node.mark, {}, implied=True)
        for item in items:
            found = self._include(item, file)
            tree = merge(tree, self._part(found, item) if within else found)
        return merge(tree, own if own.entries else replace(own, implied=True))

    def _include(self, item: Node, file: _File) -> Node:
        found = self._named_file(item, file, "E111", "extends wants a path or a list of paths")
        if found is None:
            return Node(item.mark, {}, implied=True)
        return self._read(found, item.mark)

    def _part(self, found: Node, item: Node) -> Node:
        """Return an included part of a scenario; record an error if it is a whole document."""
        if "crowdbot" not in found.entries:
            return found
        text = f"'{item.value}' is a whole document, and this wants a part of a scenario"
        hint = f"write 'extends: {item.value}' at the top, beside 'crowdbot'"
        self._add("E102", text, item.mark, hint)
        of = found.child("scenario") or found.child("base")
        return replace(of, implied=True) if of is not None else Node(item.mark, {}, implied=True)

    def _named_file(self, item: Node, file: _File, code: str, name: str) -> _File | None:
        """Return the file that a value names, if it may be read; otherwise record the error."""
        if not isinstance(item.value, str):
            self._add(code, name, item.mark)
            return None
        found = self._find(item.value, item.mark, file)
        if found is None:
            return None
        self._count += 1
        if self._count > MAX_INCLUDES:
            self._add("E206", f"more than {MAX_INCLUDES} files are included", item.mark)
            return None
        self.files.append(found.path)
        return found

    def _find(self, text: str, mark: Mark, file: _File) -> _File | None:
        """Return the file of a path, if it may be read; otherwise record the error."""
        path = Finder(self.top, self.roots).find(text, mark)
        if isinstance(path, Diagnostic):
            self.problems.append(path)
            return None
        name = text if ":" in text else self._beside(file.name, text)
        return self._unless_cycle(_File(path, name, file.chain), mark)

    def _beside(self, name: str, text: str) -> str:
        """Return the name, for messages, of a file given by a path relative to another file."""
        plugin, colon, path = name.rpartition(":")
        if plugin not in self.roots:
            plugin, colon, path = "", "", name
        return plugin + colon + os.path.normpath(os.path.join(os.path.dirname(path), text))  # noqa: PTH118, PTH120 - text, not files

    def _unless_cycle(self, file: _File, mark: Mark) -> _File | None:
        target = file.path.resolve()
        if target not in file.chain:
            return file
        chain = " -> ".join(p.name for p in (*file.chain[file.chain.index(target) :], target))
        self._add("E202", f"files include each other: {chain}", mark)
        return None

    def _add(self, code: str, message: str, mark: Mark, hint: str = "") -> None:
        self.problems.append(Diagnostic(code, message, mark, hint))


def _read_text(file: _File, source: Source) -> str:
    """Return the text of a file; errors name its includer."""
    try:
        return read_text(file.path, file.name)
    except SpecError as error:
        raise SpecError(
            [replace(d, mark=Mark(source, d.mark.line, d.mark.column)) for d in error.diagnostics]
        ) from None
