"""Scenarios, suites and scores go to other processes: pools, Dask, SubprocVecEnv."""

from __future__ import annotations

import multiprocessing
import pickle

import cloudpickle  # type: ignore[import-untyped]
import numpy as np
import pytest

import crowdbot
from crowdbot.core.registry.narrowed_models import models_of
from crowdbot.core.registry.registry import blank_of, registry_of
from crowdbot.core.registry.registry_source import whereabouts
from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import InputError, UnknownNameError

IDS = ("in-d0125-slow-c01-r02", "counter-d0250-dispersed-c20-r05")


def _seen(scenario: crowdbot.Scenario) -> tuple[str, str]:
    """What another process makes of a scenario: its document, and its origin's."""
    assert scenario.locked is not None
    return scenario.model_dump_json(), scenario.locked.origin().model_dump_json()


def test_another_process_has_the_same_scenario() -> None:
    given = [
        crowdbot.load("challenge-2020", name, set="robots.robot.task.time_limit=2") for name in IDS
    ]
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        found = pool.map(_seen, given)
    assert found == [_seen(scenario) for scenario in given]


def test_by_cloudpickle_which_dask_takes_for_functions_of_a_script() -> None:
    """It keeps the class of a bound method, also if the object becomes another's."""
    given = crowdbot.load("challenge-2020", IDS[0], set="robots.robot.task.time_limit=2")
    assert _seen(cloudpickle.loads(cloudpickle.dumps(given))) == _seen(given)
    suite = crowdbot.load("challenge-2020")
    assert isinstance(suite, Expansion)
    found = cloudpickle.loads(cloudpickle.dumps(suite))
    assert found.scenarios[3].locked.origin() == suite.scenarios[3]


@pytest.mark.parametrize("suite", ["challenge-2020", "challenge-2026", "social-guidelines"])
def test_suites(suite: str) -> None:
    given = crowdbot.load(suite)
    assert isinstance(given, Expansion)
    found = pickle.loads(pickle.dumps(given))  # noqa: S301
    assert found == given
    assert [type(s) for s in found.scenarios] == [type(s) for s in given.scenarios]


def test_scores_and_trajectories() -> None:
    t = 0.1 * np.arange(30)
    run = crowdbot.Trajectories.from_pandas(
        {"t": t, "x": 0.5 * t, "y": 0.0 * t}, robot_radius=0.2, robot_mass=20.0
    )
    scores = crowdbot.score(run, metrics=["speed"])
    found = pickle.loads(pickle.dumps((run, scores)))  # noqa: S301
    np.testing.assert_array_equal(found[0].robot.x, run.robot.x)  # type: ignore[union-attr]
    assert list(found[1]) == list(scores)


def test_plugins_that_were_not_discovered() -> None:
    with pytest.raises(pickle.PicklingError, match="not discovered"):
        whereabouts(None)


def test_classes_stay_while_a_registry_has_them() -> None:
    """However many other registries a process meets in between."""
    given = crowdbot.load("challenge-2020", IDS[0])
    for number in range(20):
        specs = (("metric", type(f"Spec{number}", (ComponentSpec,), {})),)
        models_of(specs, None, blank_of)
    registry_of.cache_clear()
    found = pickle.loads(pickle.dumps(given))  # noqa: S301
    assert type(found) is type(given)


def _fail(kind: str) -> None:
    if kind == "unknown":
        crowdbot.load("challenge-2020", "in-d0125-slow-c01-r03")
    crowdbot.load("challenge-2020", IDS[0], set="robots.robot.task.tme_limit=2")


@pytest.mark.parametrize("kind", ["unknown", "wrong"])
def test_an_error_of_another_process_arrives_as_it_was_raised(kind: str) -> None:
    """A pool whose workers raise what cannot be unpickled waits for ever."""
    with pytest.raises(InputError) as here:
        _fail(kind)
    there = cloudpickle.loads(pickle.dumps(here.value))
    assert type(there) is type(here.value)
    assert str(there) == str(here.value)
    assert vars(there).keys() == vars(here.value).keys()
    if isinstance(here.value, UnknownNameError):
        assert isinstance(there, UnknownNameError)
        assert (there.name, there.near) == (here.value.name, here.value.near)
