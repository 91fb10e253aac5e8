"""agreement, user_input_entropy, fluency, questionnaires: hand cases and failures."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import ArrayLike

from crowdbot.core.trajectories.commands import Commands
from crowdbot.core.trajectories.questionnaires import TLX_SCALES, Questionnaires
from crowdbot.core.types.score import Score
from crowdbot.errors import InputError
from crowdbot.plugins.metrics.shared_control_build import entropy
from tests.plugins.metrics.scenes import scores_of, value_of, values, why


def drive(
    v: ArrayLike,
    w: ArrayLike,
    v_sc: ArrayLike | None = None,
    w_sc: ArrayLike | None = None,
    *,
    dt: float = 0.15,
    v_max: float = 1.0,
    w_max: float = 2.0,
    **more: Any,
) -> Commands:
    v, w = np.broadcast_arrays(np.asarray(v, float), np.asarray(w, float))
    t = dt * np.arange(len(v))
    sc = {"v_sc": v if v_sc is None else v_sc, "w_sc": w if w_sc is None else w_sc}
    final = {name: np.broadcast_to(np.asarray(s, float), v.shape) for name, s in sc.items()}
    given: dict[str, Any] = {"t": t, "v_user": v, "w_user": w, **final, **more}
    return Commands.from_arrays(**given, v_max=v_max, w_max=w_max)


def of(metric: str, commands: Commands | None, **more: Any) -> dict[str, Score]:
    return scores_of(metric, None, commands=commands, **more)


ONES = np.ones(42)


# ---------------------------------------------------------------------- agreement
@pytest.mark.parametrize(
    ("user", "final", "literal", "corrected"),
    [
        pytest.param((1, 0.5), (1, 0.5), 1, 1, id="h01"),
        pytest.param((1, 1), (-1, -1), 1, 0, id="h02"),
        pytest.param((1, 0), (0, 2), 0.5, 0.5, id="h03"),
        pytest.param((1, 0), (-1, 0), 0, 0, id="forwards and backwards"),
        pytest.param((0, 1), (0, -1), 1, 0, id="left and right"),
        pytest.param((1, 2), (1, -2), 1 - 2 * math.atan(0.5) / math.pi, 0.5, id="scaled"),
        pytest.param((-1, -0.1), (-1, 0.1), None, 1 - 2 * math.atan(0.05) / math.pi, id="wrap"),
        pytest.param((-0.1, -2), (0.1, -2), None, 1 - 2 * math.atan(0.1) / math.pi, id="seam"),
    ],
)
def test_agreement(
    user: tuple[float, float], final: tuple[float, float], literal: float | None, corrected: float
) -> None:
    found = of("agreement", drive(user[0] * ONES, user[1] * ONES, *final))
    assert value_of(found) == pytest.approx(corrected)
    if literal is not None:
        assert value_of(found, "literal") == pytest.approx(literal)
    swapped = of("agreement", drive(final[0] * ONES, final[1] * ONES, *user))
    assert value_of(swapped) == pytest.approx(corrected)


def test_half_of_the_time_apart() -> None:  # h04
    late = np.arange(42) >= 20
    commands = drive(ONES, 0 * ONES, 1, np.where(late, 2.0, 0.0))
    assert value_of(of("agreement", commands)) == pytest.approx((20 + 21 * 0.75) / 41)


def test_each_command_counts_as_long_as_it_holds() -> None:
    given: dict[str, Any] = {"v_user": [1, 1, 1], "w_user": [0, 0, 0], "w_sc": [0, 0, 0]}
    commands = Commands.from_arrays(
        t=[0, 1, 4], v_sc=[1, -1, 1], **given, v_max=1, w_max=1, t_end=10.0
    )
    found = of("agreement", commands)
    assert value_of(found) == pytest.approx((1 + 6) / 10)
    commands = Commands.from_arrays(t=[0, 1, 4], v_sc=[1, -1, 0], **given, v_max=1, w_max=1)
    assert value_of(of("agreement", commands)) == pytest.approx(1 / 4)


def test_who_commands_nothing_neither_agrees_nor_disagrees() -> None:
    commands = drive([1, 0, 1, 1, 1], [0, 0, 0, 0, 0], [1, 1, 0, -1, 1])
    found = of("agreement", commands)
    assert value_of(found) == pytest.approx(0.5)
    assert found["corrected"].extras["coverage"] == pytest.approx(0.5)
    assert why(of("agreement", drive(0 * ONES, 0 * ONES))) == {("undefined", "no_command")}
    assert why(of("agreement", None, questionnaires={})) == {("undefined", "no_command")}


# ------------------------------------------------------------------------ entropy
def angles(theta: ArrayLike, **more: Any) -> Commands:
    theta = np.asarray(theta, float)
    return drive(np.sin(theta), 2 * np.cos(theta), **more)


def beside(commands: Commands, alpha: float = 0.25) -> dict[str, Score]:
    """Score beside a baseline whose errors are all of one size."""
    return of("user_input_entropy", commands, commands_baseline=angles(from_errors([alpha] * 4)))


def test_constant_is_predictable() -> None:  # h01
    found = beside(drive(ONES, 0 * ONES))
    assert value_of(found) == 0
    assert found["literal"].reason == "no_formula_in_seed"
    trend = 0.3 + 0.05 * np.arange(60)
    assert value_of(beside(angles(trend))) == 0


def test_without_a_baseline_nobody_is_compared() -> None:
    """On their own scales a smooth driver would seem less predictable than white noise."""
    rng = np.random.default_rng(4)
    t = 0.15 * np.arange(400)
    smooth = 0.8 * np.sin(0.5 * t) + 0.3 * np.sin(1.3 * t)
    drives = [smooth, smooth + rng.normal(0.0, 0.02, 400), rng.normal(0.0, 0.6, 400)]
    for theta in drives:
        found = of("user_input_entropy", angles(np.pi / 2 + theta))["corrected"]
        assert (found.value, found.reason) == (None, "no_baseline")
    scale = angles(np.pi / 2 + smooth + rng.normal(0.0, 0.05, 400))
    values = [
        value_of(of("user_input_entropy", angles(np.pi / 2 + d), commands_baseline=scale))
        for d in drives
    ]
    assert values == sorted(values)
    assert values[0] < values[1] < values[2]


def from_errors(errors: ArrayLike) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Angles that the prediction misses by these errors."""
    theta = [0.0, 0.0, 0.0]
    for e in np.asarray(errors, float):
        a, b, c = theta[-1], theta[-2], theta[-3]
        theta.append(a + (a - b) + 0.5 * ((a - b) - (b - c)) + e)
    return np.array(theta)


def test_bins_by_hand() -> None:  # h12: p = (6/8, 1/8, 1/8), alpha = 0.25
    small = [0.0, 0.01, -0.02, 0.03, -0.03, 0.02]
    run = angles(from_errors([*small, 0.26, -0.27]))
    baseline = angles(from_errors([0.25, -0.25, 0.25, -0.25]))
    found = of("user_input_entropy", run, commands_baseline=baseline)
    h = -(0.75 * math.log(0.75) + 0.25 * math.log(0.125)) / math.log(9)
    assert value_of(found) == pytest.approx(h)
    assert h == pytest.approx(0.3348, abs=1e-4)
    assert found["corrected"].extras == pytest.approx({"alpha": 0.25})


def test_every_edge_is_in_the_upper_bin() -> None:
    alpha = 0.02
    edges = [0.0, 0.01, 0.02, 0.05, 0.1, -0.01, -0.02, -0.05, -0.1]
    baseline = angles(from_errors([alpha] * 4))
    found = of("user_input_entropy", angles(from_errors(edges)), commands_baseline=baseline)
    assert value_of(found) == pytest.approx(1.0)
    below = [0.0, *(0.999 * e for e in edges[1:])]
    found = of("user_input_entropy", angles(from_errors(below)), commands_baseline=baseline)
    share = np.array([3, 1, 1, 1, 1, 1, 1]) / 9
    assert value_of(found) == pytest.approx(-(share @ np.log(share)) / math.log(9))


@pytest.mark.parametrize(("scale", "expected"), [(1, 0.5417), (2, 0.76)])
def test_noise(scale: float, expected: float) -> None:  # h06, h07
    errors = np.random.default_rng(5).normal(0, 1, 20000)
    alpha = float(np.percentile(np.abs(errors), 90))
    assert entropy(scale * errors, alpha) == pytest.approx(expected, rel=0.05)


def test_alpha_is_a_percentile_of_absolute_errors() -> None:
    errors = np.array([-0.1, 0.02, 0.03, -0.05, 0.01, 0.0])
    drive_ = angles(from_errors(errors))
    found = of("user_input_entropy", drive_, commands_baseline=drive_)
    assert found["corrected"].extras["alpha"] == pytest.approx(np.percentile(np.abs(errors), 90))


def test_zero_commands_hold_the_last_angle_and_leading_ones_are_dropped() -> None:
    theta = from_errors([0.02, -0.03, 0.05, 0.01, -0.02])
    plain = value_of(beside(angles(theta), 0.03))
    v, w = np.sin(theta), 2 * np.cos(theta)
    led = drive(np.concatenate([[0, 0], v]), np.concatenate([[0, 0], w]))
    assert value_of(beside(led, 0.03)) == pytest.approx(plain)
    held, gap = drive(np.repeat(v, 2), np.repeat(w, 2)), np.tile([1.0, 0.0], len(v))
    holes = drive(np.repeat(v, 2) * gap, np.repeat(w, 2) * gap)
    a, b = (value_of(beside(c, 0.03)) for c in (held, holes))
    assert a == pytest.approx(b)


def test_other_rates_are_resampled() -> None:
    theta = from_errors([0.02, -0.03, 0.05, 0.01, -0.02, 0.04])
    v, w = np.sin(theta), 2 * np.cos(theta)
    coarse = drive(v, w)
    fine = drive(np.repeat(v, 3)[:-2], np.repeat(w, 3)[:-2], dt=0.05)
    a, b = (of("user_input_entropy", c, commands_baseline=c)["corrected"] for c in (coarse, fine))
    assert a.value == pytest.approx(b.value)
    assert a.extras["alpha"] == pytest.approx(b.extras["alpha"])


def test_angles_are_unwrapped() -> None:
    spin = np.arange(60) * 0.7
    found = of("user_input_entropy", angles(spin), commands_baseline=angles(spin))
    assert value_of(found) == 0
    assert found["corrected"].extras["alpha"] < 1e-9


def test_reasons_of_entropy() -> None:
    assert beside(drive([1, 1, 1], [0, 0, 0]))["corrected"].reason == "too_few_samples"
    late = drive([0, 0, 1, 1, 1], [0, 0, 0, 0, 0])
    assert beside(late)["corrected"].reason == "too_few_samples"
    wild = angles(from_errors([0.1, -0.2, 0.1]))
    found = of("user_input_entropy", wild, commands_baseline=drive(ONES, 0 * ONES))
    assert found["corrected"].reason == "zero_alpha"
    assert of("user_input_entropy", None, questionnaires={})["corrected"].reason == "no_command"


# ------------------------------------------------------------------------ fluency
def test_fluency() -> None:  # h01, h09, h10
    assert values(of("fluency", drive(ONES, ONES))) == pytest.approx(
        {"literal": 1, "corrected": 1, "variation_rate": 0}
    )
    toggled = np.arange(42) % 2
    assert values(of("fluency", drive(toggled, 0 * ONES))) == pytest.approx(
        {"literal": 0, "corrected": 0, "variation_rate": 1 / 0.15}
    )
    flipped = 2.0 * np.where(toggled, 1, -1)
    found = of("fluency", drive(0 * ONES, flipped))
    assert values(found) == pytest.approx(
        {"literal": -3, "corrected": -1, "variation_rate": 2 / 0.15}
    )
    assert found["corrected"].extras == pytest.approx({"linear": 1, "angular": -1})


def test_fluency_of_both_channels_at_once() -> None:
    found = of("fluency", drive([0, 0.3], [0, 0.8]))
    assert value_of(found, "literal") == pytest.approx(1 - math.hypot(0.3, 0.8))
    assert value_of(found) == pytest.approx(0.6)
    assert value_of(found, "variation_rate") == pytest.approx(math.hypot(0.3, 0.4) / 0.15)
    assert why(of("fluency", drive([1], [0]))) == {("undefined", "too_few_samples")}
    assert why(of("fluency", None, questionnaires={})) == {("undefined", "no_command")}


def test_the_users_commands_count_not_the_final_ones() -> None:
    assert value_of(of("fluency", drive(ONES, 0 * ONES, np.arange(42) % 2))) == 1
    final = np.random.default_rng(0).normal(size=42)
    assert value_of(beside(drive(ONES, 0 * ONES, final, final))) == 0


# ----------------------------------------------------------------------- commands
@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"t": [0, 0, 1]}, "increase"),
        ({"t": [0, 1]}, "rows"),
        ({"t": [], "v_user": [], "w_user": [], "v_sc": [], "w_sc": []}, "empty"),
        ({"v_user": [0, math.nan, 1]}, "finite"),
        ({"v_user": "abc"}, "v_user"),
        ({"v_max": 0}, "v_max"),
        ({"w_max": -1}, "w_max"),
        ({"t_end": 1.0}, "t_end"),
    ],
)
def test_commands_that_are_none(change: dict[str, Any], message: str) -> None:
    zeros = {key: [0, 0, 0] for key in ("v_user", "w_user", "v_sc", "w_sc")}
    given: dict[str, Any] = {"t": [0, 1, 2], **zeros, "v_max": 1, "w_max": 1}
    with pytest.raises(InputError, match=message):
        Commands.from_arrays(**{**given, **change})


def test_commands_from_a_table(tmp_path: Path) -> None:
    file = tmp_path / "commands.csv"
    file.write_text("t,v_user,w_user,v_sc,w_sc,note\n0,1,0,1,0,a\n1,1,0,-1,0,b\n3,1,0,1,0,c\n")
    commands = Commands.from_csv(file, v_max=1, w_max=1)
    assert value_of(of("agreement", commands)) == pytest.approx(1 / 3)
    degrees = "# a drive\nt_ms;v_user;w_user [deg/s];v_sc;w_sc\n0;0,5;90;1;0\n500;0,5;0;1;0\n"
    file.write_text(degrees)
    other = Commands.from_csv(file, v_max=1, w_max=1)
    np.testing.assert_allclose([*other.t, *other.v_user], [0.0, 0.5, 0.5, 0.5])
    np.testing.assert_allclose(other.w_user, [np.pi / 2, 0.0])
    file.write_text("t,v_user,w_user,v_sc\n0,1,0,1\n")
    with pytest.raises(InputError, match=r"commands.csv:1: the column w_sc is missing"):
        Commands.from_csv(file, v_max=1, w_max=1)
    file.write_text("t,v_user,w_user,v_sc,w_sc\n0,1,0,1,x\n")
    with pytest.raises(InputError, match=r"commands.csv:2: w_sc"):
        Commands.from_csv(file, v_max=1, w_max=1)
    with pytest.raises(InputError, match="cannot be read"):
        Commands.from_csv(tmp_path / "none.csv", v_max=1, w_max=1)


# ----------------------------------------------------------------- questionnaires
RATINGS = dict(zip(TLX_SCALES, (60, 20, 40, 30, 70, 20), strict=True))
WEIGHTS = dict(zip(TLX_SCALES, (5, 0, 3, 2, 4, 1), strict=True))
SHEET: dict[str, Any] = {
    "nasa_tlx": {**RATINGS, "weights": WEIGHTS},
    "use": {
        "usefulness": [7] * 8,
        "ease_of_use": [5] * 10 + [None],
        "ease_of_learning": [2, 3, None, None],
    },
}


def test_answers() -> None:  # h11
    found = scores_of("nasa_tlx", None, questionnaires=SHEET)
    weighted = (5 * 60 + 3 * 40 + 2 * 30 + 4 * 70 + 20) / 15
    assert values(found) == pytest.approx({"raw": 40, "weighted": weighted})
    found = scores_of("use", None, questionnaires=SHEET)
    assert values(found) == {
        "usefulness": 7,
        "ease_of_use": 5,
        "ease_of_learning": 2.5,
        "satisfaction": None,
    }
    assert found["satisfaction"].reason == "no_answers"
    assert found["ease_of_learning"].extras["answered"] == 2


@pytest.mark.parametrize(
    ("tlx", "raw", "weighted"),
    [
        ({}, "no_answers", "no_answers"),
        ({**RATINGS}, "", "no_weights"),
        ({**RATINGS, "effort": None}, "invalid_ratings", "invalid_ratings"),
        ({**RATINGS, "effort": 101}, "invalid_ratings", "invalid_ratings"),
        ({**RATINGS, "effort": -1}, "invalid_ratings", "invalid_ratings"),
        ({**RATINGS, "weights": {**WEIGHTS, "effort": 5}}, "", "invalid_weights"),
        ({**RATINGS, "weights": [6, 0, 3, 1, 4, 1]}, "", "invalid_weights"),
        ({**RATINGS, "weights": [4.5, 0.5, 3, 2, 4, 1]}, "", "invalid_weights"),
        ({"ratings": [50] * 6, "weights": [5, 0, 3, 2, 4, 1]}, "", ""),
    ],
)
def test_reasons_of_workload(tlx: dict[str, Any], raw: str, weighted: str) -> None:
    found = scores_of("nasa_tlx", None, questionnaires={"nasa_tlx": tlx})
    assert (found["raw"].reason, found["weighted"].reason) == (raw, weighted)
    if not weighted:
        assert values(found) == {"raw": 50, "weighted": 50}  # i07


def test_reasons_of_usability() -> None:
    for items in ([8] * 8, [0] * 8, [7] * 7):
        found = scores_of("use", None, questionnaires={"use": {"usefulness": items}})
        assert found["usefulness"].reason == "invalid_items"
    found = scores_of("use", None, questionnaires={"use": {"usefulness": [None] * 8}})
    assert found["usefulness"].reason == "no_answers"


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"tlx": {}}, "unknown questionnaire 'tlx'"),
        ({"nasa_tlx": {"efort": 1}}, "did you mean 'effort'"),
        ({"nasa_tlx": {"effort": "much"}}, "not a number"),
        ({"nasa_tlx": {"ratings": [1, 2]}}, "6 ratings"),
        ({"use": {"usefulness": 7}}, "row of answers"),
        ({"use": {"useful": [7]}}, "did you mean 'usefulness'"),
        ({"use": [1]}, "must map"),
    ],
)
def test_answers_that_are_none(given: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        Questionnaires.from_mapping(given)


def test_answers_from_a_table(tmp_path: Path) -> None:
    file = tmp_path / "answers.csv"
    rows = ["questionnaire,item,value"]
    rows += [f"nasa_tlx,{name},{value}" for name, value in RATINGS.items()]
    rows += [f"nasa_tlx,weight_{name},{value}" for name, value in WEIGHTS.items()]
    rows += [f"use,usefulness_{i},7" for i in range(1, 9)]
    rows += ["use,ease_of_learning_1,2", "use,ease_of_learning_2,3", "use,ease_of_learning_4,"]
    rows += [f"use,ease_of_use_{i},5" for i in range(1, 11)]
    file.write_text("\n".join(rows) + "\n")
    assert Questionnaires.from_csv(file) == Questionnaires(
        tlx_ratings={k: float(v) for k, v in RATINGS.items()},
        tlx_weights={k: float(v) for k, v in WEIGHTS.items()},
        use={
            "usefulness": (7.0,) * 8,
            "ease_of_use": (5.0,) * 10 + (None,),
            "ease_of_learning": (2.0, 3.0, None, None),
        },
    )
    for line, message in (
        ("use,usefulness_9,1", ":2: unknown item of use"),
        ("sus,x,1", ":2: unknown questionnaire"),
        ("use,usefulness_1,much", ":2: could not convert"),
        ("use,usefulness_1,1\nuse,usefulness_1,2", ":3: usefulness_1 was answered before"),
    ):
        file.write_text(f"questionnaire,item,value\n{line}\n")
        with pytest.raises(InputError, match=message):
            Questionnaires.from_csv(file)
    file.write_text("item,value\n")
    with pytest.raises(InputError, match=":1: expected the columns"):
        Questionnaires.from_csv(file)
