"""Adversaries: each tries to gain from a score without driving well.

`crowdbot audit --adversaries` checks that none is certified ahead of careful planners.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from crowdbot.plugin import Component, NonNegativeDuration, PlannerRole, PlannerSpec, default

_BUILD = "crowdbot.plugins.planners.adversaries.adversaries_build"


class AdversarySpec(PlannerSpec):
    """Base of the adversaries, which steer by lidar."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)


class BullySpec(AdversarySpec):
    """Drives straight on, and brakes only where the rule of fault requires it."""

    kind: Literal["bully"] = "bully"


class WallBullySpec(AdversarySpec):
    """A bully along the edge of the goal zone, where few people walk."""

    kind: Literal["wall_bully"] = "wall_bully"


class NeverAsideSpec(AdversarySpec):
    """Waits for people in its straight path, and never evades."""

    kind: Literal["never_aside"] = "never_aside"


class ShieldSpec(AdversarySpec):
    """Follows closely behind the nearest person ahead, who clears the path."""

    kind: Literal["shield"] = "shield"


class StrobeSpec(AdversarySpec):
    """Alternates between full speed and rest, so that people stop and let it pass."""

    kind: Literal["strobe"] = "strobe"


class CurtseySpec(AdversarySpec):
    """Slows down for a moment when people come near, then drives at them."""

    kind: Literal["curtsey"] = "curtsey"


class LaneWaiterSpec(AdversarySpec):
    """Rests until several metres ahead are free, then dashes."""

    kind: Literal["lane_waiter"] = "lane_waiter"


class CreepSpec(AdversarySpec):
    """Pushes people aside at a speed below that of the rule of fault."""

    kind: Literal["creep"] = "creep"


class ReverseSpec(AdversarySpec):
    """Drives backwards, so that its front touches no one."""

    kind: Literal["reverse"] = "reverse"


class WeaveSpec(AdversarySpec):
    """Drives in serpentines, which make people keep away."""

    kind: Literal["weave"] = "weave"


class ParkSpec(AdversarySpec):
    """Parks beside its start, where it bothers no one."""

    needs: ClassVar[tuple[str, ...]] = ()
    kind: Literal["park"] = "park"


class QuitterSpec(AdversarySpec):
    """Drives well until the first person is near, then stops for good."""

    kind: Literal["quitter"] = "quitter"


class GapRushSpec(AdversarySpec):
    """Rushes into the widest gap, whether or not people walk into it."""

    kind: Literal["gap_rush"] = "gap_rush"


class LateStartSpec(AdversarySpec):
    """Waits at the start until most people have passed, then drives blindly."""

    kind: Literal["late_start"] = "late_start"


class DrawReplaySpec(AdversarySpec):
    """Recognises published crowds, and drives blindly with a start time that worked for them."""

    kind: Literal["draw_replay"] = "draw_replay"
    memory: dict[Annotated[str, Field(max_length=32)], NonNegativeDuration] = default(
        {}, "Fingerprint of the first scan -> delay that worked, s."
    )


def _adversary(spec: type[AdversarySpec], summary: str) -> Component[AdversarySpec]:
    name = spec.__name__.removesuffix("Spec")
    return Component(spec=spec, build=f"{_BUILD}:{name}", summary=summary)


BULLY = _adversary(
    BullySpec, "drives straight on, and brakes only where the rule of fault asks for it"
)
WALL_BULLY = _adversary(
    WallBullySpec, "a bully along the edge of the goal zone, where few people walk"
)
NEVER_ASIDE = _adversary(
    NeverAsideSpec, "waits for people on its straight way, and never goes aside"
)
SHIELD = _adversary(
    ShieldSpec, "follows the nearest person ahead at a hand's breadth, who clears the way"
)
STROBE = _adversary(
    StrobeSpec, "alternates between full speed and rest, so that people stop and let it pass"
)
CURTSEY = _adversary(
    CurtseySpec, "slows down for a moment when people come near, then drives at them"
)
LANE_WAITER = _adversary(LaneWaiterSpec, "rests until several metres ahead are free, then dashes")
CREEP = _adversary(
    CreepSpec, "creeps at people more slowly than a fault needs, and pushes them aside"
)
REVERSE = _adversary(ReverseSpec, "drives backwards, so that its front touches no one")
WEAVE = _adversary(WeaveSpec, "drives in serpentines, which make people keep away")
PARK = _adversary(ParkSpec, "parks beside its start, where it bothers no one")
QUITTER = _adversary(QuitterSpec, "drives well until the first person is near, then stops for good")
GAP_RUSH = _adversary(GapRushSpec, "rushes into the widest gap, whether or not people walk into it")
LATE_START = _adversary(
    LateStartSpec, "waits at the start until most people have passed, then drives blindly"
)
DRAW_REPLAY = _adversary(
    DrawReplaySpec, "remembers published crowds, and drives blindly at a time at which it worked"
)
