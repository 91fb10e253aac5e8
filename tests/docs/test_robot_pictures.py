"""The pictures of robots in the docs are those of the robots."""

from __future__ import annotations

import pytest

from scripts.draw_robots import FOLDER, KINDS, picture


@pytest.mark.parametrize("kind", KINDS)
def test_the_picture_shows_the_robot_of_today(kind: str) -> None:
    text = (FOLDER / f"{kind}.svg").read_text(encoding="utf-8")
    assert text == picture(kind), "run scripts/draw_robots.py"
