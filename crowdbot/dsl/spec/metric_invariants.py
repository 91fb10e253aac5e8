"""MetricInvariants: properties of every value of a metric, checked by `crowdbot.testing`.

The defaults hold for any sound metric, so only differences are declared.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, TypedDict

from crowdbot.errors import did_you_mean, nearest

#: Transformations of a run that do not change its events.
SYMMETRIES = ("translate", "rotate", "reflect", "shift_time", "permute")
#: Names allowed in `MetricInvariants.changes_with`.
CHANGES = (*SYMMETRIES, "teleport")

#: An additional person never lowers the value (``up``), never raises it (``down``), or either.
Monotony = Literal["up", "down", "free"]
#: At twice the sampling rate the value stays, stays within 5 %, doubles, or changes freely.
Refinement = Literal["same", "near", "double", "free"]


@dataclass(frozen=True, slots=True, kw_only=True)
class MetricInvariants:
    """Properties of the values with status ``ok`` of one variant of a metric.

    Attributes:
        minimum, maximum: bounds of the value, inclusive.
        integer: the value is a whole number.
        self_value: the value of a run that is its own reference; None: any.
        more_people: an additional person never lowers the value (``up``), never raises it
            (``down``), or either (``free``).
        refinement: the same straight motion sampled twice as often: the value stays the ``same``,
            comes ``near`` (5 %), becomes ``double``, or changes freely (``free``).
        mass_exponent: all masses times c multiply the value by c to this power.
        changes_with: name of a symmetry (`SYMMETRIES`), or ``teleport``, -> reason why it may
            change the value.

    Raises:
        ValueError: no value can satisfy them, or there is no such symmetry.
    """

    minimum: float = -math.inf
    maximum: float = math.inf
    integer: bool = False
    self_value: float | None = None
    more_people: Monotony = "free"
    refinement: Refinement = "near"
    mass_exponent: int = 0
    changes_with: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in self.changes_with:
            if name not in CHANGES:
                hint = did_you_mean(nearest(name, CHANGES))
                raise ValueError(f"changes_with: no symmetry is called '{name}'{hint}")
        if not self.minimum <= self.maximum:
            raise ValueError(f"minimum {self.minimum} is not below maximum {self.maximum}")


class InvariantOptions(TypedDict, total=False):
    """Some fields of `MetricInvariants`, as arguments of `declare_metric`."""

    minimum: float
    maximum: float
    integer: bool
    self_value: float | None
    more_people: Monotony
    refinement: Refinement
    mass_exponent: int
    changes_with: Mapping[str, str]
