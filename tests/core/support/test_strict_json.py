"""Documents that two parsers would read differently are refused, and all others are read."""

from __future__ import annotations

import json
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.support.strict_json import DEEPEST, LONGEST, parse_json
from crowdbot.errors import hidden_character, printable

SHOWN = st.text(st.characters(exclude_categories=("Cc", "Cf", "Cs", "Zl", "Zp")))
NUMBERS = st.integers() | st.floats(allow_nan=False, allow_infinity=False)
DOCUMENTS = st.recursive(
    st.none() | st.booleans() | NUMBERS | SHOWN,
    lambda inner: st.lists(inner) | st.dictionaries(SHOWN, inner),
)


@given(DOCUMENTS)
def test_what_json_writes_is_read(document: object) -> None:
    assert parse_json(json.dumps(document)) == document
    assert parse_json(json.dumps(document, ensure_ascii=False, indent=1)) == document


@pytest.mark.parametrize(("text", "why"), [
    ('{"a": {"b": 1, "c": 2, "b": 3}}', "the key 'b' is there twice"),
    ('{"a": NaN}', "NaN is not a number of JSON"),
    ("[-Infinity]", "-Infinity is not a number of JSON"),
    ("[1e999]", "the number 1e999 is too large"),
    ("9" * (LONGEST + 1), "a whole number has 301 digits"),
    ("[" * DEEPEST + "0" + "]" * DEEPEST, ""),
    ("[" * (DEEPEST + 1) + "0" + "]" * (DEEPEST + 1), "nested deeper than 64 brackets"),
    ("[" * 100_000, "nested deeper than 64 brackets"),
    (r'["\ud800"]', "the hidden character U+D800"),
    (r'{"\u202e": 1}', "the hidden character U+202E"),
    (r'["\u001b[2J"]', "the hidden character U+001B"),
    (r'["\b"]', "the hidden character U+0008"),
    ('["\x7f"]', "the hidden character U+007F"),
    ('["é", ' + "[" * (DEEPEST - 1) + "0" + "]" * DEEPEST, ""),
    ('["é", ' + "[" * DEEPEST + "0" + "]" * (DEEPEST + 1), "nested deeper than 64 brackets"),
    ("\ufeff{}", "byte order mark"),
    ("{'a': 1}", "Expecting"),
    ("", "Expecting"),
])  # fmt: skip
def test_what_can_be_read_in_two_ways(text: str, why: str) -> None:
    if not why:
        assert parse_json(text)
        return
    with pytest.raises(ValueError, match=re.escape(why)):
        parse_json(text)


@given(st.text(st.characters()))
def test_printable_texts_hide_nothing_and_can_be_written(text: str) -> None:
    shown = printable(text)
    assert hidden_character(shown, allowed="\t\n") == ""
    assert shown.encode().decode() == shown
    assert printable(shown) == shown
    if not hidden_character(text, allowed="\t\n"):
        assert shown == text
