"""Scoring of agreement between user and shared control."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.plugin import Array, Commands, References, Score, Trajectories
from crowdbot.plugin.for_metrics import wrap
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, UndefinedError
from crowdbot.plugins.metrics.shared_control import AgreementSpec, FluencySpec, UserInputEntropySpec

#: Edges of the bins of prediction errors, in units of alpha (Nakayama et al. 1999).
EDGES = (0.5, 1.0, 2.5, 5.0)
#: Percentile of the absolute baseline errors that defines alpha.
PERCENTILE = 90.0
#: Tolerance of the bin edges, rad, and of the command times, s.
TOLERANCE = 1e-9
#: Command times more regular than this need no resampling, s.
REGULAR = 1e-6


class AgreementMetric(DeclaredMetric[AgreementSpec]):
    """Scores ``agreement`` in direction of the user's and the final commands.

    ``corrected``: by the angles of scaled commands; ``literal``: by arctan(v/w). Needs commands.
    Each counts for as long as it holds; standstill has no direction.
    """

    def _scores(self, _: Trajectories, refs: References) -> Sequence[Score]:
        c = refs.commands
        if c is None:
            raise UndefinedError("no_command")
        moves = [
            (np.abs(v) > self.spec.zero_tol) | (np.abs(w) > self.spec.zero_tol)
            for v, w in ((c.v_user, c.w_user), (c.v_sc, c.w_sc))
        ]
        used = np.where(moves[0] & moves[1], c.durations, 0.0)
        if used.sum() <= 0:
            raise UndefinedError("no_command")
        extras = {"coverage": float(used.sum() / c.durations.sum())}
        literal = self._principal(c.v_user, c.w_user) - self._principal(c.v_sc, c.w_sc)
        corrected = wrap(direction(c, c.v_user, c.w_user) - direction(c, c.v_sc, c.w_sc))
        return [
            self.factory.ok(variant, used @ (1.0 - np.abs(off) / np.pi) / used.sum(), extras)
            for variant, off in (("literal", literal), ("corrected", corrected))
        ]

    def _principal(self, v: Array, w: Array) -> Array:
        """Return arctan(v/w) in [-pi/2, pi/2], rad; opposite commands have the same angle."""
        turns = np.abs(w) > self.spec.zero_tol
        return np.where(turns, np.arctan(v / np.where(turns, w, 1.0)), np.sign(v) * (np.pi / 2.0))


class UserInputEntropy(DeclaredMetric[UserInputEntropySpec]):
    """Scores ``user_input_entropy``: steering entropy of the user's direction.

    Needs commands, and a baseline for the scale of the errors: on the scale of the drive itself
    the steadiest hand would have the largest entropy. ``literal`` is undefined, since the source
    gives no formula.
    """

    def _scores(self, _: Trajectories, refs: References) -> Sequence[Score]:
        literal = self.factory.undefined("literal", "no_formula_in_seed")
        if refs.commands is None:
            return [literal, self.factory.undefined("corrected", "no_command")]
        baseline = refs.commands_baseline
        if baseline is None:
            return [literal, self.factory.undefined("corrected", "no_baseline")]
        errors = [self._errors(c) for c in (refs.commands, baseline)]
        if errors[0] is None or errors[1] is None:
            return [literal, self.factory.undefined("corrected", "too_few_samples")]
        alpha = float(np.percentile(np.abs(errors[1]), PERCENTILE))
        extras = {"alpha": alpha}
        if alpha > self.spec.zero_tol:
            return [literal, self.factory.ok("corrected", entropy(errors[0], alpha), extras)]
        if np.all(np.abs(errors[0]) <= self.spec.zero_tol):
            return [literal, self.factory.ok("corrected", 0.0, extras)]
        return [literal, self.factory.undefined("corrected", "zero_alpha")]

    def _errors(self, c: Commands) -> Array | None:
        """Return errors of a second-order Taylor prediction, rad; None with too few angles."""
        theta = self._angles(c)
        if len(theta) < 4:
            return None
        first = np.diff(theta)
        expected = theta[2:-1] + first[1:-1] + 0.5 * np.diff(first)[:-1]
        errors: Array = theta[3:] - expected
        return errors

    def _angles(self, c: Commands) -> Array:
        """Return the user's direction in each period, unwrapped, rad.

        A zero command keeps the last one.
        """
        moves = (np.abs(c.v_user) > self.spec.zero_tol) | (np.abs(c.w_user) > self.spec.zero_tol)
        if not moves.any():
            return np.empty(0)
        start = int(np.argmax(moves))
        held = np.maximum.accumulate(np.where(moves, np.arange(len(moves)), 0))[start:]
        theta: Array = np.unwrap(direction(c, c.v_user, c.w_user)[held])
        t = c.t[start:]
        if np.all(np.abs(np.diff(t) - self.spec.sample_period) <= REGULAR):
            return theta
        count = int(np.floor((t[-1] - t[0] + REGULAR) / self.spec.sample_period)) + 1
        grid = t[0] + self.spec.sample_period * np.arange(count)
        held = np.searchsorted(t, grid + TOLERANCE, side="right") - 1
        return np.asarray(theta[held], dtype=np.float64)


class Fluency(DeclaredMetric[FluencySpec]):
    """Scores ``fluency``: ``literal``, raw differences; ``corrected``, scaled, the worse channel.

    Needs commands; compare only at the same command rate, except ``variation_rate``.
    """

    def _scores(self, _: Trajectories, refs: References) -> Sequence[Score]:
        c = refs.commands
        if c is None:
            raise UndefinedError("no_command")
        if len(c.t) < 2:
            raise UndefinedError("too_few_samples")
        dv, dw = np.diff(c.v_user), np.diff(c.w_user)
        channels = {
            "linear": float((1.0 - np.abs(dv) / c.v_max).mean()),
            "angular": float((1.0 - np.abs(dw) / c.w_max).mean()),
        }
        change = float(np.hypot(dv / c.v_max, dw / c.w_max).sum())
        return [
            self.factory.ok("literal", (1.0 - np.hypot(dv, dw)).mean()),
            self.factory.ok("corrected", min(channels.values()), channels),
            self.factory.ok("variation_rate", change / (c.t_end - float(c.t[0]))),
        ]


def direction(c: Commands, v: Array, w: Array) -> Array:
    """Return the angle of commands scaled by their limits, rad; forward is pi/2."""
    angle: Array = np.arctan2(v / c.v_max, w / c.w_max)
    return angle


def entropy(errors: Array, alpha: float) -> float:
    """Return the entropy of nine bins by size and sign, to base 9: 0 predictable, 1 not."""
    size = np.searchsorted(np.array(EDGES) * alpha - TOLERANCE, np.abs(errors), side="right")
    counts = np.bincount((np.sign(errors) * size).astype(np.int64) + len(EDGES))
    share = counts[counts > 0] / len(errors)
    return max(0.0, float(-(share @ np.log(share)) / np.log(2 * len(EDGES) + 1)))
