"""XML of other programs as items: no entities, no document types, bounded size, depth and count.

UMANS' own parser accepts what XML does not: several root elements, and ``--`` within comments.
Shipped files have both, so both are accepted here, and named in the report.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NoReturn

from crowdbot.core.exchange.item import Item
from crowdbot.dsl.text.diagnostics import Diagnostic, Mark, Source
from crowdbot.errors import SpecError

if TYPE_CHECKING:
    from collections.abc import Mapping

#: Deepest nesting, and most elements and attributes of one file.
MOST_DEEP, MOST_ITEMS = 64, 400_000
#: Most root elements of one file; expat's number of the error that a further one is.
_MOST_ROOTS, _FURTHER_ROOT = 8, 9
#: Characters after the beginning of an element within which its attributes are looked for.
_NEAR = 4000
#: Most lines that they are looked for in.
_LINES = 40


def parse_xml(text: str, source: Source) -> tuple[list[Item], list[tuple[Mark, str]]]:
    """Return the root elements of a file, and the violations of XML that were accepted.

    Raises:
        SpecError: E401, it is not XML, or is hostile.
    """
    text, odd = _without_comments(text, source)
    roots: list[Item] = []
    start = line = 0
    while True:
        reader = _Reader(source, line)
        rest = reader.read(text[start:])
        roots.append(reader.root)
        if rest is None:
            return roots, odd
        start = _offset(text, start, *rest)
        line += rest[0]
        mark = Mark(source, line, rest[1])
        if len(roots) == _MOST_ROOTS:
            _refuse(mark, f"more than {_MOST_ROOTS} root elements")
        odd.append((mark, "a further root element, which XML does not allow"))
        text, start = " " * rest[1] + text[start:], 0


class _Reader:
    """Parser target that builds one root element, with the positions of its parts."""

    def __init__(self, source: Source, line: int) -> None:
        from defusedxml.ElementTree import DefusedXMLParser

        self._source, self._line = source, line
        self._open: list[Item] = []
        self._texts: list[list[str]] = []
        self._count = 0
        self.root = Item("", Mark(source))
        self._parser: Any = DefusedXMLParser(target=self, encoding="utf-8", forbid_dtd=True)

    def read(self, text: str) -> tuple[int, int] | None:
        """Parse; return line and column of a further root element, if there is one.

        Raises:
            SpecError: E401, it is not XML, or is hostile.
        """
        from xml.etree.ElementTree import ParseError

        from defusedxml.common import DefusedXmlException

        try:
            self._parser.feed(text)
            self._parser.close()
        except DefusedXmlException as error:
            kind = "document type (<!DOCTYPE>)" if "DTD" in type(error).__name__ else "entity"
            _refuse(self._mark(), f"a {kind}, which is refused in files of others")
        except ParseError as error:
            line, column = error.position
            if error.code == _FURTHER_ROOT and text.split("\n")[line - 1][column:].startswith("<"):
                return line - 1, column
            mark = Mark(self._source, self._line + line - 1, column)
            reason = str(error).rpartition(": line")[0] or str(error)
            _refuse(mark, f"not XML: {reason}")
        except ValueError as error:
            _refuse(self._mark(), f"not XML: {error}")
        return None

    def start(self, tag: str, attributes: Mapping[str, str]) -> None:
        """Open an element."""
        mark = self._mark(len(tag) + 1)
        self._count += 1 + len(attributes)
        if len(self._open) == MOST_DEEP:
            _refuse(mark, f"nested deeper than {MOST_DEEP} elements")
        if self._count > MOST_ITEMS:
            _refuse(mark, f"more than {MOST_ITEMS} elements and attributes")
        item = Item(_bare(tag), mark)
        for name, value in attributes.items():
            item.add(Item(f"@{_bare(name)}", self._attribute(mark, _bare(name)), value))
        if self._open:
            self._open[-1].add(item)
        else:
            self.root = item
        self._open.append(item)
        self._texts.append([])

    def end(self, tag: str) -> None:
        """Close an element."""
        del tag
        text = "".join(self._texts.pop()).strip()
        item = self._open.pop()
        item.value = text or None

    def data(self, text: str) -> None:
        """Add text to the open element."""
        self._texts[-1].append(text)

    def close(self) -> None:
        """End of the file."""

    def _mark(self, width: int = 1) -> Mark:
        parser = self._parser.parser
        line, column = self._line + parser.CurrentLineNumber - 1, parser.CurrentColumnNumber
        return Mark(self._source, line, column, width)

    def _attribute(self, mark: Mark, name: str) -> Mark:
        """Return the position of an attribute near its element's name, or the element's own."""
        lines, start, left = self._source.lines, mark.column, _NEAR
        for number in range(mark.line, min(mark.line + _LINES, len(lines))):
            line = f" {lines[number]}"
            for written in (f" {name}=", f":{name}="):
                at = line.find(written, start, start + left)
                if at >= 0:
                    return Mark(mark.source, number, at, len(name))
            left = max(0, left - len(line) + start)
            start = 0
        return mark


def _bare(name: str) -> str:
    """Return a name without its namespace."""
    return name.rpartition("}")[2]


def _without_comments(text: str, source: Source) -> tuple[str, list[tuple[Mark, str]]]:
    """Blank out comments that hold ``--``; positions stay as they are."""
    odd, parts, at, line, counted = [], [], 0, 0, 0
    while (start := text.find("<!--", at)) >= 0 and (end := text.find("-->", start + 4)) >= 0:
        inside = text[start + 4 : end]
        cdata = text.rfind("<![CDATA[", at, start)
        if cdata >= 0 and text.find("]]>", cdata, start) < 0:  # not a comment
            end = max(text.find("]]>", start), start + 1)
            parts.append(text[at:end])
        elif "--" in inside or inside.endswith("-"):
            line, counted = line + text.count("\n", counted, start), start
            mark = Mark(source, line, start - text.rfind("\n", 0, start) - 1)
            odd.append((mark, "a comment with '--' in it, which XML does not allow"))
            end += 3
            parts.append(text[at:start])
            parts.append("".join(c if c == "\n" else " " for c in text[start:end]))
        else:
            end += 3
            parts.append(text[at:end])
        at = end
    return "".join([*parts, text[at:]]), odd


def _offset(text: str, start: int, line: int, column: int) -> int:
    for _ in range(line):
        start = text.index("\n", start) + 1
    return start + column


def _refuse(mark: Mark, message: str) -> NoReturn:
    raise SpecError([Diagnostic("E401", message, mark)])
