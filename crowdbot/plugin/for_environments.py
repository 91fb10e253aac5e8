"""Tools for environments' build functions: read files with limits, and repair polygons."""

from __future__ import annotations

from crowdbot.core.geometry.valid_shape import valid_shape
from crowdbot.core.support.strict_json import DEEPEST, parse_foreign_json
from crowdbot.core.support.text_files import LARGEST_TABLE, input_bytes, input_text
from crowdbot.dsl.text.plain_document import read_document
from crowdbot.errors import SpecError

__all__ = [
    "DEEPEST",
    "LARGEST_TABLE",
    "SpecError",
    "input_bytes",
    "input_text",
    "parse_foreign_json",
    "read_document",
    "valid_shape",
]
