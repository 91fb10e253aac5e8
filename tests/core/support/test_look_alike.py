"""Names that look alike, by UTS 39."""

from __future__ import annotations

import pytest

from crowdbot.core.support.look_alike import alike, looks, skeleton


@pytest.mark.parametrize(
    ("a", "b"),
    [
        ("Team", "team"),
        ("paypal", "p\u0430yp\u0430l"),  # Cyrillic
        ("Platon", "PIaton"),
        ("Rome", "Rorne"),
        ("scope", "\u0455\u0441\u043e\u0440\u0435"),
        ("Alpha 1", "Alpha l"),
        ("Alpha 0", "Alpha O"),
        ("MINI", "mini"),
        ("file", "\ufb01le"),
        ("a b", "a\u00a0\u00a0b"),
        ("n\u00e9e", "ne\u0301e"),
        ("x", "x\u200d"),
        ("Us \u00b7 dwa", "Us \u2219 dwa"),
    ],
)
def test_these_look_alike(a: str, b: str) -> None:
    assert looks(a) & looks(b)
    assert alike([a, b, "another"]) == {a, b}


@pytest.mark.parametrize(
    ("a", "b"), [("Us", "Them"), ("dwa", "dvva2"), ("Team 2", "Team 3"), ("a", "")]
)
def test_these_do_not(a: str, b: str) -> None:
    assert not looks(a) & looks(b)
    assert alike([a, b]) == set()


def test_a_name_that_is_there_twice_is_named() -> None:
    assert alike(["a", "a", "b"]) == {"a"}


def test_skeletons_are_stable() -> None:
    for text in ("Rome", "\u0430\u0440", "1lI|", "m"):
        assert skeleton(skeleton(text)) == skeleton(text)
