"""Build the web page, one file, on which a person drives or walks."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.replay.three import three_packed, three_source
from crowdbot.core.support.html_page import Allowed, render_page

#: What the person does: drives a robot, or walks.
Mode = Literal["drive", "walk"]
#: Scripts of the replay page that this page shares, and its own.
_SHARED = (
    "element", "decode", "motion", "gaps", "colours", "canvas", "scenery", "people", "robots",
    "sensors", "thoughts", "pointers", "solid_load", "solid_place", "solid_figures", "solid_bodies",
    "solid_people", "solid_robots", "solid_marks", "solid_signs", "solid_eye", "solid",
    "solid_xr",
)  # fmt: skip
_OWN = (
    "link", "latency", "keys", "pad", "gamepad", "hand", "live", "plan", "eyes", "hud", "main",
)  # fmt: skip


def render_person_page(mode: Mode, scenario: str) -> str:
    """Return the page; it connects only to the server that it came from."""
    return render_page(
        __package__,
        scripts=[
            *(f"crowdbot.core.replay:script/{name}.js" for name in _SHARED),
            *(f"script/{name}.js" for name in _OWN),
        ],
        styles=("crowdbot.core.replay:base.css", "page.css"),
        allowed=Allowed(connect="'self'", later=(three_source(),)),
        three=three_packed(),
        mode=mode,
        scenario=scenario,
        verb="Drive" if mode == "drive" else "Walk",
    )
