"""The report of an import or export: each part that was read, its outcome and its place."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.rows import PartOutcome, RowTable
from crowdbot.dsl.text.diagnostics import Mark

#: Most parts that a line of the report names of one that is left out as a whole.
_SHOWN = 8
#: Reason of parts that no reader asked for.
UNKNOWN = "no meaning of it is known here"


@dataclass(frozen=True, slots=True)
class Trace:
    """The outcome for one part of a file: carried over, interpreted, left out or added.

    Attributes:
        outcome: what happened to it.
        theirs: path of the part, or what was added.
        at: its position; None for what only our document has.
        ours: place in our document; empty if it has none.
        note: reason, or how it was interpreted.
        within: paths and positions of the parts that share its outcome, each path once.
    """

    outcome: PartOutcome
    theirs: str
    at: Mark | None
    ours: str = ""
    note: str = ""
    within: tuple[tuple[str, Mark], ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for ``--json``; line and column count from 1."""
        place = {"file": self.at.source.name, **_line_and_column(self.at)} if self.at else {}
        within = [{"theirs": path, **_line_and_column(mark)} for path, mark in self.within]
        return {"fate": self.outcome.value, "theirs": self.theirs, **place, "ours": self.ours,
                "note": self.note} | ({"within": within} if within else {})  # fmt: skip


def _line_and_column(mark: Mark) -> dict[str, int]:
    return {"line": mark.line + 1, "column": mark.column + 1}


@dataclass(slots=True)
class Report:
    """Collects what an import or export carried over, interpreted, left out and added."""

    entries: list[Trace] = field(default_factory=list)

    def carried(self, item: Item, ours: str) -> None:
        """Record a part that is carried over as it is."""
        item.used = True
        self.entries.append(Trace(PartOutcome.CARRIED, item.path, item.mark, ours))

    def interpreted(self, item: Item, ours: str, note: str) -> None:
        """Record a part that means nearly the same as a field of crowdbot."""
        item.used = True
        self.entries.append(Trace(PartOutcome.INTERPRETED, item.path, item.mark, ours, note))

    def left_out(self, item: Item, note: str, *, whole: bool = True) -> None:
        """Record a part, by default with everything in it, that has no place in our language."""
        within: dict[str, Mark] = {}
        if whole:
            for part in item.walk():
                if not part.used and part is not item:
                    within.setdefault(part.path, part.mark)
            item.take_all()
        item.used = True
        self.entries.append(
            Trace(PartOutcome.LEFT_OUT, item.path, item.mark, "", note, tuple(within.items()))
        )

    def added(self, ours: str, note: str, at: Mark | None = None) -> None:
        """Record a field that our language needs and the files do not have."""
        self.entries.append(Trace(PartOutcome.ADDED, "", at, ours, note))

    def odd(self, mark: Mark, note: str) -> None:
        """Record a violation of the file's format that was accepted."""
        self.entries.append(Trace(PartOutcome.INTERPRETED, "(syntax)", mark, "", note))

    def take(self, item: Item, table: RowTable) -> dict[str, Any]:
        """Return crowdbot's fields for an item's parts, by its table; each is recorded.

        Raises:
            SpecError: a part has a value that its row does not accept.
        """
        found: dict[str, Any] = {}
        for row in table.rows:
            for part in item.every(row.theirs):
                if row.ours:
                    found[row.field] = row.read(part)
                    self.entries.append(
                        Trace(row.outcome, part.path, part.mark, row.ours, row.note)
                    )
                elif row.unless and _same(part, row.unless):
                    self.carried(part, f"(nothing to carry over: {row.unless})")
                else:
                    self.left_out(part, row.note)
        return found

    def others(self, item: Item, note: str, *names: str) -> None:
        """Record parts of an item that no reader used: all, or those of some names."""
        for part in item.children:
            if not part.used and (not names or part.name in names):
                self.left_out(part, note)

    def rest(self, root: Item) -> None:
        """Record all items that no reader used, each at its outermost part."""
        stack = [root]
        while stack:
            item = stack.pop()
            if not item.used:
                self.left_out(item, UNKNOWN)
            elif item.value is not None and not item.heard:
                self.left_out(
                    item, f"the text {str(item.value)[:40]!r} has no meaning here", whole=False
                )
            stack += reversed(item.children)

    def counts(self) -> dict[str, int]:
        """Return outcome -> number of entries."""
        found = Counter(entry.outcome for entry in self.entries)
        return {outcome.value: found[outcome] for outcome in PartOutcome}

    def lines(self) -> list[str]:
        """Return one line per kind of part that was not carried over as it is, then the sums."""
        groups: dict[tuple[PartOutcome, str, str, str], list[Trace]] = {}
        for entry in self.entries:
            if entry.outcome != PartOutcome.CARRIED:
                key = (entry.outcome, entry.theirs, entry.ours, entry.note)
                groups.setdefault(key, []).append(entry)
        order = sorted(groups, key=lambda key: list(PartOutcome).index(key[0]))
        sums = ", ".join(f"{number} {outcome}" for outcome, number in self.counts().items())
        return [*(_line(key, groups[key]) for key in order), sums]


def _same(part: Item, value: str) -> bool:
    """Return True if a part has a value, as text or as number."""
    text = part.text().lower()
    try:
        return text == value or float(text) == float(value)
    except ValueError:
        return False


def _below(path: str, whole: str) -> str:
    """Return a path relative to the part that contains it."""
    return path.removeprefix(whole).lstrip("/@") or path


def _line(key: tuple[PartOutcome, str, str, str], entries: list[Trace]) -> str:
    outcome, theirs, ours, note = key
    first = next((str(e.at) for e in entries if e.at), "")
    more = f" and {len(entries) - 1} more" if len(entries) > 1 else ""
    names = dict.fromkeys(_below(path, theirs) for entry in entries for path, _ in entry.within)
    shown = ", ".join([*list(names)[:_SHOWN], *(["…"] if len(names) > _SHOWN else [])])
    change = " -> ".join(filter(None, (f"{theirs} ({shown})" if shown else theirs, ours)))
    where, why = f"{first}{more}: " if first else "", f": {note}" if note else ""
    return f"{outcome.value}: {where}{change}{why}"
