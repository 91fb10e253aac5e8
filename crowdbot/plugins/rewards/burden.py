"""Reward of progress, less the burden on people."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component, default
from crowdbot.plugins.rewards.progress import Amount, ProgressSpec


class BurdenSpec(ProgressSpec):
    """``progress``, less the work that people need to keep half a metre from the robot.

    The work is the quantity of the score of burden, ``push_work.rate``.
    """

    kind: Literal["burden"] = "burden"  # type: ignore[assignment]
    work: Amount = default(0.01, "Taken off for each joule, 1/J.")


BURDEN = Component(spec=BurdenSpec, summary="progress that demands little of people")
