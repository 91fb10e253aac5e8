"""Path finding of people, chosen by ``kind``; straight by default.

The parameters of `mesh` are crowdbot's own choice; decision 0020 describes their effect.
"""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Ge
from pydantic import BeforeValidator, Field

from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.quantities import NonNegativeLength, PositiveDuration
from crowdbot.dsl.spec.spec import Spec


class Routing(Spec):
    """Path finding of people."""

    category: ClassVar[str] = "routing"
    #: The default kind of routing.
    usual: ClassVar[str] = "straight"
    kind: str = Field(description="Name of the routing.")


class StraightRouting(Routing):
    """Straight paths to the goal; obstacles are left to the crowd policy and to contact."""

    kind: Literal["straight"] = default("straight", "Name of the routing.")


class MeshRouting(Routing):
    """Shortest paths around walls and pillars, for each person's radius."""

    kind: Literal["mesh"] = default("mesh", "Name of the routing.")
    spread: NonNegativeLength = default(
        0.5,
        "Largest distance from a corner at which people pass it, drawn "
        "for each person, m; never more than the opening has room for.",
    )
    patience: PositiveDuration = default(
        5.0, "After this time without progress people look for another way, s."
    )
    detour: Annotated[float, Ge(1)] = default(
        1.5, "Largest length of another path, relative to the shortest."
    )


def _usual(value: Any) -> Any:
    return {"kind": Routing.usual, **value} if isinstance(value, dict) else value


#: One of the routings, or the default kind.
RoutingChoice = Annotated[
    Annotated[StraightRouting | MeshRouting, Field(discriminator="kind")],
    BeforeValidator(_usual),
]
