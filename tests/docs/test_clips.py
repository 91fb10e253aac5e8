"""Thirty scenarios as small films: every clip moves, is on its page, and takes little room."""

from __future__ import annotations

import re

import pytest
from PIL import Image

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from scripts import make_clips


def test_the_page_shows_thirty_clips_that_are_there() -> None:
    text = make_clips.PAGE.read_text(encoding="utf-8")
    assert text == make_clips.page()
    shown = set(re.findall(r"images/clips/([\w-]+)\.webp", text))
    assert len(shown) == 30
    assert {p.stem for p in make_clips.FOLDER.glob("*")} == shown


def test_clips_move_and_are_small() -> None:
    for clip in make_clips.CLIPS:
        with Image.open(clip.file) as picture:
            assert getattr(picture, "n_frames", 1) > 8, clip.scenario
            assert picture.width == make_clips.WIDTH
    assert sum(clip.file.stat().st_size for clip in make_clips.CLIPS) <= make_clips.MOST


@pytest.mark.parametrize("suite", sorted({clip.suite for clip in make_clips.CLIPS}))
def test_scenarios_of_clips_exist(suite: str) -> None:
    known = {s.id for s in open_spec(suite, discover(allow=())).scenarios}
    assert {c.scenario for c in make_clips.CLIPS if c.suite == suite} <= known
