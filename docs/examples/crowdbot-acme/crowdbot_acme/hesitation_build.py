"""Hesitation, computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from crowdbot.plugin import References, Score, ScoreFactory, Trajectories

from crowdbot_acme.hesitation import HESITATION, SIGNAL, HesitationSpec


@dataclass(frozen=True)
class Hesitation:
    """A logged value holds until the next one."""

    spec: HesitationSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Seconds, and share of the time, with the brake at or above the threshold."""
        del refs
        factory = ScoreFactory(HESITATION)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        signal = run.signals.get(SIGNAL)
        if signal is None or len(signal) < 2:
            return factory.all_undefined("no_signal")
        t, brake = signal.T
        steps = np.diff(t)
        braked = float(steps[brake[:-1] >= self.spec.threshold].sum())
        return [
            factory.ok("corrected", braked),
            factory.ok("share", braked / float(steps.sum())),
        ]
