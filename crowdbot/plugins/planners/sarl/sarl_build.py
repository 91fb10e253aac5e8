"""SARL: a value network with attention among people.

Chen, Liu, Kreiss, Alahi, "Crowd-robot interaction: crowd-aware robot navigation with
attention-based deep reinforcement learning", ICRA 2019.

Each person is encoded together with the robot; attention from a person's code and the mean of all
codes weighs the people; the value is that of the robot and the weighted sum.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import Array, read_weights
from crowdbot.plugins.planners.sarl.sarl import SarlSpec
from crowdbot.plugins.planners.shared.learned_planner_build import LearnedPlanner
from crowdbot.plugins.planners.shared.perceptron_build import (
    Perceptron,
    Singles,
    check_names,
    check_widths,
)
from crowdbot.plugins.planners.shared.value_search_build import OF_PAIR, OF_ROBOT


class SarlNetwork:
    """Computes values of joint states of robot and people.

    Args:
        weights: name -> weights, as in the ``state_dict`` of the authors' `ValueNetwork`.
        where: the file, for messages.

    Raises:
        InputError: weights are missing, unknown, or have other shapes.
    """

    def __init__(self, weights: Mapping[str, Array], where: str) -> None:
        parts = ("mlp1", "mlp2", "attention", "mlp3")
        check_names(weights, parts, where)
        one, two, attention, three = (Perceptron(weights, part, where) for part in parts)
        self._each, self._features, self._attention, self._value = one, two, attention, three
        # attention sees a person's code alone, or beside the mean of all
        self._with_mean = attention.width_in == 2 * one.width_out
        width = one.width_out * (2 if self._with_mean else 1)
        check_widths(
            where,
            ("mlp1", one.width_in, OF_PAIR),
            ("mlp2", two.width_in, one.width_out),
            ("attention", attention.width_in, width),
            ("mlp3", three.width_in, OF_ROBOT + two.width_out),
        )

    def values(self, states: Singles) -> Singles:
        """Return the value of each joint state (A,).

        Args:
            states: (A, N, 13) of A actions and N people.
        """
        actions, people, _ = states.shape
        codes = self._each(states.reshape(-1, OF_PAIR), last=True)
        seen = codes
        if self._with_mean:
            mean = codes.reshape(actions, people, -1).mean(axis=1)
            seen = np.concatenate([codes, np.repeat(mean, people, axis=0)], axis=1)
        scores = self._attention(seen).reshape(actions, people)
        shares = np.exp(scores) * (scores != 0.0)
        shares = shares / shares.sum(axis=1, keepdims=True)
        features = self._features(codes).reshape(actions, people, -1)
        summed = np.einsum("an,anf->af", shares, features)
        joint = np.concatenate([states[:, 0, :OF_ROBOT], summed], axis=1)
        return np.asarray(self._value(joint)[:, 0])


def build(spec: SarlSpec) -> LearnedPlanner:
    """Build a planner from its spec."""
    where = str(spec.weights.file)
    return LearnedPlanner(spec, SarlNetwork(read_weights(where), spec.weights.path))
