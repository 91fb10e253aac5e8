"""CADRL: the action after which the worst pair of robot and person is valued most."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component
from crowdbot.plugins.planners.shared.learned import ValueSearchSpec


class CadrlSpec(ValueSearchSpec):
    """Runs weights that the user names; crowdbot ships none."""

    kind: Literal["cadrl"] = "cadrl"


CADRL = Component(
    spec=CadrlSpec,
    build="crowdbot.plugins.planners.cadrl.cadrl_build:build",
    summary="value network of pairs, weights from a file (Chen, Liu, Everett, How 2017)",
)
