from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from crowdbot.dsl.text.bounded_files import MAX_BYTES, read_text
from crowdbot.dsl.text.diagnostics import Diagnostic, Source
from crowdbot.dsl.text.nodes import Node, parse, to_data
from crowdbot.dsl.text.plain_yaml import to_yaml
from crowdbot.errors import SpecError


def read(text: str) -> Any:
    problems: list[Diagnostic] = []
    node = parse(text, Source("t", text.split("\n")), problems)
    assert problems == []
    return to_data(node)


def codes(text: str) -> list[str]:
    problems: list[Diagnostic] = []
    try:
        parse(text, Source("t", text.split("\n")), problems)
    except SpecError as error:
        return [d.code for d in error.diagnostics]
    return [d.code for d in problems]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        *((word, word) for word in ("no", "on", "yes", "off", "y", "12:30", "2020-04-30", "1_000")),
        *((word, word) for word in ("0.8 m/s", "1e", "e3", "0b1", "nan", "inf", "TRue")),
        ("1e-3", 0.001),
        ("1E3", 1000.0),
        ("-.5", -0.5),
        ("5.", 5.0),
        ("+7", 7),
        ("0", 0),
        ("-0.0", -0.0),
        ("0x1F", 31),
        ("0o17", 15),
        ("true", True),
        ("False", False),
        ("~", None),
        ("null", None),
        ("", None),
        ("'1'", "1"),
        ('"no"', "no"),
        ("'007'", "007"),
    ],
)
def test_core_schema(text: str, value: object) -> None:
    found = read(f"a: {text}")["a"]
    assert (type(found), found) == (type(value), value)


@pytest.mark.parametrize(
    "text", ["007", "-01.5", "00", ".nan", ".inf", "-.Inf", "1e999", "9" * 5000]
)
def test_refused_numbers(text: str) -> None:
    assert codes(f"a: {text}") == ["E008"]


def test_a_key_is_text() -> None:
    assert read("{1: a, no: b, 007: c, null: d}") == {"1": "a", "no": "b", "007": "c", "null": "d"}


def test_marks_of_keys_and_values() -> None:
    text = "a: 1\nb:\n  - x\n  - {cc: 'dd'}\n"
    root = parse(text, Source("t", text.split("\n")), [])
    entry = root.entries["b"]
    assert (entry.key.line, entry.key.column, entry.key.width) == (1, 0, 1)
    item = entry.node.child(1)
    assert item is not None
    inner = item.entries["cc"]
    assert (inner.key.line, inner.key.column, inner.key.width) == (3, 5, 2)
    assert (inner.node.mark.line, inner.node.mark.column, inner.node.mark.width) == (3, 9, 4)


def test_several_errors_are_all_found() -> None:
    assert codes("a: &x 1\nb: *x\nc: !t 1\na: 2\n<<: {}\nd: 01\n") == [
        *("E004", "E004", "E005", "E003", "E006", "E008")
    ]


@pytest.mark.parametrize("text", ["\\UFFFFFFFF", "\\xZZ", "\\ud800"])
def test_escapes_never_escape(text: str) -> None:
    assert codes(f'a: "{text}"') in (["E002"], ["E016"])


#: Categories of characters that documents must not have; the two joiners are allowed.
HIDDEN: tuple[Any, ...] = ("Cc", "Cf", "Cs", "Zl", "Zp")
JOINERS = "\u200c\u200d"
json_values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**63)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(st.characters(exclude_categories=HIDDEN, include_characters=JOINERS), max_size=12)
    | st.sampled_from(["no", "007", "1e3", ".nan", "0x1", "a: b", "- x", "#", "~", "'", "&a", "%"]),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(st.text("abc 1.-#:'\"", min_size=1, max_size=6), inner, max_size=4)
    ),
    max_leaves=12,
)


def same(a: Any, b: Any) -> bool:
    """Equal including types and signs of zero."""
    return json.dumps(a, sort_keys=True) == json.dumps(b, sort_keys=True)


@pytest.mark.slow
@given(json_values)
@example({"x": JOINERS})
def test_what_is_dumped_is_read_back(value: Any) -> None:
    text = to_yaml({"root": value})
    assert same(read(text), {"root": value}), text


@pytest.mark.parametrize("character", ["\u2028", "\x85", "\ufeff", "\u202e", "\x1b"])
def test_hidden_characters_stay_in_their_text_and_are_refused(character: str) -> None:
    text = to_yaml({"a": f"b{character}c", f"d{character}": "e"})
    assert codes(text) == ["E016", "E016"], text


@given(json_values)
def test_json_is_yaml(value: Any) -> None:
    assert same(read(json.dumps({"root": value}, ensure_ascii=False)), {"root": value})


@given(st.text(st.sampled_from("ab01:-[]{}?,&*!|>'\"%@`#. \n\t~<\x01\ud800"), max_size=40))
def test_any_text_gives_a_tree_or_positioned_errors(text: str) -> None:
    source, problems = Source("t", text.split("\n")), list[Diagnostic]()
    try:
        assert isinstance(parse(text, source, problems), Node)
    except SpecError as error:
        problems = list(error.diagnostics)
        assert problems
    assert all(0 <= d.mark.line <= len(source.lines) and d.mark.column >= 0 for d in problems)


def test_line_ends_and_byte_order_mark(tmp_path: Path) -> None:
    file = tmp_path / "f.yaml"
    file.write_bytes("\ufeffa: 1\r\nb: |\r\n  x\r\n  y\r\n".encode())
    assert read(read_text(file, "f")) == {"a": 1, "b": "x\ny\n"}


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"a\0b", "binary"),
        ("a: ü".encode("utf-16"), "UTF-16"),
        ("a: 1\nb: ü".encode("latin-1"), "not UTF-8 (line 2)"),
        (b"a: " + b"x" * MAX_BYTES, "larger than 1 MB"),
    ],
)
def test_no_text_files(tmp_path: Path, content: bytes, reason: str) -> None:
    file = tmp_path / "f.yaml"
    file.write_bytes(content)
    with pytest.raises(SpecError, match="E001") as caught:
        read_text(file, "f")
    assert reason in str(caught.value)


def test_missing_and_folder(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match="o such file"):
        read_text(tmp_path / "none.yaml", "none.yaml")
    with pytest.raises(SpecError, match="is a folder"):
        read_text(tmp_path, "folder")


def test_shift_moves_the_first_line_only() -> None:
    problems: list[Diagnostic] = []
    parse("01", Source("--set", ("k=01",)), problems, shift=2)
    assert problems[0].mark.column == 2
    assert math.isclose(to_data(parse("1.5", Source("--set"), [], shift=2)), 1.5)


def test_a_text_that_ends_too_early_is_not_said_to_be_a_list() -> None:
    with pytest.raises(SpecError) as error:
        parse("a: {b: {c: {", Source("t", ["a: {b: {c: {"]), [])
    (found,) = error.value.diagnostics
    assert (found.code, str(found.mark)) == ("E002", "t:1:13")
    assert "'['" not in found.message
