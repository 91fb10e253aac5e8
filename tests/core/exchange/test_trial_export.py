"""Scenarios as trials: what can be said comes back, and the rest is in the report."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.exchange.checked import write
from crowdbot.core.exchange.scene import Draft
from crowdbot.core.exchange.trial_export.document import export_trial
from crowdbot.core.exchange.umans.presets import preset
from crowdbot.core.exchange.write import document
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.text.diagnostics import Mark, Source
from tests.core.exchange.importing import FILES, document_of, imported, registry

_HERE = Mark(Source("here"))
_places = st.floats(-40.0, 40.0).map(lambda v: round(v, 3))
_positive = st.floats(0.1, 3.0).map(lambda v: round(v, 3))
_people = st.fixed_dictionaries(
    {
        "radius": st.floats(0.1, 0.4).map(lambda v: round(v, 3)),
        "height": st.floats(1.0, 2.0).map(lambda v: round(v, 3)),
        "speed": _positive,
        "max_speed": _positive,
        "max_acceleration": _positive,
        "heading": st.floats(-3.1, 3.1).map(lambda v: round(v, 4)),
        "goals": st.lists(st.tuples(_places, _places).map(list), min_size=1, max_size=3),
        "at_goal": st.sampled_from(["stop", "loop"]),
        "policy": st.sampled_from(["preset_0", "preset_1", "preset_2", "own"]),
    }
)
#: A policy of UMANS other than the presets.
_OWN = {
    "policy": {"kind": "velocity_space", "method": "sampling", "relaxation_time": 0.25,
               "samples": "random", "random_samples": 30, "base": "current_velocity",
               "direction": "unit", "angle": math.pi, "include_base": False},
    "costs": {"rvo": {"kind": "rvo", "weight": 2.0, "w": 3.0,
                      "range": {"value": 7.0, "measure": "centre"}}},
}  # fmt: skip


def _scene(people: list[dict[str, Any]]) -> Draft:
    scene = Draft("exported")
    scene.environment |= {"area": {"x": [-50, 50], "y": [-50, 50]}}
    for name in dict.fromkeys(person["policy"] for person in people):
        scene.policy(_OWN if name == "own" else preset(int(name[-1])), name, _HERE)
    for number, person in enumerate(people):
        scene.agent({"x": 2.0 * number, "y": -1.5 * number, **person}, _HERE)
    return scene


def _opened(scene: Draft, folder: Path) -> Scenario:
    path = write(folder / "mine.yaml", document([scene], "mine"), [scene])[0]
    return open_spec(str(path), registry()).scenarios[0]


def _crowd(scenario: Any) -> list[dict[str, Any]]:
    """Each person with the policy that moves it, in place of its name."""
    crowd = scenario["crowd"]
    named = crowd.get("policies", {})
    return [{**p, "policy": _by_kind(named.get(p.get("policy"), crowd))} for p in crowd["agents"]]


def _by_kind(policy: dict[str, Any]) -> dict[str, Any]:
    costs = {cost["kind"]: cost for cost in policy["costs"].values()}
    return {"policy": policy["policy"], "costs": costs}


def _near(one: Any, other: Any) -> bool:
    if isinstance(one, dict):
        return all(_near(one[k], other[k]) for k in one.keys() & other.keys())
    if isinstance(one, list):
        return len(one) == len(other) and all(map(_near, one, other))
    if isinstance(one, int | float) and not isinstance(one, bool):
        return math.isclose(one, other, rel_tol=1e-9, abs_tol=1e-9)
    return bool(one == other)


_far = st.floats(42.0, 48.0).map(lambda v: round(v, 3))
_widths = st.floats(0.1, 1.0).map(lambda v: round(v, 3))
_ends = {"start": st.tuples(_far, _far).map(list), "end": st.tuples(_far, _places).map(list)}
_walls = st.fixed_dictionaries({**_ends, "thickness": _widths})
_pillars = st.fixed_dictionaries({"x": _far, "y": _places, "radius": _widths})
_solids = st.fixed_dictionaries(
    {"walls": st.lists(_walls, max_size=2), "pillars": st.lists(_pillars, max_size=2)}
)


@settings(max_examples=8, deadline=None)
@given(_solids)
def test_walls_and_pillars_come_back(solids: dict[str, list[dict[str, Any]]]) -> None:
    scene = _scene([])
    policy = scene.policy(preset(0), "preset_0", _HERE)
    scene.agent({"x": 0, "y": 0, "speed": 1, "goals": [[1, 0]], "policy": policy}, _HERE)
    for kind, parts in solids.items():
        for part in parts:
            scene.part(kind, kind, part, _HERE)
    with tempfile.TemporaryDirectory() as name:
        made = export_trial(_opened(scene, Path(name)), registry())
        (Path(name) / "trial.xml").write_text(made.text, encoding="utf-8")
        again = document_of(imported(Path(name) / "trial.xml"))["scenario"]["environment"]
    for kind, parts in solids.items():
        back = list(again.get(kind, {}).values())
        assert len(back) == len(parts)
        assert all(map(_near, parts, back))


@settings(max_examples=12, deadline=None)
@given(st.lists(_people, min_size=1, max_size=4))
def test_what_a_trial_can_say_comes_back(people: list[dict[str, Any]]) -> None:
    scene = _scene(people)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        made = export_trial(_opened(scene, folder), registry())
        (folder / "trial.xml").write_text(made.text, encoding="utf-8")
        (folder / "policies.xml").write_text(made.policies or "<Policies/>", encoding="utf-8")
        files = [folder / "trial.xml", folder / "policies.xml"][: 1 + bool(made.policies)]
        again = document_of(imported(*files))["scenario"]
    assert again["environment"]["border"] == "open"
    mine = _crowd({"crowd": scene.data()["crowd"]})
    back = _crowd(again)
    assert len(mine) == len(back)
    for one, other in zip(mine, back, strict=True):
        assert _near(one, other), (one, other)
        assert set(one) <= set(other)


def test_robots_and_time_limits_come_back() -> None:
    found = imported("trials/small.xml")
    with tempfile.TemporaryDirectory() as name:
        path = write(Path(name) / "mine.yaml", found.lines, found.scenes)[0]
        made = export_trial(open_spec(str(path), registry()).scenarios[0], registry())
        (Path(name) / "trial.xml").write_text(made.text, encoding="utf-8")
        again = document_of(imported(Path(name) / "trial.xml"))["scenario"]
    first = document_of(found)["scenario"]
    assert _near(again["robots"], first["robots"])
    assert _near(first["crowd"]["agents"], again["crowd"]["agents"])
    assert again["crowd"]["robot_response"] == first["crowd"]["robot_response"]
    assert again["environment"]["zones"] == first["environment"]["zones"]


def test_all_that_is_lost_is_named() -> None:
    scenario = open_spec("challenge-2020", registry()).scenarios[0]
    made = export_trial(scenario, registry())
    lost = {entry.ours: entry.note for entry in made.report.entries}
    assert {"environment.portals", "rates", "contact", "scene", "obstacles", "agents"} <= set(lost)
    assert "measured between centres" in lost["costs.reflex.range"]
    assert "<Policies>" in made.policies


def test_each_field_without_a_word_in_trials_is_named(tmp_path: Path) -> None:
    found = imported("trials/small.xml")
    path = write(tmp_path / "mine.yaml", found.lines, found.scenes)[0]
    scenario = open_spec(str(path), registry()).scenarios[0]
    plain = {entry.ours for entry in export_trial(scenario, registry()).report.entries}
    words = {"crowd.solids=firm": "crowd.solids", "crowd.exit_point=offset": "crowd.exit_point",
             "crowd.body.avoided_radius=0.4": "crowd.body.avoided_radius",
             "crowd.robot_response.sight=3": "crowd.robot_response.sight"}  # fmt: skip
    assert not plain & set(words.values())
    scenario = open_spec(str(path), registry(), list(words)).scenarios[0]
    lost = {entry.ours for entry in export_trial(scenario, registry()).report.entries}
    assert set(words.values()) <= lost


def test_streams_are_exported_as_the_people_that_they_draw(tmp_path: Path) -> None:
    scenario = open_spec(str(FILES.parent / "short_way.yaml"), registry()).scenarios[0]
    made = export_trial(scenario, registry())
    (tmp_path / "trial.xml").write_text(made.text, encoding="utf-8")
    assert made.text.startswith('\ufeff<?xml version="1.0"')
    assert "<TrialRegularRobot" in made.text


@pytest.mark.parametrize("name", ["Rooms", "BigPlane", "Paris"])
def test_stages_are_found_again(tmp_path: Path, name: str) -> None:
    text = (FILES / "trials" / "small.xml").read_text(encoding="utf-8")
    file = tmp_path / "trial.xml"
    changed = text.replace("BigPlane", name).replace('x="1" y="-6"', 'x="4.4" y="-1.5"')
    changed = changed.replace('Goal x="0" y="5"', 'Goal x="4" y="5"')
    changed = changed.replace('Goal x="2" y="-5"', 'Goal x="6" y="2"')
    file.write_text(changed.replace('<Position x="0" y="0" z="0.005"', '<Position x="0" y="2"'))
    found = imported(file)
    path = write(tmp_path / "mine.yaml", found.lines, found.scenes)[0]
    made = export_trial(open_spec(str(path), registry()).scenarios[0], registry())
    known = {"Paris": "BigPlane"}.get(name, name)  # open floors are alike
    assert f'meshName="{known}"' in made.text
