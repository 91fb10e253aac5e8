"""SARL: takes the action after which an attention network values the situation most."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from crowdbot.plugin import Component
from crowdbot.plugins.planners.shared.learned import ValueSearchSpec


class SarlSpec(ValueSearchSpec):
    """Runs weights that the user names; crowdbot ships none."""

    kind: Literal["sarl"] = "sarl"


#: Weights of the right shapes that were never trained, for the conformance checks.
_UNTRAINED = Path(__file__).with_name("untrained.npz")

SARL = Component(
    spec=SarlSpec,
    examples=({"weights": str(_UNTRAINED)},),
    summary="value network with attention among people, weights from a file (Chen et al. 2019)",
)
