"""effect_on_velocity: hand cases and failures."""

import dataclasses

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import (
    Array,
    Body,
    grid,
    line,
    present_during,
    scene,
    scores_of,
    value_of,
    with_columns,
)

NAME = "effect_on_velocity"
T = grid(20)


def lapping(t: Array, speed: float, length: float = 7.3) -> tuple[Body, NDArray[np.bool_]]:
    """A walker whom a portal takes back by ``length``; and the steps on which it does."""
    lap = np.floor(speed * t / length + 1e-9)
    x = speed * t - lap * length
    body = Body(x, np.zeros(len(t)), np.full(len(t), speed), np.zeros(len(t)))
    return body, np.diff(lap) > 0


def crowd(speed: float, *, velocities: bool, flagged: bool) -> Trajectories:
    """Two walkers in opposite directions; portals every 7.3 m."""
    body, jump = lapping(T, speed)
    back = Body(-body.x, body.y + 1, -body.vx, body.vy)
    flags = np.stack([jump, jump], axis=1) if flagged else None
    robot = line(T, (0, 5), (1, 0))
    return scene(T, robot, [body, back], velocities=velocities, agent_jump=flags)


@pytest.mark.parametrize("flagged", [True, False])
@pytest.mark.parametrize("velocities", [True, False])
@pytest.mark.parametrize("variant", ["literal", "corrected"])
def test_slowed_walkers_through_portals(  # e02, e04
    velocities: bool, flagged: bool, variant: str
) -> None:
    run = crowd(0.8, velocities=velocities, flagged=flagged)
    alone = crowd(1.0, velocities=velocities, flagged=flagged)
    assert value_of(scores_of(NAME, run, None, alone), variant) == pytest.approx(1.25)


def test_an_unaffected_crowd() -> None:  # e01, e03
    run = crowd(1.0, velocities=True, flagged=True)
    alone = dataclasses.replace(run, robot=None)
    assert {s.value for s in scores_of(NAME, run, None, alone).values()} == {1.0}


def test_flags_decide_even_when_the_jump_is_short() -> None:
    t = grid(4, 1.0)
    x = np.array([0.0, 1.0, 4.0, 5.0, 6.0])  # 3 m/s between 1 and 2: believable, yet flagged
    body = Body(x, np.zeros(5), np.ones(5), np.zeros(5))
    jump = np.array([[False], [True], [False], [False]])
    run = scene(t, None, [body], velocities=False, agent_jump=jump)
    alone = scene(t, None, [line(t, (0, 0), (1, 0))])
    assert value_of(scores_of(NAME, run, None, alone), "literal") == pytest.approx(1)
    blind = scene(t, None, [body], velocities=False)
    assert value_of(scores_of(NAME, blind, None, alone), "literal") < 0.99


def test_a_longer_calibration() -> None:  # j02
    t, half = grid(30), grid(15)
    never = np.zeros(len(t), dtype=bool)
    first, second = never.copy(), never.copy()
    first[:101], second[:151] = True, True
    late = never.copy()
    late[250:] = True
    walkers = [line(t, (0, y), (v, 0)) for y, v in ((0, 1.0), (2, 1.0), (4, 3.0))]
    alone = scene(
        t, None, [present_during(b, h) for b, h in zip(walkers, (first, second, late), strict=True)]
    )
    short = [
        present_during(line(half, (0, y), (1, 0)), h[:151]) for y, h in ((0, first), (2, second))
    ]
    run = scene(half, line(half, (0, 9), (1, 0)), short)
    found = scores_of(NAME, run, None, alone)
    assert value_of(found, "literal") == pytest.approx((101 + 151 + 3 * 51) / 303)
    assert value_of(found) == pytest.approx(1)
    found = scores_of(NAME, alone, None, run)  # the other record may be the longer one, too
    assert value_of(found) == pytest.approx(1)


def test_every_sample_of_everybody_weighs_the_same() -> None:
    """Neither a mean of the walkers' means, nor of the samples' means."""
    t = grid(10)
    body, visitor = line(t, (0, 0), (1, 0)), line(t, (0, 2), (0.5, 0))
    run = scene(t, None, [body, present_during(visitor, np.arange(101) >= 60)])
    alone = scene(t, None, [body])
    found = scores_of(NAME, run, None, alone)
    assert value_of(found, "literal") == pytest.approx(1 / ((101 + 0.5 * 41) / 142))
    assert value_of(found) == pytest.approx(1 / ((10 + 0.5 * 4.05) / 14.05))


def test_corrected_weighs_time_not_samples() -> None:
    """Twice as many samples in the fast half."""
    t = np.concatenate([np.arange(0, 5, 0.1), np.arange(5, 10.01, 0.05)])
    speed = np.where(t < 5, 0.5, 2.0)
    body = Body(np.zeros(len(t)), np.zeros(len(t)), speed, np.zeros(len(t)))
    alone = scene(grid(10), None, [line(grid(10), (0, 0), (1, 0))])
    found = scores_of(NAME, scene(t, None, [body]), None, alone)
    mean = (0.5 * 4.95 + 0.05 * 0.5 + 0.025 * 2 - 0.025 * 0.5 + 5 * 2.0 + 0.025 * 0.5) / 10
    assert value_of(found) == pytest.approx(1 / mean, rel=2e-3)
    assert abs(value_of(found, "literal") - 1 / mean) > 0.05


def test_speed_not_velocity() -> None:
    """Counter flow: the vectors cancel, the speeds do not; sideways counts."""
    t = grid(5)
    run = scene(t, None, [line(t, (0, 0), (1, 0)), line(t, (0, 2), (-1, 0))])
    alone = scene(t, None, [line(t, (0, 0), (0.6, 0.8)), line(t, (0, 2), (0, -1))])
    assert [s.value for s in scores_of(NAME, run, None, alone).values()] == pytest.approx([1, 1])


def test_only_the_time_before_the_arrival_counts() -> None:
    t = grid(10)
    speed = np.where(t <= 5.0 + 1e-9, 1.0, 0.1)
    body = Body(np.zeros(len(t)), np.zeros(len(t)), speed, np.zeros(len(t)))
    run = scene(t, line(t, (0, 3), (1, 0)), [body], goal_time=5.0)
    alone = scene(t, None, [line(t, (0, 0), (1, 0))])
    assert [s.value for s in scores_of(NAME, run, None, alone).values()] == pytest.approx([1, 1])


def test_missing_velocities_of_some_are_derived() -> None:
    t = grid(5)
    run = scene(t, None, [line(t, (0, 0), (1, 0)), line(t, (0, 2), (2, 0))])
    assert run.agents is not None
    vx = run.agents.vx.copy()
    vx[10:20, 1] = np.nan
    part = dataclasses.replace(run, agents=dataclasses.replace(run.agents, vx=vx))
    found = scores_of(NAME, part, None, run)
    assert [s.value for s in found.values()] == pytest.approx([1, 1], rel=1e-12)


def test_a_sample_between_two_jumps_has_no_speed() -> None:
    t = grid(4, 1.0)
    x = np.array([0.0, 1.0, 50.0, 100.0, 101.0])
    lone = Body(x, np.zeros(5), np.zeros(5), np.zeros(5))
    run = scene(t, None, [lone], velocities=False)
    alone = scene(t, None, [line(t, (0, 0), (1, 0))])
    assert value_of(scores_of(NAME, run, None, alone), "literal") == pytest.approx(1)


def test_reasons() -> None:
    t = grid(5)
    run = scene(t, None, [line(t, (0, 0), (1, 0))])
    still = scene(t, None, [line(t, (0, 0), (0, 0))])
    one = scene([0.0], None, [line(np.zeros(1), (0, 0), (1, 0))])
    cases = [
        (run, None, "no_reference"),
        (scene(t), run, "no_agents"),
        (run, scene(t), "no_agents"),
        (with_columns(run, []), run, "no_agents"),
        (still, run, "zero_denominator"),
    ]
    for crowded, alone, reason in cases:
        found = scores_of(NAME, crowded, None, alone)
        assert set(found) == {"literal", "corrected"}
        assert {(s.status, s.reason) for s in found.values()} == {("undefined", reason)}
    assert value_of(scores_of(NAME, run, None, still)) == 0
    found = scores_of(NAME, one, None, run)
    assert value_of(found, "literal") == 1
    assert (found["corrected"].status, found["corrected"].reason) == (
        "undefined",
        "too_few_samples",
    )


def test_people_who_are_never_there() -> None:
    t = grid(5)
    ghost = Body(*(np.full(len(t), np.nan) for _ in range(4)))
    run = scene(t, None, [line(t, (0, 0), (1, 0))])
    found = scores_of(NAME, scene(t, None, [ghost]), None, run)
    assert {s.reason for s in found.values()} == {"no_agents"}
