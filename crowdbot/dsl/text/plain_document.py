"""Read YAML documents and values that are not suites, with the same syntax and limits."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from crowdbot.dsl.text.bounded_files import read_text
from crowdbot.dsl.text.diagnostics import Diagnostic, Source
from crowdbot.dsl.text.nodes import Node, parse
from crowdbot.errors import SpecError


def read_document(path: Path, name: str) -> Any:
    """Return the content of a YAML file as plain data.

    Args:
        path: the file.
        name: its name for messages.

    Raises:
        SpecError: it cannot be read, is too large or deep, or is not plain YAML.
    """
    text = read_text(path, name)
    return _content(text, Source(name, text.split("\n"), file=path))


def parse_document(text: str, name: str) -> Any:
    """Return the content of a YAML text as plain data.

    Raises:
        SpecError: it is too deep, or is not plain YAML.
    """
    return _content(text, Source(name, text.split("\n")))


def parse_setting(text: str, option: str) -> tuple[str, Any]:
    """Return key and value of a ``key=value`` text whose value is YAML.

    Args:
        text: the setting; it has a ``=``.
        option: name of the option for messages.

    Raises:
        SpecError: the value is not plain YAML.
    """
    key, _, value = text.partition("=")
    return key.strip(), _content(value, Source(option, (text,)), shift=len(key) + 1)


def _content(text: str, source: Source, shift: int = 0) -> Any:
    problems: list[Diagnostic] = []
    root = parse(text, source, problems, shift)
    if problems:
        raise SpecError(problems)
    return plain(root)


def plain(node: Node) -> Any:
    """Return plain data; maps keep the order of the file."""
    if isinstance(node.value, dict):
        return {key: plain(entry.node) for key, entry in node.value.items()}
    if isinstance(node.value, tuple):
        return [plain(item) for item in node.value]
    return node.value
