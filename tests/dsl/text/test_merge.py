from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.dsl.identity.canonical import difference
from crowdbot.dsl.suite.matrix import combinations, read_axes
from crowdbot.dsl.text.diagnostics import Diagnostic, Source
from crowdbot.dsl.text.merge import merge, undot
from crowdbot.dsl.text.nodes import Node, parse, to_data
from crowdbot.dsl.text.plain_yaml import to_yaml

names = st.sampled_from("abc")
maps = st.dictionaries(
    names,
    st.recursive(
        st.integers(0, 9) | st.lists(st.integers(), max_size=2),
        lambda inner: st.dictionaries(names, inner, min_size=1, max_size=3),
        max_leaves=6,
    ),
    min_size=1,
    max_size=3,
)


def tree(text: str, name: str = "t") -> Node:
    problems: list[Diagnostic] = []
    node = undot(parse(text, Source(name, text.split("\n")), problems), problems)
    assert problems == []
    return node


def of(data: Any) -> Node:
    return tree(to_yaml(data))


def merged(*texts: str) -> Any:
    root = tree(texts[0])
    for text in texts[1:]:
        root = merge(root, tree(text))
    return to_data(root)


def test_maps_merge_and_lists_are_replaced() -> None:
    assert merged("a: {b: 1, c: [1, 2]}", "a: {c: [3], d: 4}") == {"a": {"b": 1, "c": [3], "d": 4}}


def test_another_kind_discards_the_old_map() -> None:
    assert merged("a: {kind: x, b: 1}", "a: {kind: y, c: 2}") == {"a": {"kind": "y", "c": 2}}
    assert merged("a: {kind: x, b: 1}", "a: {kind: x, c: 2}") == {
        "a": {"kind": "x", "b": 1, "c": 2}
    }


def test_null_removes_and_empty_map_empties() -> None:
    assert merged("a: {b: 1, c: 2}", "a.b: null") == {"a": {"c": 2}}
    assert merged("a: {b: 1}", "a: {}") == {"a": {}}
    assert merged("a: 1", "b: null") == {"a": 1, "b": None}


def test_dotted_keys() -> None:
    assert merged("a.b.c: 1\na.d: 2\na: {e: 3}") == {"a": {"b": {"c": 1}, "d": 2, "e": 3}}


def test_the_winner_keeps_its_own_position() -> None:
    root = merge(tree("a: {b: 1, c: 2}", "base"), tree("\na.c: 3", "over"))
    a = root.entries["a"]
    assert a.key.source.name == "base"
    assert a.node.entries["b"].node.mark.source.name == "base"
    c = a.node.entries["c"]
    assert (c.key.source.name, c.key.line, c.key.column, c.key.width) == ("over", 1, 2, 1)


def test_quoted_dotted_keys_point_inside_the_quotes() -> None:
    entry = tree("'a.bb': 1").entries["a"].node.entries["bb"]
    assert (entry.key.column, entry.key.width) == (3, 2)


def leaves(data: Any, path: tuple[str, ...] = ()) -> dict[tuple[str, ...], Any]:
    if not isinstance(data, dict):
        return {path: data}
    return {k: v for key, child in data.items() for k, v in leaves(child, (*path, key)).items()}


@pytest.mark.slow
@given(maps, maps)
def test_later_wins_and_the_rest_stays(a: Any, b: Any) -> None:
    old, new = leaves(a), leaves(b)
    kept = {
        p: v for p, v in old.items() if not any(p[: len(q)] == q or q[: len(p)] == p for q in new)
    }
    assert leaves(to_data(merge(of(a), of(b)))) == {**kept, **new}


@given(maps)
def test_merge_is_idempotent_and_has_a_neutral_element(a: Any) -> None:
    x = of(a)
    assert to_data(merge(x, x)) == a
    assert to_data(merge(x, Node(x.mark, {}, implied=True))) == a


@pytest.mark.slow
@given(maps, maps)
def test_merge_changes_neither_side(a: Any, b: Any) -> None:
    x, y = of(a), of(b)
    merge(x, y)
    assert (to_data(x), to_data(y)) == (a, b)


@pytest.mark.slow
@given(maps, maps)
def test_a_difference_laid_over_the_old_gives_the_new(a: Any, b: Any) -> None:
    change = difference(a, b)
    assert (to_data(merge(of(a), of(change))) if change else a) == b


def axes(text: str) -> tuple[Any, list[str]]:
    problems: list[Diagnostic] = []
    return read_axes(tree(text), problems), [d.code for d in problems]


def test_first_axis_is_slowest() -> None:
    found, problems = axes("x: {x1: {a: 1}, x2: {a: 2}}\ny: {y1: {b: 1}, y2: {b: 2}}")
    listed = list(combinations(tree("c: 0"), found))
    assert problems == []
    assert ["".join(c.labels) for c in listed] == ["x1y1", "x1y2", "x2y1", "x2y2"]
    assert to_data(listed[2].tree) == {"a": 2, "b": 1, "c": 0}


@pytest.mark.parametrize(
    ("text", "clash"),
    [
        ("x: {p: {a.b: 1}}\ny: {q: {a.c: 1}}", False),
        ("x: {p: {a.b: 1}}\ny: {q: {a.b: 1}}", True),
        ("x: {p: {a: null}}\ny: {q: {a.b: 1}}", True),
        ("x: {p: {a.b.c: 1}}\ny: {q: {}, r: {a: {b: {c: 2}}}}", True),
        ("x: {p: {a: {kind: k}}}\ny: {q: {a.b: 1}}", True),
        ("x: {p: {a: {}}}\ny: {q: {a.b: 1}}", True),
    ],
)
def test_two_axes_may_not_write_the_same_field(text: str, clash: bool) -> None:
    assert axes(text)[1] == (["E205"] if clash else [])


def test_parts_that_no_axis_touches_are_shared() -> None:
    found, _ = axes("x: {x1: {a.p: 1}, x2: {a.p: 2}}")
    one, two = combinations(tree("b: {c: 0}"), found)
    assert one.tree.child("b") is two.tree.child("b")
