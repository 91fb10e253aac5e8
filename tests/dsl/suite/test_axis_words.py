"""What axes vary, in words: from the fields that their labels write."""

from __future__ import annotations

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.suite.axis_words import AxisWords, axis_words
from crowdbot.dsl.suite.matrix import read_axes
from crowdbot.dsl.text.diagnostics import Source
from crowdbot.dsl.text.merge import undot
from crowdbot.dsl.text.nodes import Node, parse

BASE = """\
crowd:
  costs:
    mid_term: {kind: ttca_dca, weight: 1}
  policy: {kind: velocity_space, angle: 180 deg}
"""


def node(text: str) -> Node:
    return undot(parse(text, Source("x"), []), [])


def words(matrix: str, changed: str = "{}") -> dict[str, dict[str, AxisWords]]:
    axes = read_axes(node(matrix), [])
    return axis_words(node(BASE), axes, node(changed))


@pytest.mark.parametrize(
    ("label", "title", "value"),
    [
        ("{crowd.costs.mid_term.weight: 20}", "ttca_dca weight", "20"),
        ("{crowd.flow.density: 0.25 1/m^2, title: x}", "flow density", "0.25 1/m²"),
        ("{crowd.speed: {mean: 1 m/s, std: 0.1 m/s}}", "speed", "mean 1 m/s, std 0.1 m/s"),
        ("{crowd.policy.angle: 90 deg}", "policy angle", "90 deg"),
        ("{robots.robot.task.time_limit: 30 s}", "robot time limit", "30 s"),
        ("{crowd.speed.clipped: true}", "speed clipped", "yes"),
        ("{crowd.agents: [{id: 0, x: 1 m}], title: One comes}", "agents", "One comes"),
        ("{crowd.agents: [{id: 0, x: 1 m}]}", "agents", "label"),
        ("{crowd.streams: {a: {density: 1}, b: {density: 1}}}", "streams density", "1"),
        ("{crowd.streams: {a: {rate: 1}, b: {rate: 2}}}", "streams", "a rate 1, b rate 2"),
        ("{}", "some axis", "label"),
    ],
)  # fmt: skip
def test_words_of_a_label(label: str, title: str, value: str) -> None:
    assert words(f"some_axis: {{label: {label}}}")["some_axis"]["label"] == (title, value)


def test_the_title_is_what_all_labels_have_in_common() -> None:
    found = words("a: {x: {crowd.speed.mean: 1 m/s}, y: {crowd.speed.std: 2 m/s}}")["a"]
    assert found == {"x": ("speed", "mean 1 m/s"), "y": ("speed", "std 2 m/s")}


def test_an_axis_that_set_changes_has_no_words() -> None:
    matrix = "a: {x: {crowd.speed.mean: 1 m/s}}\nb: {y: {crowd.flow.density: 1 1/m^2}}"
    assert set(words(matrix, "crowd.speed.mean: 3 m/s")) == {"b"}
    assert set(words(matrix, "crowd.speed: {mean: 3 m/s}")) == {"b"}
    assert set(words(matrix, "crowd: null")) == set()
    assert set(words(matrix, "crowd.speed.std: 3 m/s")) == {"a", "b"}


def test_words_of_the_challenge() -> None:
    found = open_spec("challenge-2020", discover(allow=()), ())
    assert found.words_of("counter-d0250-dispersed-c20-r05") == {
        "flow": ("flow direction", "counter"),
        "density": ("flow density", "0.25 1/m²"),
        "speed": ("speed", "mean 1.2 m/s, std 0.1 m/s"),
        "coeff": ("ttca_dca weight", "20"),
        "range": ("ttca_dca range", "5 m"),
    }
