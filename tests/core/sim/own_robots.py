"""The robots of the how-to, with crowdbot's own, in the diagrams of `sim_worlds`."""

from __future__ import annotations

from functools import cache

from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.robots.build import build_model
from crowdbot.plugin import RobotModel
from tests.paths import ROOT

HOWTO = ROOT / "docs" / "howto" / "files"


@cache
def known() -> Registry:
    """All installed components and the how-to's robots."""
    return discover(extra=[HOWTO / "my_robots"])


def model(kind: str) -> RobotModel:
    """A robot with its defaults."""
    return build_model(known(), known().find("robot", kind).spec(kind=kind))
