"""The page of a person in a run, in one file."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.support.html_page import render_page

#: What the person does: drives a robot, or walks.
Mode = Literal["drive", "walk"]
_SCRIPTS = (
    "crowdbot.core.replay:script/element.js", "crowdbot.core.replay:script/decode.js",
    "crowdbot.core.replay:script/motion.js", "crowdbot.core.replay:script/gaps.js",
    "crowdbot.core.replay:script/colours.js",
    "crowdbot.core.replay:script/canvas.js", "crowdbot.core.replay:script/scenery.js",
    "crowdbot.core.replay:script/people.js", "crowdbot.core.replay:script/robots.js",
    "crowdbot.core.replay:script/sensors.js",
    "script/link.js", "script/latency.js", "script/keys.js", "script/pad.js", "script/gamepad.js",
    "script/hand.js", "script/live.js", "script/plan.js", "script/hud.js", "script/main.js",
)  # fmt: skip


def render_person_page(mode: Mode, scenario: str) -> str:
    """Return the page; it connects only to the server that it came from."""
    return render_page(
        __package__,
        scripts=_SCRIPTS,
        connect="'self'",
        mode=mode,
        scenario=scenario,
        verb="Drive" if mode == "drive" else "Walk",
    )
