"""CADRL: the action after which the worst pair of robot and person is valued most."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from crowdbot.plugin import Component
from crowdbot.plugins.planners.shared.learned import ValueSearchSpec


class CadrlSpec(ValueSearchSpec):
    """Runs weights that the user names; crowdbot ships none."""

    kind: Literal["cadrl"] = "cadrl"


#: Weights of the right shapes that were never trained, for the conformance checks.
_UNTRAINED = Path(__file__).with_name("untrained.npz")

CADRL = Component(
    spec=CadrlSpec,
    examples=({"weights": str(_UNTRAINED)},),
    summary="value network of pairs, weights from a file (Chen, Liu, Everett, How 2017)",
)
