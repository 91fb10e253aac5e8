"""risk: hand cases and failures."""

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import (
    REACH,
    ROBOT_RADIUS,
    Body,
    grid,
    line,
    present_during,
    scene,
    scores_of,
    value_of,
    with_columns,
)

T = grid(10)


def head_on(dt: float = 0.1, offset: float = 0.0) -> Trajectories:
    """Both at 1 m/s, 10 m apart, passing through each other."""
    t = grid(10, dt)
    return scene(t, line(t, (0, 0), (1, 0)), [line(t, (10, offset), (-1, 0))])


def expected(tau0: float, contact: int, *, dt: float = 0.1) -> dict[str, float]:
    """The variants for a time to contact that falls from tau0 to 0, then a contact."""
    tau = np.concatenate([np.arange(tau0, 0, -dt), np.zeros(contact)])
    weights = np.full(len(tau), dt)
    weights[0] /= 2
    return {
        "literal": float(tau.sum()),
        "corrected": float(weights @ np.maximum(0, 1 - tau / 5)),
        "exposed_time": float(weights @ (tau < 5)),
    }


def check(run: Trajectories, values: dict[str, float]) -> None:
    found = scores_of("risk", run)
    values |= dict.fromkeys(("rate", "disc"), values["corrected"] / float(run.t[-1] - run.t[0]))
    assert {name: s.value for name, s in found.items()} == pytest.approx(values)
    extras = found["corrected"].extras
    assert extras["mean"] == pytest.approx(values["corrected"] / (run.t[-1] - run.t[0]))


def test_head_on() -> None:  # b01
    found = scores_of("risk", head_on())
    assert value_of(found, "literal") == pytest.approx(116.88, abs=1e-9)
    assert value_of(found) == pytest.approx(2.96025, abs=1e-12)
    assert value_of(found, "exposed_time") == pytest.approx(5.25, abs=1e-12)
    assert found["corrected"].extras["mean"] == pytest.approx(0.296025, abs=1e-12)
    check(head_on(), expected(4.785, 5))


def test_head_on_sampled_twice_as_often() -> None:  # b09
    found = scores_of("risk", head_on(0.05))
    assert value_of(found, "literal") == pytest.approx(231.36, abs=1e-9)
    assert value_of(found) == pytest.approx(2.9353, abs=5e-5)


def test_corrected_converges() -> None:
    limit = 4.785 - 4.785**2 / 10 + 0.43
    errors = [abs(value_of(scores_of("risk", head_on(dt))) - limit) for dt in (0.1, 0.05, 0.0125)]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 0.01


@pytest.mark.parametrize(
    "agent",
    [
        pytest.param(line(T, (10, 1.0), (-1, 0)), id="b02 head-on, 1 m to the side"),
        pytest.param(line(T, (5, -4), (0, 1)), id="b05 crosses behind"),
        pytest.param(line(T, (2, 0), (1, 0)), id="b06 convoy"),
        pytest.param(line(T, (-2, 0), (-1, 0)), id="goes away"),
    ],
)
def test_nobody_comes_closer_than_contact(agent: Body) -> None:
    found = scores_of("risk", scene(T, line(T, (0, 0), (1, 0)), [agent]))
    assert {s.value for s in found.values()} == {0.0}


def test_offset() -> None:  # b03
    half = math.sqrt(REACH**2 - 0.3**2)
    tau0 = (10 - half) / 2
    inside = int((np.abs(10 - 2 * T) <= half).sum())
    check(head_on(offset=0.3), expected(tau0, inside))


def test_crossing() -> None:  # b04
    run = scene(T, line(T, (-5, 0), (1, 0)), [line(T, (0, -5), (0, 1))])
    inside = int((np.abs(T - 5) * math.sqrt(2) <= REACH).sum())
    check(run, expected(5 - REACH / math.sqrt(2), inside))


def test_surfaces_count_with_each_persons_own_radius() -> None:
    t = grid(1)
    run = scene(
        t,
        line(t, (0, 0), (1, 0)),
        [line(t, (10, 0), (1, 0)), line(t, (10, 0), (0, 0))],
        agent_radius=[1.0, 0.5],
    )
    tau = (10 - ROBOT_RADIUS - 0.5) - t
    assert value_of(scores_of("risk", run), "literal") == pytest.approx(tau.sum())


def test_only_the_first_contact_counts() -> None:
    """A group is as risky as its nearest member."""
    run = head_on()
    second = line(T, (12, 0), (-1, 0))
    group = scene(T, line(T, (0, 0), (1, 0)), [line(T, (10, 0), (-1, 0)), second])
    assert value_of(scores_of("risk", group)) < 2 * value_of(scores_of("risk", run))
    before = T < 4.75
    tau = np.concatenate([4.785 - T[before], np.zeros(5)])
    then = 5.785 - T[(T > 5.25) & (T < 5.75)]
    total = tau.sum() + then.sum()
    assert value_of(scores_of("risk", group), "literal") == pytest.approx(total)


def test_horizon() -> None:
    found = [scores_of("risk", head_on(), risk_horizon=h) for h in ("2 s", 4.0, 5.0, 8.0)]
    values = [value_of(f) for f in found]
    assert values == sorted(values)
    assert values[0] < values[1] < values[3]
    tau = np.concatenate([4.785 - 0.1 * np.arange(48), np.zeros(5)])
    assert values[0] == pytest.approx(0.1 * np.maximum(0, 1 - tau / 2).sum())
    assert value_of(found[0], "exposed_time") == pytest.approx(0.1 * (tau < 2).sum())
    assert len({value_of(f, "literal") for f in found}) == 1


def test_slow_relative_motion_is_none() -> None:
    t = grid(1)
    creeping = scene(t, line(t, (0, 0), (1, 0)), [line(t, (5, 0), (1 - 1e-7, 0))])
    assert value_of(scores_of("risk", creeping), "literal") == 0
    found = scores_of("risk", creeping, rel_speed_tol=0.0)
    assert value_of(found, "literal") > 1e8


def test_overlap_counts_in_full_even_when_parting_or_unmoved() -> None:
    t = grid(10)
    for velocity in ((0.0, 0.0), (0.01, 0.0)):
        run = scene(t, line(t, (0, 0), (0, 0)), [line(t, (0.2, 0), velocity)])
        found = scores_of("risk", run)
        assert [s.value for s in found.values()] == pytest.approx([0, 10, 10, 1, 1])
        assert found["corrected"].extras["mean"] == pytest.approx(1)


def test_a_grazing_pass_is_a_contact() -> None:
    run = head_on(offset=REACH)
    assert value_of(scores_of("risk", run)) > 1
    assert value_of(scores_of("risk", head_on(offset=REACH + 1e-6))) == 0


def test_time_runs_with_the_record() -> None:
    """Uneven samples: each weighs by its time."""
    t = np.concatenate([np.arange(0, 2, 0.02), np.arange(2, 10.01, 0.1)])
    run = scene(t, line(t, (0, 0), (1, 0)), [line(t, (10, 0), (-1, 0))])
    assert value_of(scores_of("risk", run)) == pytest.approx(2.96025, abs=0.01)


def test_heading_and_reversing() -> None:
    """The velocity is v along theta: a robot that reverses towards somebody is at risk."""
    n = np.ones(len(T))
    given: dict[str, Any] = {
        "agent_x": 5 * n[:, None],
        "agent_y": 0 * n[:, None],
        "agent_vx": 0 * n[:, None],
    }
    run = Trajectories.from_arrays(
        t=T,
        robot_x=0.4 * T,
        robot_y=0 * T,
        robot_theta=np.full(len(T), np.pi),
        robot_v=-0.4 * n,
        robot_w=0 * T,
        robot_radius=ROBOT_RADIUS,
        robot_mass=6.3,
        **given,
        agent_vy=0 * n[:, None],
        agent_radius=0.25,
        agent_mass=70.0,
    )
    tau = (5 - 0.4 * T - REACH) / 0.4
    assert value_of(scores_of("risk", run), "literal") == pytest.approx(tau.sum())


@pytest.mark.parametrize("velocities", [True, False])
def test_derived_velocities(velocities: bool) -> None:
    agents = [line(T, (10, 0), (-1, 0)), present_during(line(T, (3, 8), (0, -1)), T > 4)]
    run = scene(T, line(T, (0, 0), (1, 0)), agents, velocities=velocities)
    assert value_of(scores_of("risk", run)) == pytest.approx(2.96025)
    assert run.robot is not None
    blind = dataclasses.replace(run.robot, v=np.full(len(T), np.nan))
    again = dataclasses.replace(run, robot=blind)
    assert value_of(scores_of("risk", again)) == pytest.approx(2.96025)


def test_a_teleport_is_no_approach() -> None:
    x = np.where(T < 4.95, 30.0, 3.0)
    portal = Body(x, np.zeros(len(T)), np.full(len(T), np.nan), np.full(len(T), np.nan))
    run = scene(T, line(T, (0, 0), (0, 0)), [portal], velocities=False)
    assert {s.value for s in scores_of("risk", run).values()} == {0.0}


def test_absent_people_are_no_risk() -> None:
    agent = present_during(line(T, (10, 0), (-1, 0)), T > 7)
    found = scores_of("risk", scene(T, line(T, (0, 0), (1, 0)), [agent]))
    assert {s.value for s in found.values()} == {0.0}


def test_nothing_after_the_arrival() -> None:
    run = head_on()
    assert run.robot is not None
    run = dataclasses.replace(run, robot=dataclasses.replace(run.robot, goal_time=1.0))
    tau = 4.785 - T[:11]
    assert value_of(scores_of("risk", run), "literal") == pytest.approx(tau.sum())
    assert value_of(scores_of("risk", run), "exposed_time") == pytest.approx(1.0)


def test_no_people_no_risk() -> None:
    run = scene(T, line(T, (0, 0), (1, 0)))
    for nobody in (run, with_columns(head_on(), [])):
        found = scores_of("risk", nobody)
        assert [(s.status, s.value) for s in found.values()] == [("ok", 0.0)] * 5
        assert found["corrected"].extras["mean"] == 0


def test_reasons() -> None:
    found = scores_of("risk", scene(T, None, [line(T, (0, 0), (1, 0))]))
    assert {(s.status, s.reason) for s in found.values()} == {("undefined", "invalid_no_robot")}
    t = np.zeros(1)
    found = scores_of("risk", scene(t, line(t, (0, 0), (1, 0)), [line(t, (2, 0), (0, 0))]))
    assert value_of(found, "literal") == pytest.approx(2 - REACH)
    assert {found[v].reason for v in ("corrected", "exposed_time", "rate")} == {"too_few_samples"}


def test_only_rates_have_a_good_direction() -> None:
    """What is summed over a run is smaller where the run is shorter, whoever drives."""
    assert {s.variant: s.better for s in scores_of("risk", head_on()).values()} == {
        "literal": "none",
        "corrected": "none",
        "exposed_time": "none",
        "rate": "lower",
        "disc": "lower",
    }
