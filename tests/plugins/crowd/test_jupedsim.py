"""JuPedSim as a policy: our side of it always, the library itself with ``pytest -m jupedsim``."""

from __future__ import annotations

import importlib
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld
from crowdbot.core.crowd.policy import CrowdView
from crowdbot.errors import InputError, PluginError
from crowdbot.plugins.crowd.policies import jupedsim_build
from crowdbot.plugins.crowd.policies.jupedsim import JuPedSimSpec
from crowdbot.plugins.crowd.policies.jupedsim_build import JuPedSim, build
from tests.core.crowd.crowd_reference import Array
from tests.plugins.crowd import fake_jupedsim
from tests.plugins.crowd.fake_jupedsim import FakeAreas

MODELS = ("collision_free_speed", "anticipation_velocity")
NOBODY: Any = []


def _view(at: Array, **changes: Any) -> CrowdView:
    n = len(at)
    agents = Agents.of(x=at[:, 0], y=at[:, 1], preferred_speed=1.2)
    given: dict[str, Any] = {
        "agents": agents, "position": at, "velocity": np.zeros((n, 2)),
        "goal": at + np.array([40.0, 0.0]), "present": np.ones(n, np.bool_),
        "robot": np.zeros((0, 5)),
        "walls": np.zeros((0, 4)), "dt": 1.0 / 16.0,
    }  # fmt: skip
    return CrowdView(**{**given, **changes})


def _faked(**words: Any) -> JuPedSim:
    return JuPedSim(JuPedSimSpec(**words), fake_jupedsim, cast(Any, FakeAreas()))


@pytest.mark.parametrize("model", MODELS)
def test_the_answer_is_the_mean_velocity(model: str) -> None:
    view = _view(np.array([[0.0, 0.0], [5.0, 1.0]]))
    assert _faked(model=model).velocities(view, view.dt) == pytest.approx(
        np.array([[1.2, 0.0], [1.2, 0.0]])
    )


def test_who_has_arrived_stands_and_who_is_absent_does_not_count() -> None:
    at = np.array([[0.0, 0.0], [5.0, 1.0], [5.0, 1.0]])
    goal = np.array([[0.1, 0.0], [45.0, 1.0], [45.0, 1.0]])
    view = _view(at, goal=goal, present=np.array([True, True, False]))
    found = _faked().velocities(view, view.dt)
    assert found[:2] == pytest.approx(np.array([[0.0, 0.0], [1.2, 0.0]]))


@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=1, max_size=12))
@settings(max_examples=60)
def test_overlapping_people_are_no_error(at: list[tuple[float, float]]) -> None:
    """The library refuses bodies that overlap; ours do, now and then, even with equal centres."""
    view = _view(np.array(at))
    found = _faked().velocities(view, view.dt)
    assert found == pytest.approx(np.tile([1.2, 0.0], (len(at), 1)))


def test_the_order_of_agents_does_not_matter() -> None:
    at = np.random.default_rng(2).uniform(-2, 2, (20, 2))
    order = np.random.default_rng(3).permutation(20)
    view = _view(at)
    moved = _view(at[order], agents=Agents.of(id=order, x=at[order, 0], y=at[order, 1],
                                               preferred_speed=1.2))  # fmt: skip
    first, second = (_faked().velocities(v, v.dt) for v in (view, moved))
    assert second == pytest.approx(first[order])


def test_robots_and_pillars_are_people_to_the_library() -> None:
    view = _view(
        np.array([[0.0, 0.0]]), robot=np.array([[0.3, 0.0, 0.5, 0.0, 0.428]]),
        pillars=np.array([[0.0, 0.9, 0.5]]),
    )  # fmt: skip
    assert np.all(np.isfinite(_faked().velocities(view, view.dt)))


def test_what_the_library_refuses_is_its_error(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> int:
        raise RuntimeError("no such place")

    monkeypatch.setattr(fake_jupedsim.Simulation, "add_agent", refuse)
    view = _view(np.zeros((1, 2)), t=2.5)
    with pytest.raises(PluginError, match=r"jupedsim at t = 2\.5 s: no such place"):
        _faked().velocities(view, view.dt)


def test_cost_functions_are_refused() -> None:
    with pytest.raises(InputError, match="takes no cost functions"):
        build(JuPedSimSpec(), [object()], Agents.of(x=0.0, y=0.0))


def test_a_missing_library_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> Any:
        raise ImportError(f"No module named '{name}'")

    monkeypatch.setattr(importlib, "import_module", missing)
    with pytest.raises(PluginError, match=r"pip install 'crowdbot\[jupedsim\]'") as caught:
        build(JuPedSimSpec(), NOBODY, Agents.of(x=0.0, y=0.0))
    assert caught.value.exit_code == 3


# ---------------------------------------------------------------- the library itself
@pytest.mark.jupedsim
@pytest.mark.parametrize("model", MODELS)
def test_a_stream_in_a_corridor(model: str) -> None:
    """Thirty people around a pillar: within the walls, onwards, the same twice."""
    rng = np.random.default_rng(0)
    agents = Agents.of(
        x=rng.uniform(0, 20, 30), y=rng.uniform(-3, 3, 30), preferred_speed=1.2, radius=0.25,
        routes=[[(80.0, 0.0)]] * 30,
    )  # fmt: skip
    world = CrowdWorld(
        walls=np.array([[-5, -4, 90, -4], [90, 4, -5, 4.0]]), pillars=np.array([[22.0, 0.0, 0.5]])
    )
    engine = CrowdEngine(agents, world, lambda a: build(JuPedSimSpec(model=model), [], a))  # type: ignore[arg-type]
    _, place = engine.run(8.0)
    assert np.all(np.isfinite(place))
    assert np.max(np.abs(place[..., 1])) < 4.0
    assert np.mean(place[-1, :, 0] - place[0, :, 0]) > 0.6 * 1.2 * 8.0
    assert np.min(np.hypot(place[..., 0] - 22.0, place[..., 1])) > 0.5
    assert np.array_equal(engine.run(8.0)[1], place)


@pytest.mark.jupedsim
def test_closed_rooms_and_people_on_walls() -> None:
    """Two rooms that no way joins, a goal outside, somebody on the wall, two on one spot."""
    rooms = [
        [0, 0, 6, 0], [6, 0, 6, 4], [6, 4, 0, 4], [0, 4, 0, 0], [3, 0, 3, 4],
    ]  # fmt: skip
    agents = Agents.of(
        x=[1.0, 5.0, 3.0, 1.5, 1.5], y=[2.0, 2.0, 1.0, 3.0, 3.0], radius=0.2,
        routes=[[(9.0, 2.0)]] * 5,
    )  # fmt: skip
    engine = CrowdEngine(
        agents,
        CrowdWorld(walls=np.array(rooms, np.float64)),
        lambda a: build(JuPedSimSpec(), [], a),
    )
    _, place = engine.run(5.0)
    assert np.all(np.isfinite(place))
    assert np.max(place[:, 0, 0]) < 3.0
    assert np.max(place[:, 1, 0]) < 6.0


@pytest.mark.jupedsim
def test_the_stand_in_has_what_the_library_has() -> None:
    """Every call that the stand-in takes, the library takes, too."""
    jps: Any = importlib.import_module("jupedsim")
    for name in dir(fake_jupedsim):
        if name.startswith(("Collision", "Anticipation", "Journey", "Simulation")):
            assert hasattr(jps, name)
    assert jupedsim_build.library("jupedsim") is jps
