"""CADRL: a value network of one robot and one person; with several people the least value counts.

Chen, Liu, Everett, How, "Decentralized non-communicating multiagent collision avoidance with deep
reinforcement learning", ICRA 2017, in the form of CrowdNav (Chen et al., ICRA 2019).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import Array, read_weights
from crowdbot.plugins.planners.cadrl.cadrl import CadrlSpec
from crowdbot.plugins.planners.shared.learned_planner_build import LearnedPlanner
from crowdbot.plugins.planners.shared.perceptron_build import (
    Perceptron,
    Singles,
    check_names,
    check_widths,
)
from crowdbot.plugins.planners.shared.value_search_build import OF_PAIR


class CadrlNetwork:
    """Values of joint states; arguments and errors as in `SarlNetwork`."""

    def __init__(self, weights: Mapping[str, Array], where: str) -> None:
        check_names(weights, ("value_network",), where)
        self._value = Perceptron(weights, "value_network", where)
        check_widths(where, ("value_network", self._value.width_in, OF_PAIR))

    def values(self, states: Singles) -> Singles:
        """Return the value (A,) of each joint state (A, N, 13): that of the worst pair."""
        pairs = self._value(states.reshape(-1, OF_PAIR))
        return np.asarray(pairs[:, 0].reshape(states.shape[:2]).min(axis=1))


def build(spec: CadrlSpec) -> LearnedPlanner:
    """Build a planner from its spec."""
    where = str(spec.weights.file)
    return LearnedPlanner(spec, CadrlNetwork(read_weights(where), spec.weights.path))
