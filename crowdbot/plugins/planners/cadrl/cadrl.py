"""CADRL: takes the action with the best value of the worst pair of robot and person."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from crowdbot.plugin import Component
from crowdbot.plugins.planners.shared.learned import ValueSearchSpec


class CadrlSpec(ValueSearchSpec):
    """Uses a file of weights given by the user; crowdbot ships none."""

    kind: Literal["cadrl"] = "cadrl"


#: Weights of the right shapes that were never trained, for the conformance checks.
_UNTRAINED = Path(__file__).with_name("untrained.npz")

CADRL = Component(
    spec=CadrlSpec,
    examples=({"weights": str(_UNTRAINED)},),
    summary="value network of pairs, weights from a file (Chen, Liu, Everett, How 2017)",
)
