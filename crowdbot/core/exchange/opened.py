"""Files to import, opened and parsed by their content."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from crowdbot.core.exchange.data_items import parse_data
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.source import source_of
from crowdbot.core.exchange.xml_items import parse_xml
from crowdbot.core.trajectories.data_sets.jupedsim_output import ENDINGS as DATABASES
from crowdbot.core.trajectories.data_sets.jupedsim_output import is_database
from crowdbot.dsl.text.diagnostics import Diagnostic, Mark, Source
from crowdbot.errors import SpecError

_DATA = (".json", ".yaml", ".yml", ".scenario")
_XML = (".xml", ".svg")
#: TrajNet++ has a text of JSON on each line.
_LINES_OF_DATA = ".ndjson"
#: Most characters of JSON and YAML.
_LARGEST_DATA = 8_000_000


@dataclass(slots=True)
class OpenedScene:
    """A file to import: its text, and its parsed elements.

    Attributes:
        path: its path.
        source: its lines.
        text: its content.
        roots: root elements of XML, the root of JSON or YAML, or nothing for other text.
        kind: ``xml``, ``data`` or ``text``.
    """

    path: Path
    source: Source
    text: str
    kind: str
    roots: list[Item] = field(default_factory=list)

    @property
    def top(self) -> Mark:
        """Return the beginning of its text."""
        return Mark(self.source)

    @property
    def tags(self) -> set[str]:
        """Names of its root elements, or of the fields at its top."""
        if self.kind == "data":
            return {child.name for child in self.roots[0].children}
        return {root.name for root in self.roots}


def open_file_of_others(path: Path, report: Report) -> OpenedScene:
    """Open and parse a file; record violations of its format that are accepted.

    Raises:
        SpecError: E401, it cannot be read or parsed.
    """
    if path.suffix.lower() in DATABASES and is_database(path):
        return OpenedScene(path, Source(str(path), [""], file=path), "", "text")
    source, text = source_of(path)
    start, ending = text.lstrip()[:1], path.suffix.lower()
    if start == "<" or ending in _XML:
        roots, odd = parse_xml(text, source)
        for mark, note in odd:
            report.odd(mark, note)
        return OpenedScene(path, source, text, "xml", roots)
    if (start == "{" and ending != _LINES_OF_DATA) or ending in _DATA:
        if len(text) > _LARGEST_DATA:
            message = f"is larger than {_LARGEST_DATA // 10**6} MB, which JSON and YAML may have"
            raise SpecError([Diagnostic("E401", message, Mark(source))])
        return OpenedScene(path, source, text, "data", [parse_data(text, source)])
    return OpenedScene(path, source, text, "text")
