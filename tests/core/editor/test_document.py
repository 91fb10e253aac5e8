"""Changes of a text keep its comments, its order and its dotted keys."""

from __future__ import annotations

import pytest

from crowdbot.core.editor.document import NEW, Edit, changed
from crowdbot.errors import InputError

_TEXT = """\
# Mine.
crowdbot: 1
scenario:
  id: mine   # the name
  environment:
    kind: floor
    area: {x: [0 m, 20 m], y: [0, 10]}  # the floor
    walls:
      # the first wall
      a: {start: [1, 1], end: [2, 2]}
  crowd.agents:
    - {id: 0, x: 1, y: 2, goals: [[3, 4]]}  # Anna
    - {id: 1, x: 5, y: 2, goals: [[3, 4]]}
"""


def _lines(text: str) -> list[str]:
    return [line.strip() for line in text.splitlines()]


def test_a_text_without_changes_stays() -> None:
    text = changed(_TEXT, [])
    assert "# the first wall" in text
    assert changed(text, []) == text


def test_values_change_in_place_and_comments_stay() -> None:
    wall = ["scenario", "environment", "walls", "a"]
    text = changed(_TEXT, [Edit([*wall, "end"], [4.0, 2.5]), Edit([*wall, "thickness"], 0.2)])
    assert "a: {start: [1, 1], end: [4, 2.5], thickness: 0.2}" in _lines(text)
    assert all(c in text for c in ("# Mine.", "# the name", "# the floor", "# Anna", "# the first"))


def test_dotted_keys_are_found() -> None:
    text = changed(_TEXT, [Edit(["scenario", "crowd", "agents", 1, "x"], 6.5)])
    assert "- {id: 1, x: 6.5, y: 2, goals: [[3, 4]]}" in _lines(text)
    assert text.count("crowd") == 2  # crowdbot, crowd.agents


def test_new_parts_are_added_and_removed() -> None:
    person = {"id": 2, "x": 1.0, "y": 1.0, "goals": [[2.0, 2.0]]}
    robot = {"task": {"start": [1.0, 2.0, 0.0], "goal": {"zone": "z"}}}
    text = changed(_TEXT, [
        Edit(["scenario", "crowd", "agents", 2], person),
        Edit(["scenario", "robots", "r"], robot),
    ])  # fmt: skip
    assert "- {id: 2, x: 1, y: 1, goals: [[2, 2]]}" in _lines(text)
    assert "r: {task: {start: [1, 2, 0], goal: {zone: z}}}" in " ".join(_lines(text))
    text = changed(text, [Edit(["scenario", "robots", "r"], None),
                          Edit(["scenario", "crowd", "agents", 0], None),
                          Edit(["scenario", "nothing", "there"], None)])  # fmt: skip
    assert "id: 0" not in text
    assert "nothing" not in text


@pytest.mark.parametrize(
    ("text", "path"),
    [
        ("a: [", ["a"]),
        ("- 1", ["a"]),
        ("a: 1", ["a", "b"]),
        ("a: [1]", ["a", 5]),
        ("a: [1]", ["a", "b"]),
        ("a: {csv: people.csv}", ["a", 0, "x"]),
        ("a: 1", []),
    ],
)
def test_what_cannot_be_changed_is_refused(text: str, path: list[str | int]) -> None:
    with pytest.raises(InputError):
        changed(text, [Edit(path, 2)])


def test_inherited_parts_are_removed_by_null() -> None:
    text = changed("crowdbot: 1\nscenario:\n  extends: base.yaml\n",
                   [Edit(["scenario", "environment", "walls", "a"], None)])  # fmt: skip
    assert "walls:" in text
    assert text.rstrip().endswith("a:")


def test_numbers_have_to_be_finite() -> None:
    with pytest.raises(InputError, match="finite"):
        changed(NEW.format(name="new"), [Edit(["scenario", "x"], float("nan"))])
