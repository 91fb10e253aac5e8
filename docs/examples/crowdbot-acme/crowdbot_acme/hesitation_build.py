"""Hesitation, computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from crowdbot.core.interfaces import References
from crowdbot.core.score import Score
from crowdbot.core.trajectory import Trajectories

from crowdbot_acme.hesitation import HESITATION, SIGNAL, HesitationSpec


@dataclass(frozen=True)
class Hesitation:
    """A logged value holds until the next one."""

    spec: HesitationSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Seconds, and share of the time, with the brake at or above the threshold."""
        del refs
        label = HESITATION.label
        if run.robot is None:
            return label.all_undefined("invalid_no_robot")
        signal = run.signals.get(SIGNAL)
        if signal is None or len(signal) < 2:
            return label.all_undefined("no_signal")
        t, brake = signal.T
        steps = np.diff(t)
        braked = float(steps[brake[:-1] >= self.spec.threshold].sum())
        return [
            label.ok("corrected", braked),
            label.ok("share", braked / float(steps.sum())),
        ]
