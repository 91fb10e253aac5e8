"""Adversaries: each tries to gain from a score without driving well.

`crowdbot audit --adversaries` checks that none is certified ahead of careful planners.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from crowdbot.plugin import Component, NonNegativeDuration, PlannerRole, PlannerSpec

_BUILD = "crowdbot.plugins.planners.adversaries.adversaries_build"


class BullySpec(PlannerSpec):
    """Drives straight on, and brakes only where the rule of fault requires it."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["bully"] = "bully"


class WallBullySpec(PlannerSpec):
    """A bully along the edge of the goal zone, where few people walk."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["wall_bully"] = "wall_bully"


class NeverAsideSpec(PlannerSpec):
    """Waits for people in its straight path, and never evades."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["never_aside"] = "never_aside"


class ShieldSpec(PlannerSpec):
    """Follows closely behind the nearest person ahead, who clears the path."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["shield"] = "shield"


class StrobeSpec(PlannerSpec):
    """Alternates between full speed and rest, so that people stop and let it pass."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["strobe"] = "strobe"


class CurtseySpec(PlannerSpec):
    """Slows down for a moment when people come near, then drives at them."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["curtsey"] = "curtsey"


class LaneWaiterSpec(PlannerSpec):
    """Rests until several metres ahead are free, then dashes."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["lane_waiter"] = "lane_waiter"


class CreepSpec(PlannerSpec):
    """Pushes people aside at a speed below that of the rule of fault."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["creep"] = "creep"


class ReverseSpec(PlannerSpec):
    """Drives backwards, so that its front touches no one."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["reverse"] = "reverse"


class WeaveSpec(PlannerSpec):
    """Drives in serpentines, which make people keep away."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["weave"] = "weave"


class ParkSpec(PlannerSpec):
    """Parks beside its start, where it bothers no one."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ()

    kind: Literal["park"] = "park"


class QuitterSpec(PlannerSpec):
    """Drives well until the first person is near, then stops for good."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["quitter"] = "quitter"


class GapRushSpec(PlannerSpec):
    """Rushes into the widest gap, whether or not people walk into it."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["gap_rush"] = "gap_rush"


class LateStartSpec(PlannerSpec):
    """Waits at the start until most people have passed, then drives blindly."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["late_start"] = "late_start"


class DrawReplaySpec(PlannerSpec):
    """Recognises published crowds, and drives blindly with a start time that worked for them."""

    role: ClassVar[PlannerRole] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["draw_replay"] = "draw_replay"
    memory: dict[Annotated[str, Field(max_length=32)], NonNegativeDuration] = Field(
        default={}, description="Fingerprint of the first scan -> delay that worked, s."
    )


BULLY = Component(
    spec=BullySpec,
    build=f"{_BUILD}:build_bully",
    summary="drives straight on, and brakes only where the rule of fault asks for it",
)
WALL_BULLY = Component(
    spec=WallBullySpec,
    build=f"{_BUILD}:build_wall_bully",
    summary="a bully along the edge of the goal zone, where few people walk",
)
NEVER_ASIDE = Component(
    spec=NeverAsideSpec,
    build=f"{_BUILD}:build_never_aside",
    summary="waits for people on its straight way, and never goes aside",
)
SHIELD = Component(
    spec=ShieldSpec,
    build=f"{_BUILD}:build_shield",
    summary="follows the nearest person ahead at a hand's breadth, who clears the way",
)
STROBE = Component(
    spec=StrobeSpec,
    build=f"{_BUILD}:build_strobe",
    summary="alternates between full speed and rest, so that people stop and let it pass",
)
CURTSEY = Component(
    spec=CurtseySpec,
    build=f"{_BUILD}:build_curtsey",
    summary="slows down for a moment when people come near, then drives at them",
)
LANE_WAITER = Component(
    spec=LaneWaiterSpec,
    build=f"{_BUILD}:build_lane_waiter",
    summary="rests until several metres ahead are free, then dashes",
)
CREEP = Component(
    spec=CreepSpec,
    build=f"{_BUILD}:build_creep",
    summary="creeps at people more slowly than a fault needs, and pushes them aside",
)
REVERSE = Component(
    spec=ReverseSpec,
    build=f"{_BUILD}:build_reverse",
    summary="drives backwards, so that its front touches no one",
)
WEAVE = Component(
    spec=WeaveSpec,
    build=f"{_BUILD}:build_weave",
    summary="drives in serpentines, which make people keep away",
)
PARK = Component(
    spec=ParkSpec,
    build=f"{_BUILD}:build_park",
    summary="parks beside its start, where it bothers no one",
)
QUITTER = Component(
    spec=QuitterSpec,
    build=f"{_BUILD}:build_quitter",
    summary="drives well until the first person is near, then stops for good",
)
GAP_RUSH = Component(
    spec=GapRushSpec,
    build=f"{_BUILD}:build_gap_rush",
    summary="rushes into the widest gap, whether or not people walk into it",
)
LATE_START = Component(
    spec=LateStartSpec,
    build=f"{_BUILD}:build_late_start",
    summary="waits at the start until most people have passed, then drives blindly",
)
DRAW_REPLAY = Component(
    spec=DrawReplaySpec,
    build=f"{_BUILD}:build_draw_replay",
    summary="remembers published crowds, and drives blindly at a time at which it worked",
)
