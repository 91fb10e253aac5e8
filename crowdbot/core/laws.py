"""Laws: what a variant of a metric promises about its values, and `crowdbot.testing` checks.

The defaults are what a sound metric keeps to anyway, so that only exceptions have to be declared.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

#: Changes of the point of view that leave a world as it is.
VIEWS = ("translate", "rotate", "reflect", "later", "permute")


@dataclass(frozen=True, slots=True, kw_only=True)
class Laws:
    """Promises about the values with status ``ok``.

    Attributes:
        least, most: bounds of the value, inclusive.
        whole: the value is an integer.
        itself: the value of a run that is its own reference; None: no promise.
        more_people: one person more never lowers the value (``up``), never raises it (``down``).
        finer: the same straight motion sampled twice as often: the value stays the ``same``,
            comes ``near`` (5 %), becomes ``double``, or nothing is promised (``free``).
        mass: all masses times c multiply the value by c to this power.
        exceptions: name of a view (`VIEWS`), or ``teleport``, -> why it may change the value.
    """

    least: float = -math.inf
    most: float = math.inf
    whole: bool = False
    itself: float | None = None
    more_people: Literal["up", "down", "free"] = "free"
    finer: Literal["same", "near", "double", "free"] = "near"
    mass: int = 0
    exceptions: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        unknown = set(self.exceptions) - {*VIEWS, "teleport"}
        if unknown:
            raise ValueError(f"laws: no such exception: {', '.join(sorted(unknown))}")
        if not self.least <= self.most:
            raise ValueError(f"laws: {self.least} to {self.most} is no range")
