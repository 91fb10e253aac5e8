"""Documents written in parts have the bytes of those that are written as a whole."""

from __future__ import annotations

from typing import Any

from hypothesis import example, given, settings
from hypothesis import strategies as st

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.identity.canonical import plain
from crowdbot.dsl.text.plain_yaml import to_yaml
from crowdbot.dsl.text.yaml_in_parts import to_yaml_in_parts

SCALARS = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=130)
KEYS = st.text(min_size=1, max_size=20)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(KEYS, inner, max_size=4),
    max_leaves=12,
)


@settings(max_examples=150, deadline=None)
@given(st.dictionaries(KEYS, VALUES, max_size=4))
@example({"_": []})
@example({"_": {"_": [1]}})
def test_any_document(inner: dict[str, Any]) -> None:
    document = {"crowdbot": 1, "scenario": inner, "kinds": {}}
    assert to_yaml_in_parts(document) == to_yaml(document)


def test_scenarios_that_have_much_in_common() -> None:
    registry = discover(allow=())
    for one in open_spec("challenge-2020", registry).scenarios[::20]:
        document = {"crowdbot": 1, "scenario": plain(one), "kinds": {"corridor": 1}}
        assert to_yaml_in_parts(document) == to_yaml(document)
