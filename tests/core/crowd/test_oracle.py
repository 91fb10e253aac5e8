"""One step at a time against the original engine."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.core.crowd import state as s
from crowdbot.core.crowd import step
from crowdbot.core.crowd.parameters import AgentParameters
from crowdbot.core.crowd.velocity_search.sampling import Sampler
from crowdbot.core.exchange.umans.policies import COSTS
from scripts.crowd_oracle.__main__ import main
from scripts.crowd_oracle.judge import CLOSE, agrees, judge
from scripts.crowd_oracle.policy import cost_spec, policy_spec
from scripts.crowd_oracle.step import Stepper
from tests.core.crowd.oracle_cases import FOLDER, NAMES, load

#: Most samples that float32 rounding may decide, in a case of few agents: alone, two candidates
#: mirrored at the preferred velocity often cost exactly the same.
MOST_TIES = 0.5


def test_every_cost_function_and_method_has_excerpts() -> None:
    costs, methods = set(), set()
    for name in NAMES:
        case = load(name)
        methods |= {(spec.method, spec.samples) for spec, _ in case.policies}
        costs |= {c.kind for _, mix in case.policies for c in mix}
    assert {kind for name, (kind, _) in COSTS.items() if name != "RandomFunction"} <= costs
    assert {("gradient", "regular"), ("global", "regular"), ("sampling", "regular")} <= methods
    assert ("sampling", "random") in methods


@pytest.mark.parametrize("name", NAMES)
def test_one_step(name: str) -> None:
    verdict = judge(load(name))
    print(f"{verdict}")
    assert verdict.samples > 0
    assert verdict.not_a_number == 0
    assert verdict.misses == 0
    assert verdict.outright >= (1.0 - MOST_TIES) * verdict.samples
    if name.startswith(("corridor", "samp_RVO_random", "iso_ORCA", "iso_PowerLaw", "iso_Social")):
        assert verdict.outright >= 0.999 * verdict.samples
        assert verdict.median < 1e-5


def _weaker_contact(people: AgentParameters) -> AgentParameters:
    people.traits["push"][:] *= 0.8
    return people


def _slower(people: AgentParameters) -> AgentParameters:
    people.traits["max_speed"][:] *= 0.5
    return people


@pytest.mark.parametrize(("name", "wrong"), [
    ("ex_25to25-Formation-90Degrees_FOEAvoidance", _weaker_contact),
    ("mech_contact_range_short", _weaker_contact),
    ("ex_25to25-Formation-90Degrees_SocialForces", _slower),
])  # fmt: skip
def test_contact_and_clamping_are_those_of_the_engine(
    name: str,
    wrong: Callable[[AgentParameters], AgentParameters],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    right = AgentParameters.of
    monkeypatch.setattr(AgentParameters, "of", lambda *given: wrong(right(*given)))
    assert judge(load(name)).misses > 0


def test_motion_is_that_of_the_engine(monkeypatch: pytest.MonkeyPatch) -> None:
    """Velocities are right, places are not: a millimetre beside is a miss."""
    right = step.tick

    def wrong(flat: Any, *rest: Any) -> None:
        right(flat, *rest)
        s.view(flat)[1][:, s.X] += 1e-3

    monkeypatch.setattr("crowdbot.core.crowd.engine.tick", wrong)
    found = judge(load("iso_RVO_sampling_cross"))
    assert found.misses == found.samples > 0


def test_a_place_across_the_border_is_the_same_place() -> None:
    case = load("mech_toric_RVO")
    assert case.periodic_boundary is not None
    _, x1, _, _ = case.periodic_boundary
    there = np.array([[x1 - 1e-6, 0.0, 0.5, 0.0], [0.0, 0.0, 0.5, 0.0]])
    here = there + np.array([[-2.0 * x1 + 2e-6, 0.0, 0.0, 0.0], [1e-3, 0.0, 0.0, 0.0]])
    assert agrees(case, here, there).tolist() == [True, False]


def test_a_candidate_on_a_limit_may_be_forbidden_by_rounding() -> None:
    """The original forbids agent 42 a candidate at 30 degrees, and allows it a slower one there."""
    verdict = judge(load("ex_25to25-180Degrees_Karamouzas"))
    assert (verdict.by_rounding, verdict.misses) == (1, 0)


def test_rounding_excuses_nothing_else() -> None:
    """A choice that is dearer than another, far from any limit, stays a miss."""
    case = load("ex_Circle10_Karamouzas")
    states = case.states[:2].copy()
    stepper = Stepper(case)
    view = stepper.view(states[0], 0)
    sampler = stepper.policies[0].minimiser
    assert isinstance(sampler, Sampler)
    slow = np.ascontiguousarray(sampler.candidates(view)[:, 5])  # of the slowest ring
    states[1] = stepper.move(states[0], stepper.policies[0].towards(slow, view))
    found = judge(replace(case, states=states, present=case.present[:2]))
    assert found.by_rounding == 0
    assert found.misses == found.samples == 10


@pytest.mark.parametrize("name", NAMES)
def test_positions_follow_velocities(name: str) -> None:
    """The reference itself moves by semi-implicit Euler, which is what the comparison assumes."""
    case = load(name)
    moved = case.states[:-1, :, :2] + case.states[1:, :, 2:] * case.dt
    offset = np.abs(moved - case.states[1:, :, :2])
    if case.periodic_boundary is not None:
        for axis, size in (
            (0, 2.0 * case.periodic_boundary[1]),
            (1, 2.0 * case.periodic_boundary[3]),
        ):
            offset[..., axis] = np.minimum(offset[..., axis], np.abs(offset[..., axis] - size))
    assert np.max(offset) < 2e-5


def _write(folder: Path, name: str, shift: float) -> None:
    """An excerpt in the form of the reference data, its last velocities shifted."""
    with np.load(FOLDER / f"{name}.npz") as data:
        state, ids = np.asarray(data["state"]).copy(), np.asarray(data["id"])
        (folder / f"{name}.json").write_text(str(data["settings"]))
    state[-1, 0, 2] += shift
    x, y, vx, vy = state.reshape(-1, 4).T
    times, ids = np.repeat(np.arange(len(state)), len(ids)), np.tile(ids, len(state))
    np.savez(folder / f"{name}.npz", t=times, id=ids, x=x, y=y, vx=vx, vy=vy)


@pytest.mark.parametrize(("shift", "misses"), [(0.0, 0), (0.5 * CLOSE, 0), (0.05, 1)])
def test_the_command_finds_misses(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], shift: float, misses: int
) -> None:
    _write(tmp_path, "samp_RVO_random", shift)
    assert main([str(tmp_path), "--json"]) == (1 if misses else 0)
    document = json.loads(capsys.readouterr().out)
    assert document["misses"] == misses
    assert document["cases"][0]["name"] == "samp_RVO_random"
    assert main([str(tmp_path)]) == (1 if misses else 0)
    assert f"{misses} misses" in capsys.readouterr().out


def test_samples_in_which_the_original_has_nan_are_told_apart(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _write(tmp_path, "samp_RVO_random", np.nan)
    assert main([str(tmp_path), "--json"]) == 0
    (case,) = json.loads(capsys.readouterr().out)["cases"]
    assert case["not_a_number"] == 1


def test_no_cases_and_broken_cases(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(tmp_path)]) == 1
    assert "no cases" in capsys.readouterr().err
    _write(tmp_path, "samp_RVO_random", 0.0)
    setup = tmp_path / "samp_RVO_random.json"
    setup.write_text(setup.read_text().replace('"RVO"', '"RV0"'))
    assert main([str(tmp_path)]) == 1
    assert "'RV0'" in capsys.readouterr().err


def test_defaults_of_the_original() -> None:
    policy = policy_spec({})
    assert (policy.angles, policy.speeds, policy.random_samples) == (11, 4, 100)
    assert (policy.relaxation_time, policy.contact_stiffness) == (0.0, 62.5)
    assert not policy.include_base
    assert policy.direction == "current_velocity"
    social = cost_spec({"name": "SocialForcesAvoidance", "U0": "7", "V0": "3"})
    assert social.model_dump()["v0"] == 7.0  # a defect of the original
    with pytest.raises(ValueError, match="GenericCost"):
        cost_spec({"name": "GenericCost"})
