"""Our ORCA against navground's in closed cases, and its behaviours as planners."""

from __future__ import annotations

import importlib.util
import sys
from types import ModuleType

import numpy as np
import pytest

from crowdbot.errors import InputError
from crowdbot.plugins.planners.navground.navground import NavgroundSpec
from tests.paths import ROOT
from tests.plugins.planners.world import PERSON, World

needs_it = pytest.mark.skipif(
    importlib.util.find_spec("navground") is None, reason="the extra navground is not installed"
)
TOLD = {"tracks": "truth", "localisation": "truth"}
#: Velocities of navground 0.7.0 in the closed cases of benchmarks/orca_agreement.py, m/s; that of
#: a thing that stands is ours: it takes half of the evasion there, and all of it here.
THEIRS = {
    "free": (0.65, 0.0),
    "head on": (0.60885, -0.15828),
    "head on, exactly": (0.59150, -0.18614),
    "crossing": (0.56605, -0.04243),
    "overtaking": (0.62642, -0.00248),
    "two who come": (0.03120, -0.00452),
    "a person who stands": (0.59094, -0.12474),
    "a thing that stands": (0.59413, -0.02259),
}


def _agreement() -> ModuleType:
    path = ROOT / "benchmarks" / "orca_agreement.py"
    spec = importlib.util.spec_from_file_location("orca_agreement", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["orca_agreement"] = module
    spec.loader.exec_module(module)
    return module


AGREEMENT = _agreement()
CASES = {name: (people, points) for name, people, points in AGREEMENT.CASES}


@pytest.mark.parametrize("case", CASES)
def test_our_orca_chooses_what_navground_did(case: str) -> None:
    assert AGREEMENT.ours(*CASES[case]) == pytest.approx(THEIRS[case], abs=2e-3)


@needs_it
@pytest.mark.parametrize("case", [c for c in CASES if c != "a thing that stands"])
def test_our_orca_agrees_with_the_installed_navground(case: str) -> None:
    assert AGREEMENT.ours(*CASES[case]) == pytest.approx(AGREEMENT.theirs(*CASES[case]), abs=1e-3)


@needs_it
def test_both_agree_in_random_scenes() -> None:
    for people, own in AGREEMENT.scenes(200, seed=5):
        assert AGREEMENT.ours(people, [], own) == pytest.approx(
            AGREEMENT.theirs(people, [], own), abs=1e-3
        )


@needs_it
def test_what_stands_is_a_person_to_navground_who_takes_half_of_the_evasion() -> None:
    x, y = CASES["a thing that stands"][1][0]
    as_person = AGREEMENT.ours([[x, y, 0.0, 0.0, 0.03]], [])
    assert as_person == pytest.approx(AGREEMENT.theirs([], [[x, y]]), abs=1e-3)


@needs_it
@pytest.mark.parametrize("behavior", ["ORCA", "HL", "HRVO"])
def test_its_behaviours_let_a_person_pass_who_crosses(behavior: str) -> None:
    from crowdbot.plugins.planners.navground.navground_build import build

    spec = NavgroundSpec.model_validate(
        {"kind": "navground", "behavior": behavior, "person_radius": PERSON, **TOLD}
    )
    world = World([[5.5, -3.6, 0.0, 0.8]], goal=(9.0, 0.0), truth=True)
    out = world.run(build(spec), time_limit=14.0, stop_at=8.0)
    assert out.arrived
    assert out.contacts == []


@needs_it
def test_dummy_looks_at_nothing_and_settings_reach_the_library() -> None:
    from crowdbot.plugins.planners.navground.navground_build import build, made

    core = importlib.import_module("navground.core")
    world = World([[5.0, 0.0, 0.0, 0.0]], goal=(9.0, 0.0), truth=True)
    spec = NavgroundSpec.model_validate({"kind": "navground", "behavior": "Dummy", **TOLD})
    assert len(world.run(build(spec), time_limit=6.0, stop_at=5.5).contacts) == 1
    hl = NavgroundSpec(behavior="HL", settings={"eta": 0.25})
    assert made(core, hl).get("eta") == np.float32(0.25)


@needs_it
def test_a_setting_that_the_library_does_not_know_is_an_error() -> None:
    from crowdbot.plugins.planners.navground.navground_build import build

    with pytest.raises(InputError, match="navground's HL: 'etta'; did you mean 'eta'"):
        build(NavgroundSpec(behavior="HL", settings={"etta": 0.25}))
