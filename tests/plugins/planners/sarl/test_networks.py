"""SARL and CADRL: values by hand, actions, and the whole way from a file to a run."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crowdbot
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.planning.weights.weights_file import npz_bytes
from crowdbot.core.registry.registry import discover
from crowdbot.errors import InputError, PlannerError
from crowdbot.plugins.planners.cadrl.cadrl_build import CadrlNetwork
from crowdbot.plugins.planners.sarl.sarl_build import SarlNetwork
from crowdbot.plugins.planners.shared.value_search_build import (
    ValueSearchRobot,
    actions,
    look_ahead,
)
from tests.paths import DATA

Weights = dict[str, np.ndarray[Any, Any]]


def _layers(part: str, *widths: int, rng: np.random.Generator) -> Weights:
    found: Weights = {}
    for n, (before, after) in enumerate(pairwise(widths)):
        found[f"{part}.{2 * n}.weight"] = rng.normal(size=(after, before)) / math.sqrt(before)
        found[f"{part}.{2 * n}.bias"] = rng.normal(size=after) * 0.1
    return found


def sarl_weights(seed: int = 0) -> Weights:
    rng = np.random.default_rng(seed)
    return {
        **_layers("mlp1", 13, 12, 8, rng=rng), **_layers("mlp2", 8, 6, 5, rng=rng),
        **_layers("attention", 16, 8, 1, rng=rng), **_layers("mlp3", 11, 9, 1, rng=rng),
    }  # fmt: skip


def _dense(weights: Weights, part: str, row: Any, *, last: bool = False) -> Any:
    numbers = sorted({int(n.split(".")[1]) for n in weights if n.startswith(f"{part}.")})
    for n in numbers:
        row = weights[f"{part}.{n}.weight"] @ row + weights[f"{part}.{n}.bias"]
        if n != numbers[-1] or last:
            row = np.maximum(row, 0.0)
    return row


def test_sarl_is_attention_over_people() -> None:
    weights, rng = sarl_weights(), np.random.default_rng(3)
    states = rng.normal(size=(4, 3, 13))
    states[:, :, :6] = states[:, :1, :6]
    wanted = []
    for people in states:
        codes = [_dense(weights, "mlp1", row, last=True) for row in people]
        mean = np.mean(codes, axis=0)
        scores = np.array([_dense(weights, "attention", np.r_[c, mean])[0] for c in codes])
        shares = np.exp(scores) / np.exp(scores).sum()
        summed = sum(s * _dense(weights, "mlp2", c) for s, c in zip(shares, codes, strict=True))
        wanted.append(_dense(weights, "mlp3", np.r_[people[0, :6], summed])[0])
    found = SarlNetwork(weights, "w").values(states.astype(np.float32))
    np.testing.assert_allclose(found, wanted, rtol=2e-5, atol=2e-6)
    turned = SarlNetwork(weights, "w").values(states[:, ::-1].astype(np.float32))
    np.testing.assert_allclose(turned, found, rtol=2e-5, atol=2e-6)


def test_cadrl_takes_the_worst_pair() -> None:
    rng = np.random.default_rng(1)
    weights = _layers("value_network", 13, 10, 1, rng=rng)
    states = rng.normal(size=(2, 3, 13))
    each = [[_dense(weights, "value_network", row)[0] for row in people] for people in states]
    found = CadrlNetwork(weights, "w").values(states.astype(np.float32))
    np.testing.assert_allclose(found, np.min(each, axis=1), rtol=1e-5)


def test_actions_are_those_of_the_source() -> None:
    found = actions(1.0, 5, 16, unicycle=False)
    assert found.shape == (81, 2)
    speeds = (np.exp([0.2, 0.4, 0.6, 0.8, 1.0]) - 1.0) / (math.e - 1.0)
    np.testing.assert_allclose(found[1:6, 0], speeds)
    assert found[5, 0] == pytest.approx(1.0)
    assert found[6, 1] == pytest.approx(math.pi / 8.0)
    turned = actions(1.0, 5, 16, unicycle=True)
    assert turned[1, 1] == pytest.approx(-math.pi / 4.0)
    assert turned[-1, 1] == pytest.approx(math.pi / 4.0)


def test_the_look_ahead_turns_to_the_goal_and_rewards() -> None:
    robot = ValueSearchRobot(0.0, 0.0, 0.0, 0.3, 0.0, 4.0, 1.0)  # the goal is on the left
    choices = np.array([[0.0, 0.0], [1.0, 0.5 * math.pi]])
    people = np.array([[1.0, 1.0, 0.0, -1.0, 0.3]])
    states, rewards = np.zeros((2, 1, 13), dtype=np.float32), np.zeros(2)
    look_ahead(robot, choices, people, (0.25, 0.2), False, states, rewards)
    stays = [4.0, 1.0, 0.0, 0.3, 0.0, 0.0, 1.0, -1.0, -1.0, 0.0, 0.3, math.sqrt(2.0), 0.6]
    np.testing.assert_allclose(states[0, 0], stays, atol=1e-6)
    np.testing.assert_allclose(states[1, 0, :6], [3.75, 1.0, 0.0, 0.3, 1.0, 0.0], atol=1e-6)
    assert rewards.tolist() == [0.0, 0.0]
    for place, reward in ((0.7, (0.1 - 0.2) * 0.5 * 0.25), (0.5, -0.25)):
        people[0, :2] = place, 0.0
        look_ahead(robot, choices, people, (0.25, 0.2), False, states, rewards)
        assert rewards[0] == pytest.approx(reward)
    near = robot._replace(goal_y=0.4)
    people[0, :2] = 3.0, 3.0
    look_ahead(near, choices, people, (0.25, 0.2), False, states, rewards)
    assert rewards.tolist() == [0.0, 1.0]


@pytest.mark.parametrize(
    ("changed", "expected"),
    [
        ({"lstm.0.weight": np.zeros((1, 1))}, "those of this planner are attention, mlp1"),
        ({"mlp1.0.weight": np.zeros((12, 61))}, "takes 61 numbers, not 13"),
        ({"mlp2.0.weight": np.zeros((6, 9))}, "mlp2"),
        ({"mlp3.2.bias": np.array([math.nan])}, "not finite"),
        ({"mlp3.2.bias": np.zeros(2)}, "layer 2 of 'mlp3'"),
        ({"mlp3.x.bias": np.zeros(2)}, "not numbered"),
        ({"mlp3.4.bias": np.zeros(2)}, "lacks its weight or bias"),
    ],
)
def test_other_networks_are_refused(changed: Weights, expected: str) -> None:
    with pytest.raises(InputError, match=expected):
        SarlNetwork({**sarl_weights(), **changed}, "w.npz")


@pytest.fixture
def weights_file(tmp_path: Path) -> Path:
    file = tmp_path / "sarl.npz"
    file.write_bytes(npz_bytes(sarl_weights()))
    return file


def test_weights_are_part_of_the_planner_by_content(weights_file: Path, tmp_path: Path) -> None:
    registry = discover()
    one = resolve_planner("sarl", registry, [f"weights={weights_file}"])
    (tmp_path / "else").mkdir()
    copy = tmp_path / "else" / "sarl.npz"
    copy.write_bytes(weights_file.read_bytes())
    document = tmp_path / "else" / "mine.yaml"
    document.write_text("kind: sarl\nweights: sarl.npz\n")
    two = resolve_planner(str(document), registry)
    assert one.spec_dump == two.spec_dump
    assert one.spec_dump["weights"]["path"] == "sarl.npz"
    assert list(one.files) == [one.spec_dump["weights"]["sha256"]]
    copy.write_bytes(npz_bytes(sarl_weights(1)))
    assert resolve_planner(str(document), registry).label != one.label
    with pytest.raises(PlannerError, match="its content differs"):
        two.build()
    with pytest.raises(InputError, match="did you mean"):
        resolve_planner("sarl", registry, [f"weights={tmp_path / 'sarl.npx'}"])


def test_a_run_keeps_its_weights_in_either_process(weights_file: Path, tmp_path: Path) -> None:
    scenario = crowdbot.load(DATA / "short_way.yaml", "short-way")

    def run(folder: str, *, in_process: bool) -> crowdbot.Run:
        return crowdbot.simulate(
            scenario, planner="sarl", planner_settings={"weights": str(weights_file)},
            out=tmp_path / folder, references=False, replay=False, in_process=in_process,
            metrics=["success"], record="none",
        )  # fmt: skip

    inside, own = run("a", in_process=True), run("b", in_process=False)
    assert inside.record.hashes.trajectory == own.record.hashes.trajectory
    kept = list((tmp_path / "a" / "planner_files").iterdir())
    assert [k.read_bytes() for k in kept] == [weights_file.read_bytes()]
