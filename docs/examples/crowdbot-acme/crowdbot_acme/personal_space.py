"""Personal space: one cost function, compiled and as numpy."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge
from crowdbot.plugin import Component, CostFunctionSpec, PositiveDuration, PositiveLength, Range
from pydantic import Field


class PersonalSpaceSpec(CostFunctionSpec):
    """``|u - preferred|`` and, for each neighbour, ``exp(-gap / fade)`` with the gap ``ahead``."""

    kind: Literal["acme.personal_space"] = "acme.personal_space"
    weight: Annotated[float, Ge(0)] = Field(default=1.0, description="Factor of the cost.")
    range: Range = Field(default=Range(value=3.0), description="Which neighbours count.")
    ahead: PositiveDuration = Field(default=1.0, description="When the gap is looked at, s.")
    fade: PositiveLength = Field(default=0.4, description="The cost falls to 1/e over this, m.")


class PersonalSpaceNumpySpec(PersonalSpaceSpec):
    """The same without compiled code: slower, shorter to write."""

    kind: Literal["acme.personal_space_numpy"] = "acme.personal_space_numpy"  # type: ignore[assignment]


PERSONAL_SPACE = Component(
    spec=PersonalSpaceSpec,
    build="crowdbot_acme.personal_space_build:build",
    summary="keeps a distance to where others will be",
)
PERSONAL_SPACE_NUMPY = Component(
    spec=PersonalSpaceNumpySpec,
    build="crowdbot_acme.personal_space_numpy_build:build",
    summary="keeps a distance to where others will be, as numpy",
)
